// SPDX-License-Identifier: Apache-2.0
// foreign_commands.h - commands to this device's drives that another sender put on the bus.
//
// The socket does not loop back our own frames (can_open.cc), so a command that is received came
// from another program or computer.
#pragma once

#include <fmt/core.h>

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <string>

#include "model/rt.h"

namespace tact::hal::can {

class ForeignCommands {
 public:
  template <class Frame>
  void add(const Frame& frame) RT_SAFE {
    if (count_++ > 0) return;
    std::uint64_t bytes = 0;
    // bound: 8 (bytes)
    for (std::size_t i = 0; i < frame.payload().size() && i < sizeof bytes; ++i)
      bytes |= std::uint64_t{frame.data[i]} << (8 * i);
    first_bytes_.store(bytes, std::memory_order_relaxed);
  }
  std::uint64_t count() const RT_SAFE { return count_; }

  /// The first one, of this identifier, with the remedy. Any thread.
  std::string text(std::uint32_t id, const std::string& interface) const {
    std::string bytes;
    const std::uint64_t all = first_bytes_.load(std::memory_order_relaxed);
    for (std::size_t i = 0; i < sizeof all; ++i)
      bytes += fmt::format(" {:02X}", all >> (8 * i) & 0xFF);
    return fmt::format(
        "frame 0x{:03X} with{} on {} is a command that tactd did not send: end the other program, "
        "or take the other computer off the bus (candump {} shows it), then start tactd again",
        id, bytes, interface, interface);
  }

 private:
  std::uint64_t count_ = 0;
  std::atomic<std::uint64_t> first_bytes_{0};  // little endian
};

}  // namespace tact::hal::can
