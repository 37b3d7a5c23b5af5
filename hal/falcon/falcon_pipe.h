// SPDX-License-Identifier: Apache-2.0
// falcon_pipe.h - packets to and from a Falcon whose firmware runs, over any transport.
//
// One I/O thread waits for the bus and hands the newest report over; the loop never waits. A pipe
// that has ended stays so: a device that comes back is opened again. It brings no reports any more,
// but carries commands as long as the device is there: a Falcon may hold its last motor words for
// ever, so another process must be able to send it zeros. A stall of the command endpoint is
// cleared for that (USB 2.0, 9.4.5).
#pragma once

#include <cstdint>
#include <span>

#include "hal/falcon/falcon_packets.h"

namespace tact::hal::falcon {

/// For the last command of a pipe that stops.
inline constexpr std::int64_t kFalconLastCommand_ns = 50'000'000;

struct FalconReply {
  FalconReport report;
  std::int64_t stamp_ns = 0;   // CLOCK_MONOTONIC when it came off the bus
  std::uint64_t sequence = 0;  // whole reports since the start, this one included
};

enum class FalconPipeEnd : std::uint8_t {
  kOpen,       // it carries
  kUnplugged,  // the device is gone
  kStalled,    // an endpoint refuses: the device does not understand what it is asked
  kBroken,     // transfers fail one after the other, or the kernel refuses them
};

struct FalconPipeHealth {
  FalconPipeEnd end = FalconPipeEnd::kOpen;
  int error = 0;                    // errno behind the end; 0: none
  std::uint64_t dropped_bytes = 0;  // of no report, and one for each transfer without its status
  std::uint8_t line_errors = 0;     // ftdi_requests.h, all that were seen
  bool stood_in = false;            // for a silent loop, with zeros, ever (usbfs_pipe.h)
};

class FalconPipe {
 public:
  FalconPipe() = default;
  FalconPipe(const FalconPipe&) = delete;
  FalconPipe& operator=(const FalconPipe&) = delete;
  virtual ~FalconPipe() = default;

  /// One command, at most one system call; false: not taken, the cycle is missed. After any end but
  /// kUnplugged too.
  virtual bool submit(const FalconPacket& command) RT_SAFE = 0;
  /// The system call of submit, by number; none where it makes none.
  virtual std::span<const int> loop_calls() const { return {}; }
  /// The open device, for USBDEVFS_BULK on the command endpoint; -1: it is not known.
  virtual int descriptor() const { return -1; }
  /// The newest report, or false when there is none since the last call. Loop thread.
  virtual bool newest(FalconReply& reply) RT_SAFE = 0;
  /// Any thread.
  virtual FalconPipeHealth health() const RT_SAFE = 0;
  /// Sends one last command, after any end but kUnplugged too, until the device has it, for at most
  /// kFalconLastCommand_ns; ends the thread, gives the interface back. Safe to call twice.
  virtual void stop(const FalconPacket& last) = 0;
};

}  // namespace tact::hal::falcon
