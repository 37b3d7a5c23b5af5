// SPDX-License-Identifier: Apache-2.0
// logged_tick.h - a tick in a log: all that went into the controller and came out. A log from the
// first tick on is enough to compute every force again, bit for bit (replay.h).
#pragma once

#include <array>
#include <cstdint>

#include "firmware/loop/tick_record.h"
#include "firmware/protocol/chunks.h"
#include "firmware/protocol/record_fields.h"
#include "firmware/protocol/record_parts.h"

namespace tact::firmware::protocol {

struct LoggedContact {
  float surface_point_m[3] = {};
  float depth_m = 0.0f;
  ContactState state = ContactState::kFree;

  static FieldTable fields();
};

struct LoggedTick {
  static constexpr ChunkKind kKind = ChunkKind::kTick;
  static constexpr const char* kName = "tick";

  std::uint64_t tick = 0;
  bool non_rt = false;
  std::int64_t due_ns = 0;
  std::int64_t margin_ns = 0;
  std::array<std::int32_t, loop::kPhaseCount> phase_ns{};
  loop::TickInput input;
  loop::TickOutput output;
  UtcOffset utc;
  std::uint8_t event = 0, event_word = 0;
  bool sync = false;
  LoggedContact contact[kMaxContacts] = {};

  static LoggedTick of(const loop::TickRecord& record, bool non_rt, const UtcOffset& utc = {});
  /// Fields of a run whose tool has that many spheres.
  static FieldTable fields(std::size_t spheres = kMaxContacts);
};

}  // namespace tact::firmware::protocol
