// SPDX-License-Identifier: Apache-2.0
// moteus_registers.h - moteus' register protocol as the drive serves it.
//
//     frame     subframes, in order: writes, reads; bytes of 0x50 fill it up
//     subframe  kind | type << 2 | count, or count as a varuint behind it; register as a varuint
//     kinds     0x00 write, 0x10 read, 0x20 reply, 0x30 a write that was refused, 0x31 a read
//     types     int8, int16, int32 in steps of the register, float as it is
//
// The smallest integer, and NaN, mean "not known". Source: the protocol and register reference of
// the vendor's documentation, and the open firmware (moteus_controller.cc).
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace tact::rig {

/// The state behind the registers of a drive.
class MoteusRegisters {
 public:
  virtual ~MoteusRegisters() = default;
  /// Nothing: there is no such register.
  virtual std::optional<double> get(std::uint16_t number) const = 0;
  /// False: it cannot be written.
  virtual bool set(std::uint16_t number, double value) = 0;
};

/// Serves one frame; what is to be answered, filled up to a length of CAN FD.
std::vector<std::uint8_t> serve_moteus(std::span<const std::uint8_t> request,
                                       MoteusRegisters& registers);

}  // namespace tact::rig
