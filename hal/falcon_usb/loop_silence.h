// SPDX-License-Identifier: Apache-2.0
// loop_silence.h - when the loop has gone silent: a Falcon may hold its last motor words for ever,
// so the thread that waits for USB sends zeros in its place.
//
// The loop only counts its commands; the thread looks at the count and at its own clock. A loop
// that comes back still holds its old force for the hand, which would meet it in one step: the pipe
// tells that it stood in, and the device latches.
#pragma once

#include <cstdint>

#include "hal/falcon/falcon_packets.h"
#include "hal/loop_gone.h"

namespace tact::hal::falcon_usb {

class LoopSilence {
 public:
  /// `commands`: how many the loop has sent. True: silent for so long; again after as long.
  bool is_due(std::uint64_t commands, std::int64_t now_ns) {
    const bool heard = commands != commands_;
    commands_ = commands;
    if (!heard && (commands == 0 || now_ns - since_ns_ < kLoopGone_ns)) return false;
    since_ns_ = now_ns;
    return !heard;
  }
  /// No force, and a light that says so.
  static falcon::FalconPacket zero() {
    return encode(falcon::FalconCommand{.lights = falcon::kFalconRed});
  }

 private:
  std::uint64_t commands_ = 0;
  std::int64_t since_ns_ = 0;
};

}  // namespace tact::hal::falcon_usb
