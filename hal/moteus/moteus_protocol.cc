// SPDX-License-Identifier: Apache-2.0
#include "hal/moteus/moteus_protocol.h"

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
constexpr double kVoltageStep_V = 0.5, kTemperatureStep_C = 1.0;  // of int8

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
    while (at_ < *length) u8(kNothing);  // bound: 64 (bytes of a frame)
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

/// One value of a reply, if it is of the type that was asked for.
void take(MoteusReply& reply, std::uint32_t number, Type type,
          std::optional<double> value) RT_SAFE {
  if (!value || number > 0xFFFF) return;
  const auto whole = static_cast<int>(type == Type::kFloat ? 0.0 : *value);
  const bool is_int8 = type == Type::kInt8, is_float = type == Type::kFloat;
  switch (static_cast<MoteusRegister>(number)) {
    case MoteusRegister::kMode:
      if (is_int8) reply.mode = whole;
      break;
    case MoteusRegister::kPosition:
      if (is_float) reply.position_turns = value;
      break;
    case MoteusRegister::kVelocity:
      if (is_float) reply.velocity_turns_per_s = value;
      break;
    case MoteusRegister::kTorque:
      if (is_float) reply.torque_Nm = value;
      break;
    case MoteusRegister::kHomeState:
      if (is_int8) reply.home_state = whole;
      break;
    case MoteusRegister::kVoltage:
      if (is_int8) reply.voltage_V = kVoltageStep_V * *value;
      break;
    case MoteusRegister::kTemperature:
      if (is_int8) reply.temperature_C = kTemperatureStep_C * *value;
      break;
    case MoteusRegister::kFault:
      if (is_int8) reply.fault = whole;
      break;
    case MoteusRegister::kRegisterMap:
      if (type == Type::kInt32) reply.register_map = whole;
      break;
    case MoteusRegister::kFeedforwardTorque:
    case MoteusRegister::kWatchdog:
      break;  // never asked for
  }
}

/// The values of a reply subframe.
void take_values(Reader& reader, std::uint8_t head, MoteusReply& reply) RT_SAFE {
  const auto type = static_cast<Type>(head >> 2 & 3u);
  const std::uint32_t count = (head & 3u) != 0 ? head & 3u : reader.varuint();
  const std::uint32_t first = reader.varuint();
  // bound: 64 (bytes of a frame)
  for (std::uint32_t i = 0; i < count && reader.good(); ++i)  // ends with the frame
    take(reply, first + i, type, reader.value(type));
}

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
  while (reader.more()) {  // bound: 64 (bytes of a frame)
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

}  // namespace tact::hal::moteus
