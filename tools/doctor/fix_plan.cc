// SPDX-License-Identifier: Apache-2.0
#include "tools/doctor/fix_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <initializer_list>
#include <string_view>

#include "tools/doctor/grub_text.h"
#include "tools/doctor/limits_text.h"
#include "tools/doctor/unit_text.h"

namespace tact::tools::doctor {
namespace {

using firmware::pc::PcQuestion;
using firmware::pc::PcRow;
using firmware::pc::Verdict;
using Rows = std::vector<PcRow>;
using Names = std::initializer_list<std::string_view>;

/// A drop-in of tools/deploy/rt for `core`: as it stands where it chooses `own_choice` by itself.
std::string with_core(std::string text, const std::string& line, int core, int own_choice) {
  const std::size_t found = text.find("\n" + line + "\n");
  // Untouched where it would choose this core itself: the bytes of a package then are the same.
  if (core == own_choice || found == std::string::npos) return text;
  const std::size_t value = text.find("TACT_CORE=", found) + 10;
  return text.replace(value, found + 1 + line.size() - value, std::to_string(core));
}

const PcRow* red_row(const Rows& rows, std::string_view name) {
  for (const PcRow& row : rows)
    if (row.name == name && row.verdict == Verdict::kRed) return &row;
  return nullptr;
}

bool any_red(const Rows& rows, Names names) {
  return std::ranges::any_of(names, [&](auto name) { return red_row(rows, name) != nullptr; });
}

/// Somebody else has given the kernel isolated cores: two answers would contradict each other.
bool is_isolated_by_another(const PcQuestion& q) {
  const auto given = q.files.line("/proc/cmdline");
  return given && given->find("isolcpus=") != std::string::npos && !q.files.is_there(kGrubDropIn) &&
         !q.files.is_there(kPackagedGrubDropIn);
}

bool plan_core(const PcQuestion& q, const std::string& others, FixPlan& plan) {
  // With one core there is nothing to isolate it from.
  if (others.empty() || is_isolated_by_another(q)) return false;
  const auto online =
      firmware::pc::parse_cpu_list(q.files.line("/sys/devices/system/cpu/online").value_or(""));
  plan.files.push_back({.path = kGrubDropIn,
                        .content = with_core(kGrubText, "TACT_CORE=${TACT_CORE:-}", q.core,
                                             online.empty() ? -1 : online.back()),
                        .packaged = {kPackagedGrubDropIn}});
  plan.commands.push_back(
      {.file = kGrubDropIn, .words = {"update-grub"}, .back = {"update-grub"}, .back_last = true});
  return true;
}

void plan_unit(const PcQuestion& q, FixPlan& plan) {
  const int own_choice = firmware::pc::core_in_question({.files = q.files, .core = -1});
  plan.files.push_back(
      {.path = kUnit,
       .content = with_core(kUnitText, "Environment=TACT_CORE=", q.core, own_choice),
       .packaged = {"/lib/systemd/system/tact-rt.service",
                    "/usr/lib/systemd/system/tact-rt.service"}});
  plan.commands.push_back({.file = kUnit,
                           .words = {"systemctl", "daemon-reload"},
                           .back = {"systemctl", "daemon-reload"},
                           .back_last = true});
  plan.commands.push_back({.file = kUnit,
                           .words = {"systemctl", "enable", "tact-pc.service"},
                           .back = {"systemctl", "disable", "tact-pc.service"}});
  plan.commands.push_back({.file = kUnit,
                           .words = {"systemctl", "start", "tact-pc.service"},
                           .back = {"systemctl", "stop", "tact-pc.service"}});
}

void plan_group(const FixPeople& people, FixPlan& plan) {
  if (!people.has_group)
    plan.commands.push_back({.file = "",
                             .words = {"groupadd", "--system", "haptics"},
                             .back = {"groupdel", "haptics"}});
  if (!people.user.empty())
    plan.commands.push_back({.file = "",
                             .words = {"usermod", "-aG", "haptics", people.user},
                             .back = {"gpasswd", "-d", people.user, "haptics"}});
}

}  // namespace

FixPlan plan_fix(const PcQuestion& question, const Rows& rows, const FixPeople& people) {
  const PcQuestion q{.files = question.files, .core = firmware::pc::core_in_question(question)};
  const std::string others = firmware::pc::other_cpus(q);
  FixPlan plan;
  // By the limits, which are always planned.
  std::vector<std::string_view> done{"real-time priority", "locked memory"};
  const auto take = [&](Names names) { done.insert(done.end(), names); };
  if (any_red(rows, {"isolated core", "timer tick"}) && plan_core(q, others, plan))
    take({"isolated core", "timer tick"});
  if (any_red(rows, {"interrupts", "CPU governor"}) && !others.empty()) {
    plan_unit(q, plan);
    take({"interrupts", "CPU governor"});
  }
  plan.files.push_back(
      {.path = kLimitsDropIn,
       .content = kLimitsText,
       .packaged = {"/etc/security/limits.d/tact.conf", "/etc/security/limits.d/haptics.conf"}});
  plan_group(people, plan);
  for (const PcRow& row : rows)
    if (row.verdict == Verdict::kRed && std::ranges::find(done, row.name) == done.end())
      plan.left.push_back(fmt::format("{}: {}", row.name, row.cure));
  return plan;
}

}  // namespace tact::tools::doctor
