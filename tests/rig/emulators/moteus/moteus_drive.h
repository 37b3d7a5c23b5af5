// SPDX-License-Identifier: Apache-2.0
// moteus_drive.h - an emulated moteus, as the bus sees it.
//
//     stopped --a command of position mode--> preparing --> position --silent host--> timeout
//     any fault -> fault;     fault and timeout end with a stop alone
//
// Each command of a mode begins with every other command register at its default: position 0, both
// gains whole, the watchdog the drive's own. So a torque is only a torque when both gain scales are
// written as 0. The integral term has a scale of its own (0x02b), of newer firmware, which no known
// drive writes here: with a gain and a limit it winds up all the same. A reply holds the state
// before the command of its frame. Torque counts at the output.
//
// Reading of the vendor's register reference and open firmware; nothing here comes from the drivers
// under test.
#pragma once

#include "tests/rig/emulators/can/can_bus.h"
#include "tests/rig/emulators/can/drive.h"
#include "tests/rig/emulators/moteus/moteus_registers.h"

namespace tact::rig {

struct MoteusSettings {
  int prepare_ms = 20;
  double default_timeout_s = 0.1;
  int timeout_mode = 12;  // 0: lets go; 12: damps, the vendor's default
  double timeout_max_torque_Nm = 5.0;
  double kp_Nm = 4.0, kd_Nms = 0.05;  // per turn, the vendor's defaults
  double integral_gain_Nm_per_turn_s = 0.0, integral_limit_Nm = 0.0;
  double max_torque_Nm = 1.6;
  int home_state = 2;  // 0 relative, 1 rotor, 2 output
  int register_map = 5;
  bool is_calibrated = true;
  bool knows_position = true;
  int unknown_register = -1;  // one that its firmware does not have
};

class MoteusDrive final : public Drive, public MoteusRegisters {
 public:
  /// `bus`, `motor` and `faults` outlive the drive.
  MoteusDrive(int axis, int node, const MoteusSettings& settings, CanBus& bus, const Motor& motor,
              const FaultPlan& faults);

  bool receive(const canfd_frame& frame, std::int64_t now_ns) override;
  void tick(std::int64_t now_ns) override;
  void fail(std::int64_t now_ns) override;
  bool warn(std::int64_t) override { return false; }
  bool is_enabled() const override { return mode_ == kPosition; }
  double torque_Nm() const override;
  bool tripped() override;

  std::optional<double> get(std::uint16_t number) const override;
  bool set(std::uint16_t number, double value) override;

  int mode() const { return mode_; }
  /// Its encoder is gone, and it has not noticed.
  void lose_position() { settings_.knows_position = false; }
  /// Its supply falls below what its power stage needs, while its logic lives on; or is back.
  void sag(bool low) { is_low_ = low; }

 private:
  static constexpr int kStopped = 0, kFault = 1, kPreparing = 3, kPosition = 10, kTimeout = 11;
  /// The command registers; not a number: not commanded.
  struct Command {
    int mode = kStopped;
    double position_turns = 0.0, velocity_turns_per_s = 0.0, feedforward_Nm = 0.0;
    double kp_scale = 1.0, kd_scale = 1.0;
    double max_torque_Nm = 1e9, timeout_s = 0.0;
  };

  void power_on();
  void obey(std::int64_t now_ns);
  void trip(int fault);

  int axis_, node_;
  MoteusSettings settings_;
  CanBus& bus_;
  const Motor& motor_;
  const FaultPlan& faults_;
  int mode_ = kStopped, fault_ = 0;
  Command command_{};  // that acts
  Command written_{};  // of the frame that is served
  double integral_Nm_ = 0.0;
  std::int64_t ticked_ns_ = 0;
  bool has_written_ = false, has_tripped_ = false, is_low_ = false;
  std::int64_t commanded_ns_ = 0, prepared_ns_ = 0;
};

}  // namespace tact::rig
