// SPDX-License-Identifier: Apache-2.0
// line_request.h - a GPIO chip and some of its lines, as libgpiod asks the kernel for them.
//
// libgpiod_1.cc speaks version 1.6 (Debian 12), libgpiod_2.cc version 2 (Debian 13): CMake builds
// the one whose header is installed. What fails leaves its reason in errno, as libgpiod does.
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "model/rt.h"

namespace tact::hal::gpio {

// estop_a, estop_b, dead_man, grip, clutch, event_0 to event_7
inline constexpr std::size_t kMaxRequestLines = 13;
using Levels = std::array<int, kMaxRequestLines>;  // by place in the request; 1: high

enum class LineUse { kInput, kOutput, kEdges };  // outputs begin low

struct Edge {
  bool rising = false;
  std::int64_t time_ns = 0;  // CLOCK_MONOTONIC, in the line's interrupt
};

/// Lines that were requested together and move together.
class LineRequest {
 public:
  struct Lines;

  LineRequest() = default;
  explicit LineRequest(std::shared_ptr<Lines> lines) : lines_(std::move(lines)) {}
  // Not copied: a copy would keep enable and heartbeat requested after its owner released them.
  LineRequest(LineRequest&&) = default;
  LineRequest& operator=(LineRequest&&) = default;

  bool empty() const RT_SAFE { return lines_ == nullptr; }
  /// One ioctl for all, on a chip that does not sleep. False: the chip does not answer.
  bool get(Levels& levels) RT_SAFE;
  bool set(const Levels& levels) RT_SAFE;
  /// With kEdges: waits at most so long for an edge, and returns all that are there, in order.
  std::vector<Edge> edges(std::chrono::milliseconds longest);

 private:
  std::shared_ptr<Lines> lines_;  // shared, as only libgpiod's file knows what it is
};

/// Lives longer than the requests that it gave.
class Chip {
 public:
  struct Handle;

  Chip() = default;  // empty
  Chip(Chip&&) = default;
  Chip& operator=(Chip&&) = default;
  /// Empty if it cannot be opened.
  explicit Chip(const std::string& path);

  bool empty() const { return handle_ == nullptr; }
  bool gives(int offset) const;
  /// Who has the line; "" where the kernel does not name its user, nothing if it is free.
  std::optional<std::string> user_of(int offset) const;
  /// At most kMaxRequestLines lines. Empty if the kernel refuses one of them.
  LineRequest request(LineUse use, std::span<const int> offsets, const char* consumer);

 private:
  std::shared_ptr<Handle> handle_;
};

}  // namespace tact::hal::gpio
