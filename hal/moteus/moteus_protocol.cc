// SPDX-License-Identifier: Apache-2.0
#include "hal/moteus/moteus_protocol.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>

#include "hal/can/little_endian.h"

namespace tact::hal::moteus {
namespace {

constexpr std::uint32_t kReplyWanted = 0x8000;
constexpr std::uint8_t kWrite = 0x00, kRead = 0x10, kReply = 0x20;
constexpr std::uint8_t kWriteError = 0x30, kReadError = 0x31, kNothing = 0x50;
constexpr double kVoltageStep_V = 0.5;  // of int8; a temperature has 1 degC

enum class Type : std::uint8_t { kInt8, kInt16, kInt32, kFloat };

constexpr std::size_t size_of(Type type) {
  return type == Type::kInt8 ? 1 : type == Type::kInt16 ? 2 : 4;
}

bool is_node(int node) RT_SAFE { return node >= kMoteusSmallestNode && node <= kMoteusLargestNode; }

/// Fills a frame subframe by subframe and remembers whether all of it was in range.
class Writer {
 public:
  explicit Writer(int node) RT_SAFE : good_(is_node(node)) {
    if (good_) frame_.id = kReplyWanted | static_cast<std::uint32_t>(node);
  }

  Writer& mode(MoteusMode mode) RT_SAFE {
    head(kWrite, Type::kInt8, 1, MoteusRegister::kMode);
    return u8(static_cast<std::uint8_t>(mode));
  }
  Writer& write_floats(unsigned count, MoteusRegister first) RT_SAFE {
    return head(kWrite, Type::kFloat, count, first);
  }
  Writer& f32(double value) RT_SAFE {
    good_ = good_ && std::abs(value) <= static_cast<double>(std::numeric_limits<float>::max());
    if (good_) can::put_f32(frame_.data, at_, static_cast<float>(value));
    at_ += 4;
    return *this;
  }
  Writer& read(Type type, unsigned count, MoteusRegister first) RT_SAFE {
    return head(kRead, type, count, first);
  }
  /// What every tick needs to know.
  Writer& ask() RT_SAFE {
    read(Type::kInt8, 1, MoteusRegister::kMode);
    read(Type::kFloat, 3, MoteusRegister::kPosition);
    return read(Type::kInt8, 3, MoteusRegister::kVoltage);
  }
  std::optional<can::CanFdFrame> frame() RT_SAFE {
    const auto length = can::can_fd_length(at_);
    if (!good_ || !length) return std::nullopt;
    while (at_ < *length) u8(kNothing);
    frame_.length = *length;
    return frame_;
  }

 private:
  Writer& u8(std::uint8_t value) RT_SAFE {
    frame_.data[at_++] = value;
    return *this;
  }
  /// `count` is 1 to 3.
  Writer& head(std::uint8_t kind, Type type, unsigned count, MoteusRegister first) RT_SAFE {
    const auto type_bits = static_cast<unsigned>(type) << 2;
    u8(static_cast<std::uint8_t>(kind | type_bits | count));
    const auto number = static_cast<unsigned>(first);
    if (number < 0x80) return u8(static_cast<std::uint8_t>(number));
    u8(static_cast<std::uint8_t>(number | 0x80));
    return u8(static_cast<std::uint8_t>(number >> 7));
  }

  can::CanFdFrame frame_;
  std::size_t at_ = 0;
  bool good_;
};

/// Reads a payload from its first byte to its last; `good` until something is cut.
class Reader {
 public:
  explicit Reader(std::span<const std::uint8_t> bytes) RT_SAFE : bytes_(bytes) {}

