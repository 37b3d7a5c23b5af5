#include "tests/soak/promises.h"

#include <fmt/format.h>

namespace tact::soak {

using firmware::State;
using model::Fault;

void Promises::check(const firmware::TickRecord& record) {
  if (!begun_) first_due_ns_ = record.due_ns;
  const auto periods = static_cast<std::int64_t>(record.tick + record.skipped_ticks);
  expect(record.due_ns == first_due_ns_ + periods * period_ns_, "the grid never shifts",
         record.tick);
  check_force(record);
  if (begun_) check_state(record);
  before_ = record;
  begun_ = true;
}

void Promises::check_force(const firmware::TickRecord& record) {
  const model::Wrench& written = record.output.written;
  expect(is_finite(written.force_N) && is_finite(written.torque_Nm), "forces are numbers",
         record.tick);
  expect(norm(written.force_N) <= limits_.force_N, "|F| <= force_N", record.tick);
  expect(norm(written.torque_Nm) <= limits_.torque_Nm, "|T| <= torque_Nm", record.tick);
  const bool armed = record.output.state == State::kArmed;
  expect(armed || written == model::Wrench{}, "no force unless armed", record.tick);
  if (!armed) return;
  // A hair for the rounding of the difference itself.
  const double passed_s =
      (1.0 + record.input.skipped_periods) * static_cast<double>(period_ns_) * 1e-9;
  const double step_N = limits_.slew_N_per_s * passed_s * (1 + 1e-12);
  expect(norm(written.force_N - before_.output.written.force_N) <= step_N, "|dF| <= slew dt",
         record.tick);
}

void Promises::check_state(const firmware::TickRecord& record) {
  const State was = before_.output.state, is = record.output.state;
  expect(was != State::kStopped || is == State::kStopped || is == State::kReady,
         "a stop is left to ready alone", record.tick);
  expect(was != State::kStopped || is != State::kReady ||
             (record.input.commands.reset && !before_.input.commands.reset),
         "a stop is left by an edge of reset", record.tick);
  expect(is != State::kArmed || was == State::kArmed || record.input.commands.arm,
         "nothing arms by itself", record.tick);
  expect(is == State::kStopped || !latches(record.output.fault), "a fault stops", record.tick);
  expect(was != State::kStopped || is != State::kStopped || before_.output.fault == Fault::kNone ||
             record.output.fault == before_.output.fault,
         "the first fault stays", record.tick);
}

void Promises::expect(bool kept, const char* promise, std::uint64_t tick) {
  if (kept) return;
  if (++broken_ == 1) first_ = fmt::format("tick {}: broken: {}", tick, promise);
}

}  // namespace tact::soak
