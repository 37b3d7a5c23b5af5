// SPDX-License-Identifier: Apache-2.0
// falcon_stream.h - whole reports out of the bytes as they come: cut, damaged, with strays between.
//
// A start byte cannot occur inside a packet, so each one begins a new packet, whatever came before;
// a byte that cannot stand at its place drops what was gathered up to and with it. So a report is
// never put together from two, none that arrived whole is lost, and each byte costs the same time.
#pragma once

#include <cstdint>
#include <optional>

#include "hal/falcon/falcon_packets.h"

namespace tact::hal::falcon {

class FalconStream {
 public:
  /// The report that this byte completes, if any.
  std::optional<FalconReport> push(std::uint8_t byte) RT_SAFE;

  /// After a purge or a new start: what is gathered is no loss. The counters stay.
  void reset() RT_SAFE { size_ = 0; }

  std::uint64_t reports() const RT_SAFE { return reports_; }
  std::uint64_t dropped_bytes() const RT_SAFE { return dropped_bytes_; }
  std::size_t waiting_bytes() const RT_SAFE { return size_; }  // of a packet not yet whole

 private:
  FalconPacket packet_{};
  std::size_t size_ = 0;
  std::uint64_t reports_ = 0, dropped_bytes_ = 0;
};

}  // namespace tact::hal::falcon