  bool good() const RT_SAFE { return good_; }
  bool more() const RT_SAFE { return good_ && at_ < bytes_.size(); }
  std::uint8_t u8() RT_SAFE {
    good_ = more();
    return good_ ? bytes_[at_++] : std::uint8_t{0};
  }
  std::uint32_t varuint() RT_SAFE {
    std::uint64_t value = 0;
    for (unsigned shift = 0; shift < 35; shift += 7) {
      const std::uint8_t byte = u8();
      value |= static_cast<std::uint64_t>(byte & 0x7Fu) << shift;
      if (byte < 0x80) break;
      good_ = good_ && shift < 28;
    }
    good_ = good_ && value <= std::numeric_limits<std::uint32_t>::max();
    return static_cast<std::uint32_t>(value);
  }
  /// Nothing for the value that says "not known".
  std::optional<double> value(Type type) RT_SAFE {
    const std::size_t size = size_of(type);
    good_ = good_ && at_ + size <= bytes_.size();
    if (!good_) return std::nullopt;
    const std::size_t from = at_;
    at_ += size;
    if (type == Type::kFloat) {
      const auto number = static_cast<double>(can::get_f32(bytes_, from));
      return std::isfinite(number) ? std::optional(number) : std::nullopt;
    }
    const auto unused_bits = static_cast<unsigned>(64 - 8 * size);
    const auto raw =
        static_cast<std::int64_t>(can::get_unsigned(bytes_, from, size) << unused_bits);
    if (raw == std::numeric_limits<std::int64_t>::min()) return std::nullopt;
    return static_cast<double>(raw >> unused_bits);
  }

