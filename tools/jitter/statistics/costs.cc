// SPDX-License-Identifier: Apache-2.0
#include "tools/jitter/statistics/costs.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <sstream>
#include <vector>

namespace tact::tools::jitter {
namespace {

using firmware::pc::PcFiles;
using Count = std::optional<std::uint64_t>;

constexpr off_t kSmiCount = 0x34;       // Intel SDM volume 4
constexpr std::size_t kMaxSources = 4;  // in a message

std::vector<std::string> text_of(const std::string& line) {
  std::istringstream stream(line);
  std::vector<std::string> words;
  for (std::string word; stream >> word;) words.push_back(word);
  return words;
}

Count number_in(const std::vector<std::string>& words, std::size_t i) {
  if (i >= words.size() || words[i].find_first_not_of("0123456789") != std::string::npos)
    return std::nullopt;
  return std::strtoull(words[i].c_str(), nullptr, 10);
}

/// "24: 5 0 PCI-MSIX 0-edge eth0" is "24 eth0"; "LOC: 5 0 Local timer interrupts" is "LOC".
std::string name_source(const std::vector<std::string>& words, std::size_t cpus) {
  // Without the colon. The kernel's own lines (LOC, RES) end in words that describe, not name.
  std::string name = words[0].substr(0, words[0].size() - 1);
  const bool of_a_device = name.find_first_not_of("0123456789") == std::string::npos;
  return of_a_device && words.size() > cpus + 1 ? name + " " + words.back() : name;
}

void read_interrupts(const PcFiles& files, int core, Costs& costs) {
  std::istringstream table(files.text("/proc/interrupts").value_or(""));
  std::string line;
  std::getline(table, line);
  const std::vector<std::string> head = text_of(line);  // online CPUs alone have a column
  const auto at = std::find(head.begin(), head.end(), fmt::format("CPU{}", core));
  if (at == head.end()) return;
  const auto column = static_cast<std::size_t>(at - head.begin()) + 1;
  while (std::getline(table, line)) {
    const std::vector<std::string> words = text_of(line);
    const Count count = number_in(words, column);
    if (count && words[0].ends_with(':'))
      costs.interrupts[name_source(words, head.size())] += *count;
  }
}

/// The number after `key` at the start of a line, with any text between.
Count number_after(const std::string& text, const std::string& key) {
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);)
    if (line.starts_with(key)) {
      const std::vector<std::string> words = text_of(line);
      return words.empty() ? std::nullopt : number_in(words, words.size() - 1);
    }
  return std::nullopt;
}

/// Nothing without the module msr, without root, and on other CPUs than Intel's.
Count read_smi_count(const PcFiles& files, int core) {
  const std::string path = fmt::format("{}/dev/cpu/{}/msr", files.root(), core);
  const int fd = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (fd < 0) return std::nullopt;
  std::uint64_t value = 0;
  const bool read = pread(fd, &value, sizeof value, kSmiCount) == sizeof value;
  close(fd);
  // The upper half of the register is reserved.
  return read ? Count(value & 0xffffffffU) : std::nullopt;
}

// Every counter, in one place: its name, where it is kept.
struct Counter {
  const char* name;
  Count Costs::* value;
};
constexpr Counter kCounters[] = {{"minor_page_faults", &Costs::minor_faults},
                                 {"major_page_faults", &Costs::major_faults},
                                 {"voluntary_context_switches", &Costs::voluntary_switches},
                                 {"involuntary_context_switches", &Costs::involuntary_switches},
                                 {"migrations", &Costs::migrations},
                                 {"waited_ns", &Costs::waited_ns},
                                 {"steal_ms", &Costs::steal_ms},
                                 {"smi", &Costs::smi}};

}  // namespace

