// SPDX-License-Identifier: Apache-2.0
#include "firmware/pc/pc_check.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "hal/rights_remedy.h"

namespace tact::firmware::pc {

const char* name_of(Verdict verdict) {
  return verdict == Verdict::kGreen ? "green" : verdict == Verdict::kRed ? "red" : "unknown";
}

int core_in_question(const PcQuestion& question) {
  if (question.core >= 0) return question.core;
  // An isolated one if there is one, as rt_setup.h takes it; else the last.
  for (const char* list : {"/sys/devices/system/cpu/isolated", "/sys/devices/system/cpu/online"}) {
    const std::vector<int> cpus = parse_cpu_list(question.files.line(list).value_or(""));
    if (!cpus.empty()) return cpus.back();
  }
  return 0;
}

std::vector<PcRow> check_pc(const PcQuestion& question) {
  const PcQuestion settled{.files = question.files, .core = core_in_question(question)};
  std::vector<PcRow> rows;
  // Most important first: what the kernel is, what the process may, then the core, then the rest.
  check_kernel(settled, rows);
  check_permissions(settled, rows);
  check_core(settled, rows);
  check_others(settled, rows);
  const bool contained = hal::container_of(question.files.root()) != nullptr;
  for (PcRow& row : rows) {
    // Each row is built with its remedy; a green one does not need it.
    if (row.verdict == Verdict::kGreen) row.remedy.clear();
    // A container uses the kernel of its host: what root changes is changed there.
    if (contained && row.remedy.find("sudo ") != std::string::npos)
      row.remedy = "on the host: " + row.remedy;
  }
  return rows;
}

std::string name_red_rows(const std::vector<PcRow>& rows) {
  std::string names;
  std::size_t red = 0;
  for (const PcRow& row : rows) {
    if (row.verdict != Verdict::kRed) continue;
    names += fmt::format("{}{}", red++ == 0 ? "" : ", ", row.name);
  }
  if (red == 0) return {};
  return fmt::format(
      "{} of {} checks of this PC are red ({}); tact-doctor says why and names the remedy", red,
      rows.size(), names);
}

nlohmann::json to_json(const std::vector<PcRow>& rows) {
  nlohmann::json list = nlohmann::json::array();
  for (const PcRow& row : rows)
    list.push_back({{"name", row.name},
                    {"verdict", name_of(row.verdict)},
                    {"found", row.found},
                    {"why", row.why},
                    {"remedy", row.remedy}});
  return list;
}

}  // namespace tact::firmware::pc
