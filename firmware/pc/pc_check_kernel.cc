// SPDX-License-Identifier: Apache-2.0
// Kernel, clock, and the limits and permissions of the process.
#include <fmt/format.h>

#include <cstdlib>
#include <sstream>

#include "firmware/pc/pc_check.h"
#include "hal/rights_remedy.h"

namespace tact::firmware::pc {
namespace {

constexpr long kHighestPriority = kLoopPriority + kWatchAboveLoop;  // of any thread of tactd
constexpr unsigned kCapIpcLock = 14, kCapSysNice = 23;              // linux/capability.h

bool has_capability(const PcFiles& files, unsigned capability) {
  std::istringstream status(files.text("/proc/self/status").value_or(""));
  for (std::string line; std::getline(status, line);) {
    // The effective capabilities, as hexadecimal bits (proc(5)).
    if (!line.starts_with("CapEff:")) continue;
    return ((std::strtoull(line.c_str() + 7, nullptr, 16) >> capability) & 1U) != 0;
  }
  return false;
}

/// The soft limit as /proc/self/limits has it: "unlimited", a number, or empty.
std::string soft_limit(const PcFiles& files, const std::string& name) {
  std::istringstream limits(files.text("/proc/self/limits").value_or(""));
  for (std::string line; std::getline(limits, line);) {
    if (!line.starts_with(name)) continue;
    std::istringstream rest(line.substr(name.size()));
    std::string soft;
    rest >> soft;
    return soft;
  }
  return {};
}

/// RT-1: PREEMPT_RT, by the version string first.
PcRow kernel_row(const PcFiles& files) {
  const bool realtime = is_realtime_kernel(files);
  const auto release = files.line("/proc/sys/kernel/osrelease");
  const bool known = realtime || files.line("/proc/sys/kernel/version").has_value();
  return {.name = "kernel",
          .verdict = verdict_of(known, realtime),
          .found = fmt::format("{}{}", release.value_or("unknown"),
                               realtime ? ", PREEMPT_RT"
                               : known  ? ", not PREEMPT_RT"
                                        : ""),
          .why = kKernelReason,
          .remedy = kKernelRemedy};
}

/// RT-9. The flag "hypervisor" is set by the machine that the kernel runs in.
PcRow machine_row(const PcFiles& files) {
  const auto cpu = files.text("/proc/cpuinfo");
  // With the leading blank: the word is one of the processor's flags.
  const bool guest = cpu && cpu->find(" hypervisor") != std::string::npos;
  const auto maker = files.line("/sys/class/dmi/id/sys_vendor");
  const bool wsl =
      files.line("/proc/sys/kernel/osrelease").value_or("").find("microsoft") != std::string::npos;
  const auto* const container = hal::container_of(files.root());
  return {.name = "machine",
          .verdict = verdict_of(cpu.has_value(), !guest),
          .found = !cpu ? "unknown"
                        : fmt::format("{}{}{}",
                                      wsl              ? "WSL, a virtual machine"
                                      : guest && maker ? "a virtual machine of " + *maker
                                      : guest          ? "a virtual machine"
                                                       : "no hypervisor",
                                      container == nullptr ? "" : ", in a container: ",
                                      container == nullptr ? "" : container->name),
          .why = "another system can take the CPU at any time, unseen",
          .remedy = wsl ? "boot Debian on the PC itself; Windows schedules WSL"
                        : "run tactd on the PC itself; here numbers only compare with each other"};
}

/// RT-10. A clock on neither list stays unknown.
PcRow clock_row(const PcFiles& files) {
  const auto source =
      files.line("/sys/devices/system/clocksource/clocksource0/current_clocksource");
  PcRow row{.name = "clock source",
            .verdict = Verdict::kUnknown,
            .found = source.value_or("unknown"),
            .why =
                "the loop reads the clock twice a tick; some clocks need a system call of "
                "a microsecond for each",
            .remedy =
                "add tsc=reliable clocksource=tsc to GRUB_CMDLINE_LINUX, sudo update-grub, "
                "boot; dmesg says why the kernel left tsc"};
  if (!source) return row;
  // The vDSO reads these in user space.
  for (const char* quick :
       {"tsc", "kvm-clock", "hyperv_clocksource_tsc_page", "arch_sys_counter", "riscv_clocksource"})
    if (*source == quick) row.verdict = Verdict::kGreen;
  for (const char* slow : {"hpet", "acpi_pm", "pit", "jiffies", "refined-jiffies", "xen"})
    if (*source == slow) row.verdict = Verdict::kRed;
  return row;
}

/// RT-11: throttling may stop only a runaway loop.
PcRow throttling_row(const PcFiles& files) {
  const auto runtime = files.line("/proc/sys/kernel/sched_rt_runtime_us");
  const auto period = files.line("/proc/sys/kernel/sched_rt_period_us");
  PcRow row{.name = "RT throttling",
            .verdict = Verdict::kUnknown,
            .found = "unknown",
            .why = "the kernel stops real-time threads that use up their share of a period",
            .remedy = "sudo sysctl kernel.sched_rt_runtime_us=950000"};
  if (!runtime || !period) return row;
  const double runtime_us = std::strtod(runtime->c_str(), nullptr);
  const double period_us = std::strtod(period->c_str(), nullptr);
  const bool off = runtime_us < 0.0;
  // At the usual 95 % it stops only a runaway loop, and keeps the PC usable then.
  row.verdict = off || runtime_us >= 0.95 * period_us ? Verdict::kGreen : Verdict::kRed;
  row.found = off ? "off" : fmt::format("{:.0f} of {:.0f} us are theirs", runtime_us, period_us);
  return row;
}

/// RT-3. The highest priority that tactd requests is the watch's.
PcRow priority_row(const PcFiles& files) {
  const std::string limit = soft_limit(files, "Max realtime priority");
  const bool free = has_capability(files, kCapSysNice);
  const bool enough =
      free || limit == "unlimited" || std::strtol(limit.c_str(), nullptr, 10) >= kHighestPriority;
  return {.name = "real-time priority",
          .verdict = verdict_of(free || !limit.empty(), enough),
          .found = free            ? "any (CAP_SYS_NICE)"
                   : limit.empty() ? "unknown"
                                   : fmt::format("up to {} of {}", limit, kHighestPriority),
          .why = kPriorityReason,
          .remedy = hal::rights_remedy(files.root())};
}

/// RT-2. Any limit in bytes is red, because MCL_FUTURE also counts all later memory.
PcRow memory_row(const PcFiles& files) {
  const std::string limit = soft_limit(files, "Max locked memory");
  const bool free = has_capability(files, kCapIpcLock);
  return {.name = "locked memory",
          .verdict = verdict_of(free || !limit.empty(), free || limit == "unlimited"),
          .found = free                   ? "any (CAP_IPC_LOCK)"
                   : limit.empty()        ? "unknown"
                   : limit == "unlimited" ? limit
                                          : fmt::format("at most {} bytes", limit),
          .why = kMemoryReason,
          .remedy = hal::rights_remedy(files.root())};
}

/// RT-12: an inherited limit kills the thread without a message.
PcRow time_limit_row(const PcFiles& files) {
  const std::string limit = soft_limit(files, "Max realtime timeout");
  return {.name = "real-time time limit",
          .verdict = verdict_of(!limit.empty(), limit == "unlimited"),
          .found = limit.empty()          ? "unknown"
                   : limit == "unlimited" ? "none"
                                          : fmt::format("{} us", limit),
          .why = "a real-time thread that runs so long without a sleep is killed without a word",
          .remedy = "ulimit -R unlimited, and take rttime out of /etc/security/limits.d/"};
}

}  // namespace

void check_kernel(const PcQuestion& question, std::vector<PcRow>& rows) {
  rows.push_back(kernel_row(question.files));
  rows.push_back(machine_row(question.files));
  rows.push_back(clock_row(question.files));
  rows.push_back(throttling_row(question.files));
}

void check_permissions(const PcQuestion& question, std::vector<PcRow>& rows) {
  rows.push_back(priority_row(question.files));
  rows.push_back(memory_row(question.files));
  rows.push_back(time_limit_row(question.files));
}

}  // namespace tact::firmware::pc