Costs read_costs(const PcFiles& files, int thread, int core) {
  Costs costs;
  read_interrupts(files, core, costs);
  const std::string task = fmt::format("/proc/self/task/{}", thread);
  const std::string stat = files.line(task + "/stat").value_or("");
  // Behind the last bracket: a thread's name may have blanks and brackets of its own.
  const auto fields = text_of(stat.substr(std::min(stat.rfind(')') + 1, stat.size())));
  costs.minor_faults = number_in(fields, 10 - 3);  // field 3 is the first behind the name
  costs.major_faults = number_in(fields, 12 - 3);
  const std::string status = files.text(task + "/status").value_or("");
  costs.voluntary_switches = number_after(status, "voluntary_ctxt_switches");
  costs.involuntary_switches = number_after(status, "nonvoluntary_ctxt_switches");
  costs.migrations = number_after(files.text(task + "/sched").value_or(""), "se.nr_migrations");
  costs.waited_ns = number_in(text_of(files.line(task + "/schedstat").value_or("")), 1);
  std::istringstream stat_lines(files.text("/proc/stat").value_or(""));
  for (std::string line; std::getline(stat_lines, line);)
    if (line.starts_with(fmt::format("cpu{} ", core)))
      if (const Count ticks = number_in(text_of(line), 8))
        costs.steal_ms = *ticks * 1000 / static_cast<std::uint64_t>(sysconf(_SC_CLK_TCK));
  costs.smi = read_smi_count(files, core);
  return costs;
}

Costs operator-(const Costs& after, const Costs& before) {
  Costs delta;
  for (const auto& [source, count] : after.interrupts) {
    const auto old = before.interrupts.find(source);
    // A source may be new since then: an interrupt that was requested in between.
    const std::uint64_t more = count - (old == before.interrupts.end() ? 0 : old->second);
    if (more != 0) delta.interrupts[source] = more;
  }
  for (const Counter& c : kCounters)
    // Known at both ends, or not reported at all: half a difference would be the count since boot.
    if (after.*c.value && before.*c.value) delta.*c.value = *(after.*c.value) - *(before.*c.value);
  return delta;
}

void add_to(Costs& sum, const Costs& more) {
  for (const auto& [source, count] : more.interrupts) sum.interrupts[source] += count;
  for (const Counter& c : kCounters)
    if (more.*c.value) sum.*c.value = (sum.*c.value).value_or(0) + *(more.*c.value);
}

std::string describe(const Costs& delta) {
  std::string out;
  const auto report = [&](const std::string& part) { out += (out.empty() ? "" : "; ") + part; };
  if (delta.steal_ms.value_or(0) > 0) report(fmt::format("hypervisor {} ms", *delta.steal_ms));
  if (delta.smi.value_or(0) > 0) report(fmt::format("{} SMI", *delta.smi));
  if (delta.waited_ns.value_or(0) > 0)
    report(fmt::format("ready without the CPU {:.0f} us",
                       static_cast<double>(*delta.waited_ns) * 1e-3));
  // Faults, forced switches, migrations. Its own switches are the loop's sleep: no trouble.
  for (const Counter& c : {kCounters[0], kCounters[1], kCounters[3], kCounters[4]})
    if ((delta.*c.value).value_or(0) > 0) report(fmt::format("{} {}", c.name, *(delta.*c.value)));
  std::vector<std::pair<std::uint64_t, std::string>> sources;
  for (const auto& [source, count] : delta.interrupts) sources.emplace_back(count, source);
  std::sort(sources.rbegin(), sources.rend());
  std::string named;
  for (std::size_t i = 0; i < std::min(sources.size(), kMaxSources); ++i)
    named +=
        fmt::format("{}{} {}", i == 0 ? "interrupts " : ", ", sources[i].second, sources[i].first);
  if (!named.empty()) report(named);
  return out.empty() ? "nothing that the kernel counts" : out;
}

nlohmann::json to_json(const Costs& costs) {
  nlohmann::json out{{"interrupts", costs.interrupts}};
  for (const Counter& c : kCounters)
    out[c.name] = costs.*c.value ? nlohmann::json(*(costs.*c.value)) : nlohmann::json(nullptr);
  return out;
}

}  // namespace tact::tools::jitter
