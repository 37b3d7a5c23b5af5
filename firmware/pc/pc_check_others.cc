// SPDX-License-Identifier: Apache-2.0
// Other programs on the PC, and the buses and devices that the loop waits for.
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <sstream>

#include "firmware/pc/pc_check.h"
#include "hal/list/list_devices.h"

namespace tact::firmware::pc {
namespace {

// Chosen: a thousandth of a period at 1 kHz. The kernel's default is 50 us (prctl(2)).
constexpr long kQuickSlack_ns = 1000;

bool is_number(const std::string& name) {
  return !name.empty() && std::all_of(name.begin(), name.end(),
                                      [](unsigned char c) { return std::isdigit(c) != 0; });
}

struct Thread {
  std::string process, id, name;
};

/// Every thread of the PC that this user may see.
std::vector<Thread> find_threads(const PcFiles& files) {
  std::vector<Thread> threads;
  for (const std::string& process : files.names("/proc")) {
    if (!is_number(process)) continue;
    const std::string tasks = fmt::format("/proc/{}/task", process);
    for (const std::string& id : files.names(tasks))
      if (auto name = files.line(fmt::format("{}/{}/comm", tasks, id)))
        threads.push_back({.process = process, .id = id, .name = std::move(*name)});
  }
  return threads;
}

/// Field 40 of /proc/PID/stat, counted after the name, which may contain blanks (proc(5)).
std::optional<long> real_time_priority(const PcFiles& files, const Thread& thread) {
  const auto stat = files.line(fmt::format("/proc/{}/task/{}/stat", thread.process, thread.id));
  const std::size_t name_end = stat ? stat->rfind(')') : std::string::npos;
  if (name_end == std::string::npos) return std::nullopt;
  std::istringstream fields(stat->substr(name_end + 1));
  std::string field;
  for (int number = 3; number <= 40; ++number)
    if (!(fields >> field)) return std::nullopt;
  return std::strtol(field.c_str(), nullptr, 10);
}

/// RT-2. The first line of /proc/swaps is a heading.
PcRow swap_row(const PcFiles& files) {
  const auto swaps = files.text("/proc/swaps");
  const auto lines = swaps ? std::count(swaps->begin(), swaps->end(), '\n') : 0;
  return {.name = "swap",
          .verdict = verdict_of(swaps.has_value(), lines <= 1),
          .found = !swaps      ? "unknown"
                   : lines > 1 ? fmt::format("{} in use", lines - 1)
                               : "none",
          .why = "tactd locks its own memory; programs that swap keep disk, bus and kernel busy",
          .remedy = "sudo swapoff -a, and take swap out of /etc/fstab"};
}

/// RT-13: irqbalance would move interrupts to the loop's core again.
PcRow balancer_row(const PcFiles& files, const std::vector<Thread>& threads) {
  const bool known = files.is_there("/proc/self/comm") || !threads.empty();
  const bool runs = std::any_of(threads.begin(), threads.end(),
                                [](const Thread& t) { return t.name == "irqbalance"; });
  return {.name = "irqbalance",
          .verdict = verdict_of(known, !runs),
          .found = !known ? "unknown"
                   : runs ? "it runs"
                          : "it does not run",
          .why = "it moves interrupts to the core of the loop again",
          .remedy = "sudo systemctl disable --now irqbalance"};
}

/// RT-4. Known only while a loop runs, because the timer slack belongs to a thread.
PcRow slack_row(const PcFiles& files, const std::vector<Thread>& threads) {
  PcRow row{.name = "timer slack",
            .verdict = Verdict::kUnknown,
            .found = "no loop runs; it asks for 1 ns when it starts",
            .why = "the kernel may wake a thread so much later than it asked",
            .remedy = "tactd SCENE in another terminal, then ask again"};
  for (const Thread& t : threads) {
    if (t.name != "tact-loop") continue;
    const auto slack = files.line(fmt::format("/proc/{}/timerslack_ns", t.id));
    if (!slack) continue;
    const long slack_ns = std::strtol(slack->c_str(), nullptr, 10);
    // 0: a real-time thread has none, from Linux 6.12 on
    row.verdict = slack_ns <= kQuickSlack_ns ? Verdict::kGreen : Verdict::kRed;
    row.found = fmt::format("{} ns of the loop {}", slack_ns, t.id);
    row.remedy = fmt::format("echo 1 | sudo tee /proc/{}/timerslack_ns", t.id);
    return row;
  }
  return row;
}

/// irq/24-xhci_hcd, irq/31-can0: interrupt threads of the buses that the loop waits for.
bool carries_a_bus(const std::string& name) {
  if (!name.starts_with("irq/")) return false;
  const std::string device = name.substr(std::min(name.find('-'), name.size() - 1) + 1);
  // Drivers of USB hosts and CAN controllers, as prefixes of their thread's name.
  for (const char* bus : {"xhci", "ehci", "ohci", "uhci", "dwc2", "dwc3", "can", "peak", "kvaser",
                          "mcan", "c_can", "m_can", "sja1000"})
    if (device.starts_with(bus)) return true;
  return false;
}

/// RT-13: the interrupt threads of the device's bus run above the loop's priority.
PcRow bus_row(const PcFiles& files, const std::vector<Thread>& threads) {
  PcRow row{.name = "bus interrupts",
            .verdict = Verdict::kUnknown,
            .found = "no thread carries USB or CAN interrupts here",
            .why = "below the loop's priority they wait for it, and a sample comes a tick late",
            .remedy = "a PREEMPT_RT kernel has them; boot it and ask again"};
  std::string behind, found;
  for (const Thread& t : threads) {
    if (!carries_a_bus(t.name)) continue;
    const auto priority = real_time_priority(files, t);
    if (!priority) continue;
    found += fmt::format("{}{} at {}", found.empty() ? "" : ", ", t.name, *priority);
    if (*priority > kLoopPriority) continue;
    behind += fmt::format("{}sudo chrt -f -p {} {}", behind.empty() ? "" : " && ",
                          kLoopPriority + 4, t.id);
  }
  if (found.empty()) return row;
  row.verdict = behind.empty() ? Verdict::kGreen : Verdict::kRed;
  row.found = fmt::format("{}, the loop at {}", found, kLoopPriority);
  row.remedy = behind;
  return row;
}

/// One row per connected part; no device is opened.
void check_devices(const PcQuestion& q, std::vector<PcRow>& rows) {
  const PcFiles& files = q.files;
  hal::list::PartProbes probes = hal::list::system_probes(q.usb);
  // Below the same root as all other files, so that a copy of another PC's files can be checked.
  probes.roots = {.sys = files.root() + "/sys", .dev = files.root() + "/dev"};
  if (!files.root().empty()) probes.can_link = nullptr;  // a copy has no bus to query
  const auto parts = hal::list::list_devices(probes);
  for (const hal::list::FoundPart& part : parts)
    rows.push_back({.name = "device " + part.name,
                    .verdict = part.lacking.empty() ? Verdict::kGreen : Verdict::kRed,
                    .found = part.lacking.empty() ? part.what + ", ready"
                                                  : fmt::format("{}: {}", part.what, part.lacking),
                    .why = "a scene that names it cannot open it",
                    .remedy = part.remedy});
  if (parts.empty())
    rows.push_back({.name = "devices",
                    .verdict = Verdict::kUnknown,
                    .found = "none is plugged in",
                    .why = "only the simulated device has a force",
                    .remedy = "tactd --list-devices lists what is looked for"});
}

}  // namespace

void check_others(const PcQuestion& q, std::vector<PcRow>& rows) {
  const std::vector<Thread> threads = find_threads(q.files);
  rows.push_back(swap_row(q.files));
  rows.push_back(balancer_row(q.files, threads));
  rows.push_back(slack_row(q.files, threads));
  rows.push_back(bus_row(q.files, threads));
  check_devices(q, rows);
}

}  // namespace tact::firmware::pc
