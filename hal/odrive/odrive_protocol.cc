// SPDX-License-Identifier: Apache-2.0
#include "hal/odrive/odrive_protocol.h"

#include <cmath>
#include <limits>

#include "hal/can/little_endian.h"

namespace tact::hal::odrive {
namespace {

bool is_node(int node) RT_SAFE { return node >= 0 && node <= kOdriveLargestNode; }

std::uint32_t id_of(int node, OdriveCommand command) RT_SAFE {
  return static_cast<std::uint32_t>(node) << 5 | static_cast<std::uint32_t>(command);
}

/// Fills the payload of one message and remembers whether all of it was in range.
class Writer {
 public:
  Writer(int node, OdriveCommand command, std::uint8_t length) RT_SAFE
      : frame_(can::make_can_frame(is_node(node) ? id_of(node, command) : 0, length)),
        good_(is_node(node)) {}

  Writer& f32(std::size_t offset, double value) RT_SAFE {
    good_ = good_ && std::abs(value) <= static_cast<double>(std::numeric_limits<float>::max());
    if (good_) can::put_f32(frame_.data, offset, static_cast<float>(value));
    return *this;
  }
  Writer& limit_f32(std::size_t offset, double value) RT_SAFE {
    good_ = good_ && value >= 0.0;
    return f32(offset, value);
  }
  Writer& u32(std::size_t offset, std::uint32_t value) RT_SAFE {
    can::put_unsigned(frame_.data, offset, 4, value);
    return *this;
  }
  Writer& u8(std::size_t offset, std::uint8_t value) RT_SAFE {
    frame_.data[offset] = value;
    return *this;
  }
  std::optional<can::CanFrame> frame() const RT_SAFE {
    return good_ ? std::optional(frame_) : std::nullopt;
  }

 private:
  can::CanFrame frame_;
  bool good_;
};

/// Every reply has 8 bytes.
bool is_reply(const can::CanFrame& frame, int node, OdriveCommand command) RT_SAFE {
  return is_node(node) && is_data(frame, id_of(node, command), 8);
}

}  // namespace

OdriveAddress odrive_address(const can::CanFrame& frame) RT_SAFE {
  return {.node = static_cast<int>(frame.id >> 5),
          .command = static_cast<OdriveCommand>(frame.id & 0x1Fu)};
}

std::optional<can::CanFrame> odrive_input_torque(int node, double torque_Nm,
                                                 OdriveTorqueLength length) RT_SAFE {
  return Writer(node, OdriveCommand::kSetInputTorque, static_cast<std::uint8_t>(length))
      .f32(0, torque_Nm)
      .frame();
}

std::optional<can::CanFrame> odrive_limits(int node, double velocity_turns_per_s,
                                           double current_A) RT_SAFE {
  return Writer(node, OdriveCommand::kSetLimits, 8)
      .limit_f32(0, velocity_turns_per_s)
      .limit_f32(4, current_A)
      .frame();
}

std::optional<can::CanFrame> odrive_axis_state(int node, OdriveAxisState state) RT_SAFE {
  return Writer(node, OdriveCommand::kSetAxisState, 8)
      .u32(0, static_cast<std::uint32_t>(state))
      .frame();
}

std::optional<can::CanFrame> odrive_controller_mode(int node, OdriveControlMode control,
                                                    OdriveInputMode input) RT_SAFE {
  return Writer(node, OdriveCommand::kSetControllerMode, 8)
      .u32(0, static_cast<std::uint32_t>(control))
      .u32(4, static_cast<std::uint32_t>(input))
      .frame();
}

std::optional<can::CanFrame> odrive_estop(int node) RT_SAFE {
  return Writer(node, OdriveCommand::kEstop, 0).frame();
}

std::optional<can::CanFrame> odrive_clear_errors(int node, bool identify) RT_SAFE {
  return Writer(node, OdriveCommand::kClearErrors, 1).u8(0, identify ? 1 : 0).frame();
}

std::optional<can::CanFrame> odrive_request(int node, OdriveCommand command) RT_SAFE {
  auto frame = Writer(node, command, 8).frame();
  if (frame) frame->rtr = true;
  return frame;
}

std::optional<OdriveVersion> decode_odrive_version(const can::CanFrame& frame, int node) RT_SAFE {
  if (!is_reply(frame, node, OdriveCommand::kGetVersion)) return std::nullopt;
  return OdriveVersion{.firmware_major = frame.data[4], .firmware_minor = frame.data[5]};
}

std::optional<OdriveHeartbeat> decode_odrive_heartbeat(const can::CanFrame& frame,
                                                       int node) RT_SAFE {
  if (!is_reply(frame, node, OdriveCommand::kHeartbeat)) return std::nullopt;
  return OdriveHeartbeat{.axis_error = can::get_u32(frame.data, 0),
                         .axis_state = frame.data[4],
                         .procedure_result = frame.data[5],
                         .trajectory_done = (frame.data[6] & 1u) != 0};
}

std::optional<OdriveHeartbeat05> decode_odrive_heartbeat_05(const can::CanFrame& frame,
                                                            int node) RT_SAFE {
  if (!is_reply(frame, node, OdriveCommand::kHeartbeat)) return std::nullopt;
  // Any bit of a part's byte is an error: later firmware may give them meanings of their own.
  return OdriveHeartbeat05{.axis_error = can::get_u32(frame.data, 0),
                           .axis_state = frame.data[4],
                           .motor_error = frame.data[5] != 0,
                           .encoder_error = frame.data[6] != 0,
                           .controller_error = (frame.data[7] & 0x7Fu) != 0,
                           .trajectory_done = (frame.data[7] & 0x80u) != 0};
}

std::optional<OdriveEstimates> decode_odrive_estimates(const can::CanFrame& frame,
                                                       int node) RT_SAFE {
  if (!is_reply(frame, node, OdriveCommand::kGetEncoderEstimates)) return std::nullopt;
  const auto position_turns = static_cast<double>(can::get_f32(frame.data, 0));
  const auto velocity_turns_per_s = static_cast<double>(can::get_f32(frame.data, 4));
  if (!std::isfinite(position_turns) || !std::isfinite(velocity_turns_per_s)) return std::nullopt;
  return OdriveEstimates{position_turns, velocity_turns_per_s};
}

std::optional<OdriveCount05> decode_odrive_count_05(const can::CanFrame& frame, int node) RT_SAFE {
  if (!is_reply(frame, node, OdriveCommand::kGetEncoderCount05)) return std::nullopt;
  return OdriveCount05{.shadow = can::get_i32(frame.data, 0)};
}

}  // namespace tact::hal::odrive
