// SPDX-License-Identifier: Apache-2.0
#include "tests/rig/emulators/moteus/moteus_registers.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

#include "tests/rig/emulators/can/wire.h"

namespace tact::rig {
namespace {

constexpr std::uint8_t kFill = 0x50;
constexpr std::uint8_t kUnknownRegister = 1, kNotWriteable = 2;
constexpr std::array<std::size_t, 16> kLengths{0, 1,  2,  3,  4,  5,  6,  7,
                                               8, 12, 16, 20, 24, 32, 48, 64};

/// Of one step as int8, int16, int32.
struct Steps {
  std::array<double, 3> of_type;
};

Steps steps_of(std::uint16_t number) {
  switch (number) {
    case 0x001:
    case 0x006:
    case 0x020:
    case 0x026:
      return {{0.01, 1e-4, 1e-5}};  // turn
    case 0x002:
    case 0x021:
    case 0x028:
      return {{0.1, 0.00025, 1e-5}};  // turn/s
    case 0x003:
    case 0x022:
    case 0x025:
      return {{0.5, 0.01, 0.001}};  // N m
    case 0x004:
    case 0x005:
    case 0x00A:
    case 0x00E:
      return {{1.0, 0.1, 0.001}};  // A, degC
    case 0x00D:
      return {{0.5, 0.1, 0.001}};  // V
    case 0x023:
    case 0x024:
      return {{1.0 / 127.0, 1.0 / 32767.0, 1.0 / 2147483647.0}};  // a share
    case 0x027:
      return {{0.01, 0.001, 1e-6}};  // s
    default:
      return {{1.0, 1.0, 1.0}};  // a whole number
  }
}

std::size_t size_of(unsigned type) { return type == 0 ? 1 : type == 1 ? 2 : 4; }

double decoded(std::span<const std::uint8_t> bytes, unsigned type, std::uint16_t number) {
  if (type == 3) {
    const auto raw = static_cast<std::uint32_t>(get_raw(bytes));
    return static_cast<double>(std::bit_cast<float>(raw));
  }
  const auto unused = static_cast<unsigned>(64 - 8 * bytes.size());
  const auto raw = static_cast<std::int64_t>(get_raw(bytes) << unused) >> unused;
  const std::int64_t least = -(std::int64_t{1} << (8 * bytes.size() - 1));
  if (raw == least) return std::numeric_limits<double>::quiet_NaN();
  return static_cast<double>(raw) * steps_of(number).of_type[type];
}

void append_value(std::vector<std::uint8_t>& out, double value, unsigned type,
                  std::uint16_t number) {
  const std::size_t size = size_of(type);
  out.resize(out.size() + size);
  const auto bytes = std::span(out).last(size);
  if (type == 3) return put_raw(bytes, std::bit_cast<std::uint32_t>(static_cast<float>(value)));
  const double largest = std::exp2(8.0 * static_cast<double>(size) - 1.0) - 1.0;
  // Cut, not rounded, as the firmware does; the smallest integer means not known.
  const double steps = std::isfinite(value)
                           ? std::clamp(value / steps_of(number).of_type[type], -largest, largest)
                           : -largest - 1.0;
  put_raw(bytes, static_cast<std::uint64_t>(static_cast<std::int64_t>(steps)));
}

class Frame {
 public:
  explicit Frame(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}
  bool more() const { return at_ < bytes_.size(); }
  std::span<const std::uint8_t> take(std::size_t count) {
    const auto part = bytes_.subspan(at_, std::min(count, bytes_.size() - at_));
    at_ += part.size();
    return part;
  }
  unsigned varuint() {
    unsigned value = 0;
    for (unsigned shift = 0; shift < 28 && more(); shift += 7) {
      const std::uint8_t byte = take(1)[0];
      value |= (byte & 0x7Fu) << shift;
      if (byte < 0x80) break;
    }
    return value;
  }

 private:
  std::span<const std::uint8_t> bytes_;
  std::size_t at_ = 0;
};

void append_varuint(std::vector<std::uint8_t>& out, unsigned value) {
  for (; value >= 0x80; value >>= 7) out.push_back(static_cast<std::uint8_t>(value | 0x80));
  out.push_back(static_cast<std::uint8_t>(value));
}
void append_error(std::vector<std::uint8_t>& out, std::uint8_t kind, unsigned number,
                  std::uint8_t error) {
  out.push_back(kind);
  append_varuint(out, number);
  out.push_back(error);
}

void serve_writes(Frame& frame, unsigned type, unsigned count, unsigned first,
                  MoteusRegisters& registers, std::vector<std::uint8_t>& out) {
  for (unsigned i = 0; i < count; ++i) {
    const auto bytes = frame.take(size_of(type));
    if (bytes.size() < size_of(type)) return;
    const auto number = static_cast<std::uint16_t>(first + i);
    if (!registers.set(number, decoded(bytes, type, number)))
      append_error(out, 0x30, number, kNotWriteable);
  }
}

void serve_reads(unsigned type, unsigned count, unsigned first, const MoteusRegisters& registers,
                 std::vector<std::uint8_t>& out) {
  std::vector<std::uint8_t> values;
  for (unsigned i = 0; i < count && out.size() + values.size() < 64; ++i) {
    const auto number = static_cast<std::uint16_t>(first + i);
    const auto value = registers.get(number);
    if (!value) return append_error(out, 0x31, number, kUnknownRegister);
    append_value(values, *value, type, number);
  }
  out.push_back(static_cast<std::uint8_t>(0x20u | type << 2 | (count <= 3 ? count : 0u)));
  if (count > 3) append_varuint(out, count);
  append_varuint(out, first);
  out.insert(out.end(), values.begin(), values.end());
}

}  // namespace

std::vector<std::uint8_t> serve_moteus(std::span<const std::uint8_t> request,
                                       MoteusRegisters& registers) {
  std::vector<std::uint8_t> out;
  Frame frame(request);
  while (frame.more()) {
    const unsigned head = frame.take(1)[0];
    if (head == kFill) continue;
    if (head >= 0x20) break;  // no question
    const unsigned type = head >> 2 & 3u;
    const unsigned count = (head & 3u) != 0 ? head & 3u : frame.varuint();
    const unsigned first = frame.varuint();
    if (head < 0x10)
      serve_writes(frame, type, count, first, registers, out);
    else
      serve_reads(type, count, first, registers, out);
  }
  out.resize(std::min<std::size_t>(out.size(), 64));
  out.resize(*std::ranges::lower_bound(kLengths, out.size()), kFill);
  return out;
}

}  // namespace tact::rig
