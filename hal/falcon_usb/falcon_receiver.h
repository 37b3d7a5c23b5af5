// SPDX-License-Identifier: Apache-2.0
// falcon_receiver.h - from USB transfers to the newest report.
//
// take() and finish() belong to the I/O thread, newest() to the loop, health() to anyone.
#pragma once

#include <atomic>
#include <cstdint>
#include <span>

#include "hal/falcon/falcon_packets.h"
#include "hal/falcon/falcon_pipe.h"
#include "hal/falcon/ftdi_requests.h"
#include "hal/threads/latest_slot.h"

namespace tact::hal::falcon_usb {

inline constexpr std::size_t kFalconTransfer = falcon::kFtdiPacketSize;  // bytes of an IN transfer

class FalconReceiver {
 public:
  /// One completed IN transfer, of at most kFalconTransfer bytes, with its status bytes.
  void take(std::span<const std::uint8_t> transfer, std::int64_t now_ns) RT_SAFE;
  /// The pipe has ended; the first end stays, but gone is gone after any of them. Any thread.
  void finish(falcon::FalconPipeEnd end, int error) RT_SAFE;

  /// The pipe is about to send zeros in the loop's place.
  void stand_in() RT_SAFE { stood_in_.store(true, std::memory_order_release); }

  bool newest(falcon::FalconReply& reply) RT_SAFE { return slot_.read(reply); }
  falcon::FalconPipeHealth health() const RT_SAFE;
  bool open() const RT_SAFE { return end_.load(std::memory_order_acquire) == 0; }
  /// Nothing reaches the device any more.
  bool gone() const RT_SAFE { return gone_.load(std::memory_order_acquire); }

 private:
  falcon::FalconStream stream_;
  std::uint64_t bad_transfers_ = 0;
  threads::LatestSlot<falcon::FalconReply> slot_;
  std::atomic<std::uint32_t> end_{0};  // FalconPipeEnd, and errno above it
  std::atomic<bool> gone_{false};
  std::atomic<std::uint64_t> dropped_bytes_{0};
  std::atomic<std::uint8_t> line_errors_{0};
  std::atomic<bool> stood_in_{false};
};

/// How a pipe takes failing transfers: some are noise, many in a row are the end. A thread of high
/// priority that gets nothing done must let the kernel's own threads run, or a device that is
/// pulled is never taken apart (kernel threads of the USB hub run at normal priority).
class FalconTurns {
 public:
  static constexpr int kFree = 8;       // turns without a result before each one pauses
  static constexpr int kMaxEmpty = 40;  // then it is the end, 16 ms after the pauses began
  static constexpr std::int64_t kPause_ns = 500'000;

  enum class Next { kGoOn, kPause, kEnd };
  Next turn(bool result) RT_SAFE {
    empty_ = result ? 0 : empty_ + 1;
    if (empty_ >= kMaxEmpty) return Next::kEnd;
    return empty_ > kFree ? Next::kPause : Next::kGoOn;
  }

 private:
  int empty_ = 0;
};

}  // namespace tact::hal::falcon_usb
