// SPDX-License-Identifier: Apache-2.0
// moteus_protocol.h - moteus' register protocol over CAN FD: numbers to frames and back.
//
//     identifier = source << 8 | destination       bit 15: the drive is to reply; the host is 0
//     frame      = subframes, to the next length of CAN FD by 0x50
//     subframe   = kind | type << 2 | count (or 0 and a varuint), register (varuint), values
//                  kind 0x00 write, 0x10 read, 0x20 reply; 0x30, 0x31 a register that was refused
//                  type 0 int8, 1 int16, 2 int32, 3 binary32, little endian
//
// As the vendor's protocol and register reference and the open firmware have them (MO-1). Units are
// turn, turn/s, N m, V, degC, of the output shaft. A torque is the feed-forward torque of position
// mode with both gains scaled to 0 (MO-2). A number that is no number
// is refused by encoders; the smallest integer and NaN are "not known" in a reply.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "hal/can/can_fd_frame.h"

namespace tact::hal::moteus {

enum class MoteusMode : std::uint8_t {
  kStopped = 0,
  kFault = 1,
  kEnabling = 2,
  kCalibrating = 3,
  kCalibrated = 4,
  kPosition = 10,
  kTimeout = 11,  // its watchdog expired; only a stop leads out
};

enum class MoteusRegister : std::uint16_t {
  kMode = 0x000,
  kPosition = 0x001,
  kVelocity = 0x002,
  kTorque = 0x003,
  kHomeState = 0x00C,
  kVoltage = 0x00D,
  kTemperature = 0x00E,
  kFault = 0x00F,
  kFeedforwardTorque = 0x022,
  kWatchdog = 0x027,
  kRegisterMap = 0x102,
};

/// What a position counts from.
enum class MoteusHome : std::uint8_t { kRelative = 0, kRotor = 1, kOutput = 2 };

inline constexpr int kMoteusSmallestNode = 1, kMoteusLargestNode = 126;
inline constexpr int kMoteusAllNodes = 127;
inline constexpr int kMoteusRegisterMap = 5;  // that is spoken here

struct MoteusAddress {
  int source, destination;
};
MoteusAddress moteus_address(const can::CanFdFrame& frame) RT_SAFE;
/// Identifier of the frames from drive to host.
std::uint32_t moteus_reply_id(int node) RT_SAFE;

// --- To the drive. Nothing if node or number is outside its range. ---

/// Zero gains, this torque, valid for so long, and the question of a reply.
std::optional<can::CanFdFrame> moteus_torque(int node, double torque_Nm, double watchdog_s) RT_SAFE;
/// No power; it also clears a fault.
std::optional<can::CanFdFrame> moteus_stop(int node) RT_SAFE;
/// The same, and the question of moteus_torque.
std::optional<can::CanFdFrame> moteus_stop_and_ask(int node) RT_SAFE;
/// That question alone: changes nothing.
std::optional<can::CanFdFrame> moteus_ask(int node) RT_SAFE;
/// Asks for home state and register map.
std::optional<can::CanFdFrame> moteus_ask_kind(int node) RT_SAFE;

// --- From the drive. ---

/// The content of a frame; empty: not in it, or not known to the drive.
struct MoteusReply {
  std::optional<int> mode{}, fault{}, home_state{}, register_map{};
  std::optional<double> position_turns{}, velocity_turns_per_s{}, torque_Nm{};
  std::optional<double> voltage_V{}, temperature_C{};
  std::optional<int> refused_register{};  // the last one that it does not know or take
};
/// Nothing unless it comes from this node to the host and its subframes are whole.
std::optional<MoteusReply> decode_moteus(const can::CanFdFrame& frame, int node) RT_SAFE;

// --- In words, with the remedy. ---

/// Codes as the vendor's register reference (0x000, 0x00F) and the open firmware (fw/error.h) have
/// them: 32 and above a fault, which ends torque; 96 and above a limit that acts while it runs.
struct MoteusFaultText {
  int code;
  const char* message;  // for a person: what happened, what to do
};
std::span<const MoteusFaultText> moteus_fault_texts() RT_SAFE;

/// With its number, to search for in the vendor's pages.
std::string moteus_fault_message(int code);

/// "in position mode"; for a mode that is not known here "in another mode".
const char* moteus_mode_name(int mode) RT_SAFE;

constexpr bool is_moteus_limit(int code) RT_SAFE { return code >= 96; }

}  // namespace tact::hal::moteus
