// SPDX-License-Identifier: Apache-2.0
// cia402_cst.h - cyclic synchronous torque: what goes to a CiA 402 drive and comes back each cycle.
//
//     RPDO1, 0x200 + node: controlword u16, target torque i16                     to the drive
//     TPDO1, 0x180 + node: statusword u16, position i32, torque i16               after each SYNC
//
// Torque is in thousandths of the rated torque (objects 6071, 6077; the rated one is 6076, in
// 0.001 N m); position in the drive's own increments (6064). CN-3, CiA 402-2 and 301, little
// endian.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "hal/can/can_frame.h"
#include "hal/cia402/canopen_frames.h"

namespace tact::hal::cia402 {

/// Nothing unless the torque is finite and the rated torque finite and above zero. Rounded to the
/// nearest, halves to even; beyond 16 bits the largest that fits.
std::optional<std::int16_t> cst_torque_permille(double torque_Nm, double rated_torque_Nm) RT_SAFE;

std::optional<can::CanFrame> cst_command(int node, std::uint16_t controlword,
                                         std::int16_t torque_permille) RT_SAFE;

struct CstSample {
  std::uint16_t statusword;  // see cia402_state.h
  std::int32_t position_increments;
  std::int16_t torque_permille;
};
std::optional<CstSample> decode_cst_sample(const can::CanFrame& frame, int node) RT_SAFE;

/// Bit 30 of 1800:01: no remote request.
inline constexpr std::uint32_t kCstWithoutRequest = 1u << 30;

struct CstConfiguration {
  int host_node = 127;
  std::uint16_t host_timeout_ms = 20;  // without the host's heartbeat the drive stops
  std::uint16_t drive_heartbeat_ms = 10;
  std::uint8_t period_ms = 1;  // of SYNC
  /// 255: torque is applied as it arrives; 1: at the next SYNC, a cycle later, if the drive
  /// insists.
  std::uint8_t command_transmission_type = 255;
  /// kCstWithoutRequest as the drive has it: some insist on it.
  bool sample_without_request = false;
};
inline constexpr std::size_t kCstWrites = 21;
using CstWrites = std::array<SdoWrite, kCstWrites>;
/// Identifier of the host's heartbeat.
constexpr std::uint32_t host_heartbeat_id(const CstConfiguration& can) RT_SAFE {
  return 0x700u + static_cast<std::uint32_t>(can.host_node);
}
/// Object 1016:01: who is watched and for how long. A time of zero switches the watch over this
/// node off; a zero as a whole would not name the node, and leave a drive's watch running.
std::uint32_t host_watch(const CstConfiguration& can, std::uint16_t timeout_ms) RT_SAFE;

/// What to write to the drive, in this order, while it is pre-operational: heartbeats, quick stop
/// when the host is lost, the two messages above, period, and the mode. A message is switched off
/// while its mapping changes. Nothing for a node that cannot be or is the host's, or a time of
/// zero.
std::optional<CstWrites> cst_configuration(int node, const CstConfiguration& wanted) RT_SAFE;

}  // namespace tact::hal::cia402
