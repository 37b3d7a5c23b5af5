// tick_record.h - everything about one tick, in one plain struct: the ring carries it, telemetry
// and recordings are cut from it.
#pragma once

#include <array>
#include <cstdint>

#include "firmware/controller.h"

namespace tact::firmware {

enum class Phase : std::uint8_t { kWake, kRead, kTouch, kFeel, kJudge, kWrite, kTell, kTotal };
inline constexpr std::size_t kPhaseCount = 8;
inline constexpr std::array<const char*, kPhaseCount> kPhaseName{
    "wake", "read", "touch", "feel", "judge", "write", "tell", "total"};

struct TickRecord {
  std::uint64_t tick = 0;
  std::int64_t due_ns = 0;          // the deadline that woke it, on the fixed grid
  std::uint64_t late_ticks = 0;     // so far
  std::uint64_t skipped_ticks = 0;  // so far
  std::int64_t margin_ns = 0;       // of the tick before: next deadline minus its end
  TickInput input;
  TickOutput output;
  std::uint32_t site_count = 0;
  std::array<model::SphereTouch, model::kMaxSpheres> touch;
  std::array<std::int32_t, kPhaseCount>
      phase_ns{};  // up to write; tell and total of the tick before
};

}  // namespace tact::firmware
