// SPDX-License-Identifier: Apache-2.0
// tick_record.h - everything about one tick, in one plain struct: the ring carries it, telemetry
// and recordings are cut from it.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <type_traits>

#include "firmware/loop/controller.h"

namespace tact::firmware::loop {

enum class Phase : std::uint8_t { kWake, kRead, kTouch, kFeel, kJudge, kWrite, kTell, kTotal };
inline constexpr std::size_t kPhaseCount = 8;
inline constexpr std::array<const char*, kPhaseCount> kPhaseName{
    "wake", "read", "touch", "feel", "judge", "write", "tell", "total"};

/// What the tool's spheres touch. A copy takes the spheres that exist and no more: 168 bytes each.
class Touches {
 public:
  using SphereTouch = model::contact::SphereTouch;

  Touches() RT_SAFE {}
  Touches(const Touches& other) RT_SAFE { assign(other.all()); }
  Touches& operator=(const Touches& other) RT_SAFE {
    if (this != &other) assign(other.all());
    return *this;
  }
  /// At most kMaxSpheres of them.
  void assign(std::span<const SphereTouch> touches) RT_SAFE {
    count_ = std::min(touches.size(), model::contact::kMaxSpheres);
    std::copy_n(touches.begin(), count_, touch_.begin());
  }
  std::span<const SphereTouch> all() const RT_SAFE { return {touch_.data(), count_}; }

 private:
  static_assert(std::is_trivially_copyable_v<SphereTouch>);
  std::size_t count_ = 0;
  union {  // so that making one writes nothing
    // NOLINTNEXTLINE(readability-identifier-naming): the union has no name, the member is private
    std::array<SphereTouch, model::contact::kMaxSpheres> touch_;
  };
};

struct TickRecord {
  std::uint64_t tick = 0;
  std::int64_t due_ns = 0;          // the deadline that woke it, on the fixed grid
  std::uint64_t late_ticks = 0;     // so far
  std::uint64_t skipped_ticks = 0;  // so far
  std::int64_t margin_ns = 0;       // of the tick before: next deadline minus its end
  TickInput input;
  TickOutput output;
  std::array<std::int32_t, kPhaseCount>
      phase_ns{};  // up to write; tell and total of the tick before
  Touches touches;
};

}  // namespace tact::firmware::loop