 private:
  std::span<const std::uint8_t> bytes_;
  std::size_t at_ = 0;
  bool good_ = true;
};

/// What a register's value becomes: a whole number, or one in steps.
struct Field {
  MoteusRegister number;
  Type type;  // that was asked for; another one is not taken
  std::optional<int> MoteusReply::* whole = nullptr;
  std::optional<double> MoteusReply::* real = nullptr;
  double step = 1.0;
};
constexpr Field kFields[] = {
    {MoteusRegister::kMode, Type::kInt8, &MoteusReply::mode},
    {MoteusRegister::kPosition, Type::kFloat, nullptr, &MoteusReply::position_turns},
    {MoteusRegister::kVelocity, Type::kFloat, nullptr, &MoteusReply::velocity_turns_per_s},
    {MoteusRegister::kTorque, Type::kFloat, nullptr, &MoteusReply::torque_Nm},
    {MoteusRegister::kHomeState, Type::kInt8, &MoteusReply::home_state},
    {MoteusRegister::kVoltage, Type::kInt8, nullptr, &MoteusReply::voltage_V, kVoltageStep_V},
    {MoteusRegister::kTemperature, Type::kInt8, nullptr, &MoteusReply::temperature_C},
    {MoteusRegister::kFault, Type::kInt8, &MoteusReply::fault},
    {MoteusRegister::kRegisterMap, Type::kInt32, &MoteusReply::register_map},
};

void take(MoteusReply& reply, std::uint32_t number, Type type,
          std::optional<double> value) RT_SAFE {
  if (!value) return;
  for (const Field& field : kFields) {
    if (number != static_cast<std::uint32_t>(field.number) || type != field.type) continue;
    if (field.whole != nullptr)
      reply.*field.whole = static_cast<int>(*value);
    else
      reply.*field.real = field.step * *value;
  }
}

/// The values of a reply subframe.
void take_values(Reader& reader, std::uint8_t head, MoteusReply& reply) RT_SAFE {
  const auto type = static_cast<Type>(head >> 2 & 3u);
  const std::uint32_t count = (head & 3u) != 0 ? head & 3u : reader.varuint();
  const std::uint32_t first = reader.varuint();
  for (std::uint32_t i = 0; i < count && reader.good(); ++i)  // ends with the frame
    take(reply, first + i, type, reader.value(type));
}

constexpr MoteusFaultText kWords[] = {
    {32,
     "Calibration failed, it senses no magnet: check the magnet's distance, then moteus_tool "
     "--calibrate."},
    {33,
     "The power stage reports a fault, most often a supply that drops under load: take a "
     "stronger supply, check the motor cables for a short."},
    {34,
     "DC bus voltage too high: braking fed energy back; take a supply or a damper that sinks "
     "it."},
    {35, "The encoder's readings fit no magnet: check magnet and encoder, then calibrate again."},
    {36, "The motor is not configured: moteus_tool --calibrate."},
    {37,
     "The firmware missed a cycle of its own: restart the drive, update it if that comes back."},
    {38, "The drive or the motor is too hot: let it cool, then ask for less force."},
    {39,
     "The position is outside servopos.position_min and position_max: bring the arm back by "
     "hand, or set both to nan."},
    {40, "DC bus voltage too low: is the drive's supply on?"},
    {41, "A setting was changed while it ran: save, restart the drive."},
    {42,
     "It has no commutation encoder that is valid: check motor_position.sources, then "
     "calibrate."},
    {43, "It has no position that is valid: check motor_position.output and its encoder."},
    {44, "The power stage cannot be enabled: check the supply, restart the drive."},
    {46, "The firmware missed its own time: restart the drive, update it if that comes back."},
    {47, "servo.bemf_feedforward is set without an acceleration limit: set it to 0."},
    {48, "servopos.position_min or position_max lie outside what it can tell: set both to nan."},
    {49, "servo.fault_position_error acts, but tact sends no position: set it to nan."},
    {50, "servo.fault_velocity_error acts, but tact sends no velocity: set it to nan."},
};

}  // namespace

MoteusAddress moteus_address(const can::CanFdFrame& frame) RT_SAFE {
  return {.source = static_cast<int>(frame.id >> 8 & 0x7Fu),
          .destination = static_cast<int>(frame.id & 0x7Fu)};
}

std::uint32_t moteus_reply_id(int node) RT_SAFE { return static_cast<std::uint32_t>(node) << 8; }

std::optional<can::CanFdFrame> moteus_torque(int node, double torque_Nm,
                                             double watchdog_s) RT_SAFE {
  if (!(watchdog_s > 0.0)) return std::nullopt;  // 0 is the drive's own, none is endless
  return Writer(node)
      .mode(MoteusMode::kPosition)
      .write_floats(3, MoteusRegister::kFeedforwardTorque)
      .f32(torque_Nm)
      .f32(0.0)
      .f32(0.0)
      .write_floats(1, MoteusRegister::kWatchdog)
      .f32(watchdog_s)
      .ask()
      .frame();
}

std::optional<can::CanFdFrame> moteus_stop(int node) RT_SAFE {
  return Writer(node).mode(MoteusMode::kStopped).frame();
}

std::optional<can::CanFdFrame> moteus_stop_and_ask(int node) RT_SAFE {
  return Writer(node).mode(MoteusMode::kStopped).ask().frame();
}

std::optional<can::CanFdFrame> moteus_ask(int node) RT_SAFE { return Writer(node).ask().frame(); }

std::optional<can::CanFdFrame> moteus_ask_kind(int node) RT_SAFE {
  return Writer(node)
      .read(Type::kInt8, 1, MoteusRegister::kHomeState)
      .read(Type::kInt32, 1, MoteusRegister::kRegisterMap)
      .frame();
}

std::optional<MoteusReply> decode_moteus(const can::CanFdFrame& frame, int node) RT_SAFE {
  if (!is_node(node) || frame.id != moteus_reply_id(node)) return std::nullopt;
  MoteusReply reply;
  Reader reader(frame.payload());
  while (reader.more()) {
    const std::uint8_t head = reader.u8();
    if (head >= kReply && head < kReply + 0x10) {
      take_values(reader, head, reply);
    } else if (head == kWriteError || head == kReadError) {
      reply.refused_register = static_cast<int>(reader.varuint() & 0xFFFFu);
      reader.varuint();  // why: this register is all that can be repaired
    } else if (head != kNothing) {
      return std::nullopt;  // of another protocol: where the next one begins is not known
    }
  }
  return reader.good() ? std::optional(reply) : std::nullopt;
}

std::span<const MoteusFaultText> moteus_fault_texts() RT_SAFE { return kWords; }

std::string moteus_fault_message(int code) {
  const auto* const found =
      std::ranges::find_if(kWords, [code](const auto& one) { return one.code == code; });
  return fmt::format("{} (fault {})",
                     found != std::end(kWords)
                         ? found->message
                         : "The drive reports a fault that is not known here: ask moteus_tool.",
                     code);
}

const char* moteus_mode_name(int mode) RT_SAFE {
  switch (static_cast<MoteusMode>(mode)) {
    case MoteusMode::kStopped:
      return "stopped";
    case MoteusMode::kFault:
      return "in fault";
    case MoteusMode::kEnabling:
    case MoteusMode::kCalibrating:
    case MoteusMode::kCalibrated:
      return "preparing";
    case MoteusMode::kPosition:
      return "in position mode";
    case MoteusMode::kTimeout:
      return "in timeout";
  }
  return "in another mode";
}

}  // namespace tact::hal::moteus
