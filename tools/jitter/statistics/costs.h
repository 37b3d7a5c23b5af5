// SPDX-License-Identifier: Apache-2.0
// costs.h - what the kernel counts against the loop: interrupts of its core, faults, switches,
// migrations, time that it was ready and did not run, time that a hypervisor took, SMIs.
//
// Read from files by an ordinary thread, never by the loop:
//   /proc/interrupts                     one column a CPU; devices by number, the kernel's by name
//   /proc/PID/task/TID/stat              minflt and majflt, fields 10 and 12 (proc(5))
//   /proc/PID/task/TID/status            voluntary_ctxt_switches, nonvoluntary_ctxt_switches
//   /proc/PID/task/TID/sched             se.nr_migrations (kernels with CONFIG_SCHED_DEBUG)
//   /proc/PID/task/TID/schedstat         ns on the CPU, ns waiting for it (Documentation/scheduler)
//   /proc/stat                           cpuN, field 8: steal, in ticks of USER_HZ
//   /dev/cpu/N/msr at 0x34               MSR_SMI_COUNT of Intel CPUs, with the module msr and root
#pragma once

#include <cstdint>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "firmware/pc/pc_files.h"

namespace tact::tools::jitter {

struct Costs {
  std::map<std::string, std::uint64_t> interrupts;  // on the core, by source
  std::optional<std::uint64_t> minor_faults, major_faults;
  std::optional<std::uint64_t> voluntary_switches, involuntary_switches;
  std::optional<std::uint64_t> migrations;
  std::optional<std::uint64_t> waited_ns;  // ready, but another ran
  std::optional<std::uint64_t> steal_ms;   // of the core, by the hypervisor
  std::optional<std::uint64_t> smi;
};

/// What is known now; what cannot be read stays empty.
Costs read_costs(const firmware::pc::PcFiles& files, int thread, int core);
/// From `before` to `after`; sources that counted nothing are left out.
Costs operator-(const Costs& after, const Costs& before);
/// Both together.
void add_to(Costs& sum, const Costs& more);

/// "ready without the CPU 31 us; interrupts LOC 100, 36 virtio1-req.0 12"; sources with the
/// most first.
std::string describe(const Costs& delta);
nlohmann::json to_json(const Costs& costs);

}  // namespace tact::tools::jitter
