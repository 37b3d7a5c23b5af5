// SPDX-License-Identifier: Apache-2.0
#include "hal/cia402/cia402_cst.h"

#include <cmath>

#include "hal/can/little_endian.h"

namespace tact::hal::cia402 {
namespace {

// RPDO1 and TPDO1 of CiA 301's connection set.
constexpr std::uint32_t kCommandId = 0x200, kSampleId = 0x180;
constexpr std::uint32_t kMessageOff = 1u << 31;  // of the identifier in 1400 and 1800

/// An entry of a mapping: index, sub 0, length in bits.
constexpr std::uint32_t mapped(std::uint32_t index, std::uint32_t bits) {
  return index << 16 | bits;
}

bool is_rated(double rated_torque_Nm) RT_SAFE {
  return rated_torque_Nm > 0.0 && std::isfinite(rated_torque_Nm);
}

}  // namespace

std::optional<std::int16_t> cst_torque_permille(double torque_Nm, double rated_torque_Nm) RT_SAFE {
  if (!std::isfinite(torque_Nm) || !is_rated(rated_torque_Nm)) return std::nullopt;
  const double permille = std::nearbyint(torque_Nm / rated_torque_Nm * 1000.0);
  // Beyond 16 bits the cast is undefined.
  if (permille >= 32767.0) return std::int16_t{32767};
  if (permille <= -32768.0) return std::int16_t{-32768};
  return static_cast<std::int16_t>(permille);
}

std::optional<can::CanFrame> cst_command(int node, std::uint16_t controlword,
                                         std::int16_t torque_permille) RT_SAFE {
  if (!is_canopen_node(node)) return std::nullopt;
  can::CanFrame frame = can::make_can_frame(kCommandId + static_cast<std::uint32_t>(node), 4);
  can::put_unsigned(frame.data, 0, 2, controlword);
  // As two's complement.
  can::put_unsigned(frame.data, 2, 2, static_cast<std::uint16_t>(torque_permille));
  return frame;
}

std::optional<CstSample> decode_cst_sample(const can::CanFrame& frame, int node) RT_SAFE {
  if (!is_canopen_node(node)) return std::nullopt;
  if (!is_data(frame, kSampleId + static_cast<std::uint32_t>(node), 8)) return std::nullopt;
  return CstSample{.statusword = can::get_u16(frame.data, 0),
                   .position_increments = can::get_i32(frame.data, 2),
                   .torque_permille = can::get_i16(frame.data, 6)};
}

std::uint32_t host_watch(const CstConfiguration& can, std::uint16_t timeout_ms) RT_SAFE {
  return static_cast<std::uint32_t>(can.host_node) << 16 | timeout_ms;
}

std::optional<CstWrites> cst_configuration(int node, const CstConfiguration& wanted) RT_SAFE {
  const bool timed =
      wanted.host_timeout_ms > 0 && wanted.drive_heartbeat_ms > 0 && wanted.period_ms > 0;
  const bool two = is_canopen_node(node) && is_canopen_node(wanted.host_node);
  if (!two || node == wanted.host_node || !timed) return std::nullopt;
  const auto n = static_cast<std::uint32_t>(node);
  // Bit 30 stays as read: drives that serve no remote request insist on it (CN-3).
  const std::uint32_t sample_id =
      (wanted.sample_without_request ? kCstWithoutRequest : 0) | kSampleId;
  // CiA 301's order for a mapping: message off, count 0, entries, count, message on. Drives refuse
  // an entry of a mapping that counts.
  return CstWrites{{
      {0x1017, 0, wanted.drive_heartbeat_ms, 2},
      {0x1016, 1, host_watch(wanted, wanted.host_timeout_ms), 4},
      {0x6007, 0, 3, 2},  // host lost: quick stop
      {0x1400, 1, kMessageOff | (kCommandId + n), 4},
      {0x1400, 2, wanted.command_transmission_type, 1},
      {0x1600, 0, 0, 1},
      {0x1600, 1, mapped(0x6040, 16), 4},  // controlword
      {0x1600, 2, mapped(0x6071, 16), 4},  // target torque
      {0x1600, 0, 2, 1},
      {0x1400, 1, kCommandId + n, 4},
      {0x1800, 1, kMessageOff | (sample_id + n), 4},
      {0x1800, 2, 1, 1},  // after every SYNC
      {0x1A00, 0, 0, 1},
      {0x1A00, 1, mapped(0x6041, 16), 4},  // statusword
      {0x1A00, 2, mapped(0x6064, 32), 4},  // position
      {0x1A00, 3, mapped(0x6077, 16), 4},  // torque
      {0x1A00, 0, 3, 1},
      {0x1800, 1, sample_id + n, 4},
      {0x60C2, 1, wanted.period_ms, 1},
      {0x60C2, 2, 0xFD, 1},  // -3: times 10^-3 s
      {0x6060, 0, 10, 1},    // cyclic synchronous torque
  }};
}

}  // namespace tact::hal::cia402
