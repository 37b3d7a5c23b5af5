// SPDX-License-Identifier: Apache-2.0
// drive.h - one emulated motor drive on the bus, of any protocol.
#pragma once

#include <linux/can.h>

#include <cstdint>

namespace tact::rig {

/// What encoder and motor do; turns of the motor, N m at the motor.
struct Motor {
  double position_turns = 0.0, velocity_turns_per_s = 0.0;
  double torque_Nm = 0.0;
};

class Drive {
 public:
  virtual ~Drive() = default;
  /// Any frame of the bus. True: it was a torque command of this drive.
  virtual bool receive(const canfd_frame& frame, std::int64_t now_ns) = 0;
  /// Every millisecond: monitors, cyclic messages.
  virtual void tick(std::int64_t now_ns) = 0;
  /// An over-current trips it.
  virtual void fail(std::int64_t now_ns) = 0;
  /// It warns without stopping; false: it cannot.
  virtual bool warn(std::int64_t now_ns) = 0;
  /// The motor obeys.
  virtual bool is_enabled() const = 0;
  virtual double torque_Nm() const = 0;
  /// Whether the host fell silent since the last question.
  virtual bool tripped() = 0;
};

}  // namespace tact::rig
