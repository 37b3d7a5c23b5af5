// SPDX-License-Identifier: Apache-2.0
#include "tests/soak/promises.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace tact::soak {

using firmware::loop::State;
using model::Fault;

namespace {

constexpr double kHair = 1.0 + 1e-12;  // for the rounding of a difference or a product itself
constexpr double kSum = 1.0 + 1e-9;    // of many

}  // namespace

void Promises::check(const firmware::loop::TickRecord& record) {
  if (!begun_) first_due_ns_ = record.due_ns;
  const auto periods = static_cast<std::int64_t>(record.tick + record.skipped_ticks);
  expect(record.due_ns == first_due_ns_ + periods * period_ns_, "the grid never shifts",
         record.tick);
  check_force(record);
  account(record);
  check_energy(record);
  check_heat(record);
  if (begun_) check_state(record);
  before_ = record;
  begun_ = true;
}

void Promises::check_force(const firmware::loop::TickRecord& record) {
  const model::Wrench& written = record.output.written;
  expect(is_finite(written.force_N) && is_finite(written.torque_Nm), "forces are numbers",
         record.tick);
  expect(norm(written.force_N) <= limits_.force_N, "|F| <= force_N", record.tick);
  expect(norm(written.torque_Nm) <= limits_.torque_Nm, "|T| <= torque_Nm", record.tick);
  const bool armed = record.output.state == State::kArmed;
  expect(armed || written == model::Wrench{}, "no force unless armed", record.tick);
  if (!armed) return;
  const model::Wrench& before = before_.output.written;
  const double step_N = limits_.slew_N_per_s * passed_s(record) * kHair;
  expect(norm(written.force_N - before.force_N) <= step_N, "|dF| <= slew dt", record.tick);
  expect(norm(written.torque_Nm - before.torque_Nm) <=
             step_N * limits_.torque_Nm / limits_.force_N * kHair,
         "|dT| <= slew dt torque_Nm / force_N", record.tick);
  const model::Tool& tool = record.input.sample.tool;
  const double power_W =
      dot(written.force_N, tool.velocity_mps) + dot(written.torque_Nm, tool.angular_velocity_radps);
  expect(power_W <= limits_.power_W * kHair, "F . v + T . w <= power_W", record.tick);
}

double Promises::passed_s(const firmware::loop::TickRecord& record) const {
  return (1.0 + record.input.skipped_periods) * static_cast<double>(period_ns_) * 1e-9;
}

// What was written in the tick before was held until now.
void Promises::account(const firmware::loop::TickRecord& record) {
  const model::Wrench& held = before_.output.written;
  const double share = std::min(passed_s(record) / limits_.thermal_time_s, 1.0);
  energy_.add(held, passed_s(record), record.input.sample, limits_.recovery_W);
  heat_.add(held.force_N, share);
  torque_heat_.add(held.torque_Nm, share);
}

void Promises::check_energy(const firmware::loop::TickRecord& record) {
  constexpr double kRounding_J = 1e-8;
  if (record.output.state != State::kArmed) return energy_.start_anew();
  expect(
      energy_.given_J() <= limits_.energy_J + limits_.recovery_W * energy_.time_s() + kRounding_J,
      "energy given since arming <= energy_J + recovery_W t", record.tick);
  expect(energy_.lately_J() <= 2.0 * limits_.energy_J + kRounding_J,
         "energy given in any t <= 2 energy_J + recovery_W t", record.tick);
}

// A force that was held for longer than the gate could know warms more than it allowed, until it is
// disarmed and cold again.
void Promises::check_heat(const firmware::loop::TickRecord& record) {
  const double continuous_N = std::min(limits_.continuous_force_N, limits_.force_N);
  const double continuous_Nm = continuous_N * limits_.torque_Nm / limits_.force_N;
  const bool warm = heat_.rms() > continuous_N * kSum;
  const bool torque_warm = torque_heat_.rms() > continuous_Nm * kSum;
  const bool armed = record.output.state == State::kArmed;
  overheated_ = record.input.skipped_periods > 0 || (overheated_ && (armed || warm || torque_warm));
  longest_s_ = overheated_ ? std::max(longest_s_, passed_s(record)) : 0.0;
  expect(overheated_ || !warm, "RMS <= continuous_force_N", record.tick);
  expect(overheated_ || !torque_warm, "RMS of T <= continuous_force_N torque_Nm / force_N",
         record.tick);
  // The third exception of firmware/gate/README.md; until the force has come down at the slew
  // another 10 ms pass.
  const double more = (2.0 * longest_s_ + 0.010) / limits_.thermal_time_s;
  const double late_N =
      std::sqrt(continuous_N * continuous_N + more * limits_.force_N * limits_.force_N);
  const double late_Nm = late_N * limits_.torque_Nm / limits_.force_N;
  expect(heat_.rms() <= late_N * kSum && torque_heat_.rms() <= late_Nm * kSum,
         "RMS after a late tick", record.tick);
}

void Promises::check_state(const firmware::loop::TickRecord& record) {
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

void Promises::expect(bool kept, const char* promise, std::uint64_t tick) {
  if (kept) return;
  if (++broken_ == 1) first_ = fmt::format("tick {}: broken: {}", tick, promise);
}

}  // namespace tact::soak
