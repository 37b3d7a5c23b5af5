// SPDX-License-Identifier: Apache-2.0
#include "tests/soak/invariants.h"

#include <fmt/format.h>

namespace tact::soak {

using firmware::loop::State;
using model::Fault;

void Invariants::check(const firmware::loop::TickRecord& record) {
  if (!begun_) first_due_ns_ = record.due_ns;
  const auto periods = static_cast<std::int64_t>(record.tick + record.skipped_ticks);
  expect(record.due_ns == first_due_ns_ + periods * period_ns_, "the grid never shifts",
         record.tick);
  const char* broken = witness_.check({.written = record.output.written,
                                       .written_grip_N = record.output.written_grip_N,
                                       .tool = record.input.sample.tool,
                                       .fresh = record.input.sample.fresh,
                                       .armed = record.output.state == State::kArmed,
                                       .faulted = latches(record.output.fault),
                                       .skipped_periods = record.input.skipped_periods});
  expect(broken == nullptr, broken, record.tick);
  if (begun_) check_state(record);
  before_ = record;
  begun_ = true;
}

void Invariants::check_state(const firmware::loop::TickRecord& record) {
  const State was = before_.output.state, is = record.output.state;
  expect(was != State::kStopped || is == State::kStopped || is == State::kReady,
         "a stop is left to ready alone", record.tick);
  expect(was != State::kStopped || is != State::kReady ||
             (record.input.commands.reset && !before_.input.commands.reset),
         "a stop is left by an edge of reset", record.tick);
  expect(is != State::kArmed || was == State::kArmed ||
             (record.input.commands.arm && !before_.input.commands.arm && was == State::kReady),
         "nothing arms by itself", record.tick);
  expect(is == State::kStopped || !latches(record.output.fault), "a fault stops", record.tick);
  expect(was != State::kStopped || is != State::kStopped || before_.output.fault == Fault::kNone ||
             record.output.fault == before_.output.fault,
         "the first fault stays", record.tick);
}

void Invariants::expect(bool kept, const char* promise, std::uint64_t tick) {
  if (kept) return;
  if (++broken_ == 1) first_ = fmt::format("tick {}: broken: {}", tick, promise);
}

}  // namespace tact::soak
