// SPDX-License-Identifier: Apache-2.0
#include "hal/falcon_usb/falcon_receiver.h"

#include <array>

namespace tact::hal::falcon_usb {

void FalconReceiver::take(std::span<const std::uint8_t> transfer, std::int64_t now_ns) RT_SAFE {
  std::array<std::uint8_t, kFalconTransfer> data;
  const auto read = falcon::ftdi_strip(transfer, data);
  if (!read) {
    ++bad_transfers_;
  } else {
    const unsigned errors = read->line & unsigned{falcon::kFtdiLineErrors};
    if (errors != 0) line_errors_.fetch_or(static_cast<std::uint8_t>(errors));
    falcon::FalconReply newest;
    for (std::size_t i = 0; i < read->size; ++i) {  // bound: bytes of a transfer
      const auto report = stream_.push(data[i]);
      if (report) newest = {.report = *report, .stamp_ns = now_ns, .sequence = stream_.reports()};
    }
    // Only the newest of a transfer: the loop takes no older one.
    if (newest.sequence != 0) slot_.write(newest);
  }
  // Relaxed: a counter, for the report and for "does it babble"; no other data hangs on it.
  dropped_bytes_.store(stream_.dropped_bytes() + bad_transfers_, std::memory_order_relaxed);
}

void FalconReceiver::finish(falcon::FalconPipeEnd end, int error) RT_SAFE {
  std::uint32_t open = 0;
  const std::uint32_t code =
      static_cast<std::uint32_t>(end) | static_cast<std::uint32_t>(error & 0xFFFF) << 8;
  // Before end_, also after another cause: only gone also stops commands.
  if (end == falcon::FalconPipeEnd::kUnplugged) gone_.store(true, std::memory_order_release);
  // One word for end and errno: a reader never meets one without the other. The first is the cause.
  end_.compare_exchange_strong(open, code, std::memory_order_acq_rel);
}

falcon::FalconPipeHealth FalconReceiver::health() const RT_SAFE {
  const std::uint32_t code = end_.load(std::memory_order_acquire);
  return {.end = static_cast<falcon::FalconPipeEnd>(code & 0xFFu),
          .error = static_cast<int>(code >> 8),
          .dropped_bytes = dropped_bytes_.load(std::memory_order_relaxed),
          .line_errors = line_errors_.load(std::memory_order_relaxed),
          .stood_in = stood_in_.load(std::memory_order_acquire)};
}

}  // namespace tact::hal::falcon_usb
