// SPDX-License-Identifier: Apache-2.0
// logged_tick.h - a tick in a log: all that went into the controller and came out. A log from the
// first tick on is enough to compute every force again, bit for bit (replay.h).
#pragma once

#include <array>
#include <cstdint>

#include "firmware/loop/tick_record.h"
#include "firmware/protocol/chunks.h"
#include "firmware/protocol/record_fields.h"

namespace tact::firmware::protocol {

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

  static LoggedTick of(const loop::TickRecord& record, bool non_rt);
  static FieldTable fields();
};

}  // namespace tact::firmware::protocol
