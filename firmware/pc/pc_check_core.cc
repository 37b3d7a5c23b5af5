// SPDX-License-Identifier: Apache-2.0
// The core of the loop: what else may use it, and how fast it wakes.
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

#include "firmware/pc/pc_check.h"
#include "hal/rights_remedy.h"

namespace tact::firmware::pc {
namespace {

constexpr const char* kCpus = "/sys/devices/system/cpu";
constexpr long kQuickExit_us = 20;  // exit latency up to which a sleep state is harmless

bool contains(const std::vector<int>& cpus, int cpu) {
  return std::find(cpus.begin(), cpus.end(), cpu) != cpus.end();
}

std::vector<int> cpu_list(const PcFiles& files, const std::string& name) {
  return parse_cpu_list(files.line(fmt::format("{}/{}", kCpus, name)).value_or(""));
}

/// The other online CPUs, as in commands: "0-2"; empty if there is none.
std::string other_cpus(const PcQuestion& q) {
  std::vector<int> cpus = cpu_list(q.files, "online");
  cpus.erase(std::remove(cpus.begin(), cpus.end(), q.core), cpus.end());
  return make_cpu_list(cpus);
}

/// The remedy that needs a reboot; the parameters are those of tools/deploy/rt.
std::string boot_parameters(const PcQuestion& q) {
  const std::string others = other_cpus(q);
  if (others.empty()) return "a PC with two cores or more: one for the loop, one for all else";
  return fmt::format(
      "{1} and boot, or: add isolcpus=domain,managed_irq,{0} nohz_full={0} rcu_nocbs={0} "
      "irqaffinity={2} to GRUB_CMDLINE_LINUX in /etc/default/grub, sudo update-grub, boot",
      q.core, hal::packages_remedy(), others);
}

/// RT-6: a core of its own.
PcRow isolation_row(const PcQuestion& q) {
  const bool known = q.files.is_there(fmt::format("{}/isolated", kCpus));
  const bool isolated = contains(cpu_list(q.files, "isolated"), q.core);
  return {.name = "isolated core",
          .verdict = verdict_of(known, isolated),
          .found = !known ? "unknown"
                          : fmt::format("core {} is {}isolated", q.core, isolated ? "" : "not "),
          .why = "other programs run on the core of the loop; each costs it a switch and its cache",
          .remedy = boot_parameters(q)};
}

/// RT-6: and without the kernel's tick.
PcRow tick_row(const PcQuestion& q) {
  const bool known = q.files.is_there(fmt::format("{}/nohz_full", kCpus));
  const bool quiet = contains(cpu_list(q.files, "nohz_full"), q.core);
  return {.name = "timer tick",
          .verdict = verdict_of(quiet || known, quiet),
          .found = quiet   ? fmt::format("core {} has none while the loop runs", q.core)
                   : known ? fmt::format("core {} is not in nohz_full", q.core)
                           : "this kernel has no nohz_full",
          .why =
              "the kernel's own tick takes a few microseconds from the loop, up to 1000 times a "
              "second",
          .remedy = boot_parameters(q)};
}

/// The device of an interrupt, as in "36 virtio1-req.0": a folder of that name in its /proc folder.
std::string name_interrupt(const PcFiles& files, const std::string& number) {
  for (const std::string& name : files.names("/proc/irq/" + number))
    if (files.names(fmt::format("/proc/irq/{}/{}", number, name)).empty() &&
        !files.line(fmt::format("/proc/irq/{}/{}", number, name)))
      return name;
  return {};
}

/// RT-13: interrupts off the loop's core.
PcRow interrupt_row(const PcQuestion& q) {
  PcRow row{.name = "interrupts",
            .verdict = Verdict::kUnknown,
            .found = "unknown",
            .why =
                "a device's interrupt goes before the loop, and its handler takes as long as its "
                "driver likes",
            .remedy = {}};
  std::string numbers, named;
  int there = 0, here = 0;
  for (const std::string& number : q.files.names("/proc/irq")) {
    const std::string folder = "/proc/irq/" + number;
    auto list = q.files.line(folder + "/effective_affinity_list");
    // Newer kernels report the CPU that is in use; older ones only the CPUs that are allowed.
    if (!list || list->empty()) list = q.files.line(folder + "/smp_affinity_list");
    const std::string name = list ? name_interrupt(q.files, number) : "";
    if (name.empty()) continue;  // no driver uses it
    ++there;
    if (!contains(parse_cpu_list(*list), q.core)) continue;
    // To keep the row readable, it names four devices; the remedy has all numbers.
    if (here++ < 4) named += fmt::format("{}{} {}", named.empty() ? "" : ", ", number, name);
    numbers += fmt::format("{}{}", numbers.empty() ? "" : " ", number);
  }
  if (there == 0) return row;
  row.verdict = here == 0 ? Verdict::kGreen : Verdict::kRed;
  row.found = here == 0 ? fmt::format("none of {} comes to core {}", there, q.core)
                        : fmt::format("{} of {} come to core {}: {}{}", here, there, q.core, named,
                                      here > 4 ? ", ..." : "");
  const std::string others = other_cpus(q);
  row.remedy = others.empty()
                   ? boot_parameters(q)
                   : fmt::format(
                         "{}, or until the next boot: for i in {}; do echo {} | sudo tee "
                         "/proc/irq/$i/smp_affinity_list; done",
                         hal::packages_remedy(), numbers, others);
  return row;
}

/// RT-7: a governor that keeps the clock rate high.
PcRow governor_row(const PcQuestion& q) {
  const std::string path = fmt::format("{}/cpu{}/cpufreq/scaling_governor", kCpus, q.core);
  const auto governor = q.files.line(path);
  const bool steady = governor == "performance";
  return {.name = "CPU governor",
          .verdict = verdict_of(governor.has_value(), steady),
          .found = governor.value_or("the kernel does not set the CPU's speed"),
          .why = "a CPU that slows down between ticks begins each at its lowest speed",
          .remedy = governor
                        ? fmt::format("{}, or until the next boot: echo performance | sudo tee "
                                      "{}/cpu*/cpufreq/scaling_governor",
                                      hal::packages_remedy(), kCpus)
                        : "set the highest speed in the firmware (BIOS) or on the host"};
}

/// RT-5, RT-7: tactd may forbid deep sleep during its run, or the CPU has none.
PcRow sleep_row(const PcQuestion& q) {
  const std::string folder = fmt::format("{}/cpu{}/cpuidle", kCpus, q.core);
  long slowest_us = 0;
  for (const std::string& state : q.files.names(folder)) {
    // A disabled state does not count.
    if (q.files.line(fmt::format("{}/{}/disable", folder, state)) == "1") continue;
    const auto exit_us = q.files.line(fmt::format("{}/{}/latency", folder, state));
    slowest_us = std::max(slowest_us, std::strtol(exit_us.value_or("0").c_str(), nullptr, 10));
  }
  const bool held = q.files.is_writable("/dev/cpu_dma_latency");
  const bool shallow = q.files.is_there(folder) && slowest_us <= kQuickExit_us;
  return {.name = "sleep states",
          .verdict = held || shallow ? Verdict::kGreen : Verdict::kRed,
          .found = held      ? "tactd may forbid them (/dev/cpu_dma_latency)"
                   : shallow ? fmt::format("the deepest wakes in {} us", slowest_us)
                             : fmt::format("/dev/cpu_dma_latency may not be written, the deepest "
                                           "state wakes in {} us",
                                           slowest_us),
          .why = kPowerReason,
          .remedy = hal::rights_remedy(q.files.root())};
}

/// RT-7: nothing else runs on the other hardware thread of the core.
PcRow sibling_row(const PcQuestion& q) {
  const auto list =
      q.files.line(fmt::format("{}/cpu{}/topology/thread_siblings_list", kCpus, q.core));
  std::vector<int> siblings = parse_cpu_list(list.value_or(""));
  siblings.erase(std::remove(siblings.begin(), siblings.end(), q.core), siblings.end());
  PcRow row{
      .name = "SMT sibling",
      .verdict = verdict_of(list.has_value(), siblings.empty()),
      .found = !list ? "unknown" : "the core is not shared",
      .why = "two hardware threads share one core's units: what runs beside the loop slows it",
      .remedy = "switch SMT off in the firmware (BIOS)"};
  if (siblings.empty()) return row;
  row.found = fmt::format("CPU {} shares the core of CPU {}", make_cpu_list(siblings), q.core);
  // Switches the sibling off until the next boot.
  row.remedy = fmt::format("echo 0 | sudo tee {}/cpu{}/online", kCpus, siblings.front());
  return row;
}

}  // namespace

void check_core(const PcQuestion& q, std::vector<PcRow>& rows) {
  rows.push_back(isolation_row(q));
  rows.push_back(tick_row(q));
  rows.push_back(interrupt_row(q));
  rows.push_back(governor_row(q));
  rows.push_back(sleep_row(q));
  rows.push_back(sibling_row(q));
}

}  // namespace tact::firmware::pc
