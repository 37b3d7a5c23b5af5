// SPDX-License-Identifier: Apache-2.0
// odrive_drive.h - an emulated ODrive axis, firmware 0.5 or 0.6, as the bus sees it.
//
//     idle --index search--> idle        idle --closed loop, no error--> closed loop
//     any error, e-stop or silent host -> idle with torque 0, latched until Clear_Errors
//
// The watchdog of 0.5 is fed by every frame to the axis and runs in idle too, as its control loop
// looks at it in every state; that of 0.6 is fed by set-points and runs in closed loop. A set-point
// outlives idle, as nothing in the open firmware clears it: who enables without asking for zero
// first gets the old torque. The torque is limited by current limit x torque constant and, where
// its owner left that on, by velocity: between (+-velocity limit - velocity) x velocity gain; above
// 1.2 x velocity limit it stops with an error. Estimates of 0.5 are 0 and 0 until the axis has
// entered closed loop once since power-on, for any count of its encoder; that lasts when it leaves
// again, also at once for a motor without supply.
// Reading of public documentation and of the open firmware 0.5; nothing here comes from the drivers
// under test.
#pragma once

#include "tests/rig/emulators/can/can_bus.h"
#include "tests/rig/emulators/can/drive.h"
#include "tests/rig/emulators/odrive/odrive_table.h"

namespace tact::rig {

struct OdriveSettings {
  OdriveGeneration generation = OdriveGeneration::k06;
  int watchdog_ms = 10;           // 0: off
  bool watchdog_in_idle = false;  // of 0.6, too
  int heartbeat_ms = 100;
  int estimates_ms = 1;
  int error_ms = 0;             // cyclic Get_Error of 0.6; 0: only on request
  double power_on_turns = 0.0;  // added to the position until the index is found
  int index_search_ms = 300;
  double torque_constant_Nm_per_A = 0.08;
  bool estimates_from_power_on = false;       // 0.5: not as firmware 0.5.6 has them
  bool is_calibrated = true;                  // else it refuses closed loop and index search
  bool motor_supply = true;                   // else it falls out of closed loop at once
  bool torque_velocity_limit = false;         // the vendor's default is true
  double velocity_limit_turns_per_s = 100.0;  // the vendor's default is 2
  double velocity_gain = 1.0 / 6.0;           // N m/(turn/s), the vendor's default
};

class OdriveDrive final : public Drive {
 public:
  /// `bus`, `motor` and `faults` outlive the drive.
  OdriveDrive(int axis, int node, const OdriveSettings& settings, CanBus& bus, const Motor& motor,
              const FaultPlan& faults);

  bool receive(const canfd_frame& frame, std::int64_t now_ns) override;
  void tick(std::int64_t now_ns) override;
  void fail(std::int64_t now_ns) override;
  bool warn(std::int64_t) override { return false; }
  bool is_enabled() const override { return state_ == kClosedLoop; }
  double torque_Nm() const override;
  bool tripped() override;

 private:
  static constexpr std::uint32_t kIdle = 1, kIndexSearch = 6, kClosedLoop = 8;

  bool is_05() const { return settings_.generation == OdriveGeneration::k05; }
  bool command(const canfd_frame& frame, std::uint8_t number, std::int64_t now_ns);
  bool knows_estimates() const {
    return !is_05() || settings_.estimates_from_power_on || entered_closed_loop_;
  }
  void power_on();
  void request_state(std::uint32_t state, std::int64_t now_ns);
  void disarm(std::uint32_t error);
  void send(const OdriveMessage& message, CanRole role, std::int64_t now_ns);
  double value_of(std::string_view field) const;

  int axis_, node_;
  OdriveSettings settings_;
  CanBus& bus_;
  const Motor& motor_;
  const FaultPlan& faults_;
  std::uint32_t state_ = kIdle, error_ = 0, disarm_reason_ = 0, procedure_result_ = 0;
  std::uint32_t control_mode_ = 3, input_mode_ = 1;
  double input_torque_Nm_ = 0.0, current_limit_A_ = 30.0, velocity_limit_turns_per_s_ = 0.0;
  bool has_index_ = false, has_tripped_ = false, motor_failed_ = false;
  bool entered_closed_loop_ = false;  // since power-on
  bool is_overspeed_ = false;
  std::int64_t fed_ns_ = 0, search_until_ns_ = 0, ticks_ = 0;
};

}  // namespace tact::rig
