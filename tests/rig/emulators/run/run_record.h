// SPDX-License-Identifier: Apache-2.0
// run_record.h - what the emulator saw of the controller: forces, ages, bus cycles; as JSON and
// CSV.
//
// A bus cycle runs from its sign (SYNC received, estimates due, report sent) to the last of the
// torques that follow it; the emulator's own share from that sign, or from the command, to its last
// answer being sent. All memory is taken before the run.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "tests/rig/emulators/mechanics/platform.h"
#include "tests/rig/emulators/run/fault_plan.h"

namespace tact::rig {

class RunRecord {
 public:
  /// `seconds`: how much to make room for; `rows`: whether for --record too.
  RunRecord(double seconds, bool rows);

  /// A torque command arrived: `axis` -1 carries all three.
  void commanded(int axis, const Platform& platform, const Joints& tau_Nm, FaultPlan& faults,
                 std::int64_t now_ns);
  /// These are the motors' torques, and no command is half taken.
  void watch(const Platform& platform, const Joints& tau_Nm, FaultPlan& faults,
             std::int64_t now_ns);
  /// Every millisecond. `enabled`: the motors obey, so the age of a command counts.
  void tick(const Platform& platform, const Joints& tau_Nm, bool enabled, FaultPlan& faults,
            std::int64_t now_ns);

  void cycle_begins(std::int64_t now_ns);
  void answer_sent(std::int64_t since_ns, std::int64_t now_ns);

  /// One line. `protocol`: what was emulated.
  std::string json(const std::string& protocol, const Platform& platform, const FaultPlan& faults,
                   int watchdog_trips) const;
  /// time_ns, p (3, m), F (3, N), torque (3, N m). False: the file cannot be written.
  bool write_csv(const std::string& path) const;

 private:
  struct Row {
    std::int64_t time_ns;
    Vec3 position_m, force_N;
    Joints tau_Nm;
  };

  std::vector<std::int64_t> cycle_ns_, own_ns_;
  std::vector<Row> rows_;
  std::int64_t cycle_start_ns_ = 0;
  std::int64_t torque_zero_since_ns_ = 0;  // 0: there is torque, or never was
  bool had_torque_ = false;
  std::array<std::int64_t, 3> commanded_ns_{};
  bool obeyed_ = false;  // the motors, at the last tick
  bool loop_runs_ = false;
  unsigned answered_ = 0;  // one bit per axis of this cycle
  std::int64_t cycles_ = 0, commands_ = 0, oldest_command_ns_ = 0;
  double largest_force_N_ = 0.0, largest_torque_Nm_ = 0.0;
};

}  // namespace tact::rig
