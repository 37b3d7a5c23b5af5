#include "tests/soak/promises.h"

#include <fmt/format.h>

namespace tact::soak {

using firmware::State;
using model::Fault;

namespace {

constexpr double kHair = 1.0 + 1e-12;  // for the rounding of a difference or a product itself

}  // namespace

void Promises::check(const firmware::TickRecord& record) {
  if (!begun_) first_due_ns_ = record.due_ns;
  const auto periods = static_cast<std::int64_t>(record.tick + record.skipped_ticks);
  expect(record.due_ns == first_due_ns_ + periods * period_ns_, "the grid never shifts",
         record.tick);
  check_force(record);
  check_heat(record);
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
  const double passed_s =
      (1.0 + record.input.skipped_periods) * static_cast<double>(period_ns_) * 1e-9;
  const model::Wrench& before = before_.output.written;
  const double step_N = limits_.slew_N_per_s * passed_s * kHair;
  expect(norm(written.force_N - before.force_N) <= step_N, "|dF| <= slew dt", record.tick);
  expect(norm(written.torque_Nm - before.torque_Nm) <=
             step_N * limits_.torque_Nm / limits_.force_N * kHair,
         "|dT| <= slew dt torque_Nm / force_N", record.tick);
  const model::Tool& tool = record.input.sample.tool;
  const double power_W =
      dot(written.force_N, tool.velocity_mps) + dot(written.torque_Nm, tool.angular_velocity_radps);
  expect(power_W <= limits_.power_W * kHair, "F . v + T . w <= power_W", record.tick);
  expect(record.output.given_energy_J <= limits_.energy_J + 1e-9, "energy given <= energy_J",
         record.tick);
}

// A force that was held for longer than the gate could know warms more than it allowed, until it is
// disarmed and cold again.
void Promises::check_heat(const firmware::TickRecord& record) {
  const bool warm = record.output.rms_force_N > limits_.continuous_force_N * kHair;
  const bool armed = record.output.state == State::kArmed;
  overheated_ = record.input.skipped_periods > 0 || (overheated_ && (armed || warm));
  expect(overheated_ || !warm, "RMS <= continuous_force_N", record.tick);
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
