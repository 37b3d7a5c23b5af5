// SPDX-License-Identifier: Apache-2.0
// falcon_firmware.h - the emulated processor of the grip: boot ROM, upload, then one report per
// command.
//
//     reset (DTR rises) -> 0A 43 0D at 9600 baud -> 0A 44 2C 0D -> 41 at 142 857 baud -> 41
//     -> every byte of the image comes back -> run at 1.5 Mbaud
//
// Run: a command of 16 bytes sets the motors and is answered by one report. Homed bits appear while
// homing is asked and the grip has been out and in; each axis' counts jump then. What the real one
// does when commands stay out is unknown: here the motors hold, or drop after `watchdog_ms`.
// Nothing of the real firmware is in here.
#pragma once

#include <array>
#include <cstdint>
#include <functional>

#include "tests/rig/emulators/falcon/falcon_wire.h"
#include "tests/rig/emulators/mechanics/mechanism.h"
#include "tests/rig/emulators/run/fault_plan.h"

namespace tact::rig {

struct FalconSettings {
  bool runs_already = false;
  int image_bytes = 8492;
  int homing_ms = 800;               // of pulling and pushing, after homing is first asked
  int watchdog_ms = 0;               // 0: the motors hold the last command
  double torque_per_word_Nm = 1e-4;  // a positive word drives the thigh down
};

class FalconFirmware {
 public:
  FalconFirmware(const FalconSettings& settings, FaultPlan& faults)
      : settings_(settings), faults_(faults), mode_(settings.runs_already ? kRun : kDead) {}

  using Answer = std::function<void(std::uint8_t byte)>;
  /// A byte that came over the wire at `baud`. `answer` takes what goes back.
  void receive(std::uint8_t byte, double baud, std::int64_t now_ns, const Answer& answer);
  void reset();
  void tick(std::int64_t now_ns);

  /// From outside: where the joints are.
  void set_joints(const Joints& theta_rad) { theta_rad_ = theta_rad; }
  Joints torque_Nm() const;
  bool is_homed() const { return homed_ == 7; }
  /// Share of the homing motion that is done, 0..1; 0 until it is asked.
  double homing_share(std::int64_t now_ns) const;
  /// True once after each command.
  bool took_command();
  bool tripped();
  bool is_ready_for_upload() const { return mode_ != kDead; }

 private:
  enum Mode : std::uint8_t { kDead, kGreeting, kAutobaud, kUpload, kRun };

  void obey(const FalconCommand& command, std::int64_t now_ns, const Answer& answer);

  FalconSettings settings_;
  FaultPlan& faults_;
  Mode mode_;
  FalconScanner scanner_{0x50};
  std::array<std::uint8_t, 3> last_{};  // bytes, the newest last
  int uploaded_ = 0, homed_ = 0;
  Joints theta_rad_{};
  std::array<int, 3> motor_{};
  std::int64_t homing_ns_ = 0, command_ns_ = 0;
  bool took_ = false, tripped_ = false;
  std::uint32_t noise_ = 1;
};

}  // namespace tact::rig
