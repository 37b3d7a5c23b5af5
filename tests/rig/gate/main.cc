// SPDX-License-Identifier: Apache-2.0
// tact-rig-gate: how many instructions Gate::limit takes while each of its stages acts.
//
//     alone     what comes in makes this stage act, and others only as it does: the longest tick
//     longest   ticks of chance in which anything may act: the longest in which this stage did
//
// For the virtual bench, where one instruction is one nanosecond of CLOCK_MONOTONIC. Each sequence
// of ticks is evaluated several times from its start: the shortest time of a tick has no interrupt
// in it. What reading the clock takes is measured and taken off.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>
#include <functional>
#include <limits>
#include <nlohmann/json.hpp>
#include <random>
#include <vector>

#include "tests/support/gate_rules.h"

namespace tact::rig {
namespace {

using firmware::gate::Gate;
using firmware::gate::GateInput;
using firmware::gate::kStageCount;
using firmware::gate::Stage;
using model::Vec3;
using nlohmann::json;

constexpr double kPeriod_s = 0.001;
constexpr int kTimes = 5, kTicks = 600, kChanceTicks = 12'000;
constexpr std::size_t kNone = kStageCount;  // a row of its own: no stage acts
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// Those of the gate's tests, with a ramp that is soon over.
constexpr model::Limits kLimits = [] {
  model::Limits limits = tests::kRulesLimits;
  limits.ramp_s = 0.05;
  return limits;
}();

/// A tool that rests in the middle and gets 2 N and 0.05 N m: once ramped up, nothing acts.
GateInput quiet() {
  GateInput in{
      .wanted = {{2.0, 0.0, 0.0}, {0.0, 0.05, 0.0}}, .tool = {}, .fresh = true, .armed = true};
  return in;
}

/// What makes one stage act, from tick 200 on; the ramp acts before.
GateInput input_for(std::size_t row, int tick) {
  GateInput in = quiet();
  if (row == kNone || tick < 200) return in;
  const double sign = tick % 2 == 0 ? 1.0 : -1.0;
  switch (static_cast<Stage>(row)) {
    case Stage::kFinite:
      in.wanted.force_N.z = kNaN;
      break;
    case Stage::kFresh:
      in.fresh = tick % 4 < 2;
      break;
    case Stage::kArmed:
      in.armed = false;
      break;
    case Stage::kWorkspace:
      in.tool.position_m = {0.0, 0.2, 0.0};  // across the force: no energy
      in.tool.velocity_mps = {0.0, 2.0, 0.0};
      break;
    case Stage::kPassivity:  // flees with the force, turning, as fast as it may
      in.tool.position_m = {0.0009 * (tick - 200) - 0.1, 0.0, 0.0};
      in.tool.orientation = {std::cos(0.0045 * tick), 0.0, std::sin(0.0045 * tick), 0.0};
      in.wanted.force_N.x = 6.0;
      break;
    case Stage::kMagnitude:
      in.wanted = {{50.0, 40.0, 30.0}, {1.0, 1.0, 1.0}};
      break;
    case Stage::kSlew:
      in.wanted = {{0.0, 3.0 * sign, 1.0}, {0.0, 0.0, 0.08 * sign}};
      break;
    case Stage::kPower:  // a velocity that the positions do not show: power without energy
      in.wanted.force_N = {3.9, 0.0, 0.0};
      in.tool.velocity_mps = {0.95 * sign, 0.0, 0.0};
      in.tool.angular_velocity_radps = {0.0, 9.0, 0.0};
      in.wanted.torque_Nm = {0.0, 0.09, 0.0};
      break;
    case Stage::kRamp:
      in.armed = tick % 40 != 0;
      break;
  }
  return in;
}

/// Anything, so that any stages act together.
class Chance {
 public:
  GateInput next() {
    if (is(0.003)) armed_ = !armed_;
    if (is(0.02)) wanted_ = {ball(is(0.5) ? 60.0 : 5.0), ball(is(0.5) ? 1.0 : 0.1)};
    if (is(0.02)) speed_mps_ = is(0.3) ? 3.0 : 0.9;
    const Vec3 step_m =
        (speed_mps_ * kPeriod_s) * normalized(is(0.7) ? wanted_.force_N : ball(1.0));
    position_m_ += step_m;
    if (!(norm(position_m_) < 0.25)) position_m_ = {};
    angle_rad_ += 0.02 * unit();
    GateInput in{.wanted = wanted_, .tool = {}, .fresh = !is(0.1), .armed = armed_};
    in.tool.position_m = position_m_;
    in.tool.velocity_mps = step_m / kPeriod_s;
    in.tool.angular_velocity_radps = ball(is(0.1) ? 15.0 : 9.0);
    in.tool.orientation = {std::cos(angle_rad_), std::sin(angle_rad_), 0.0, 0.0};
    if (is(0.01)) in.skipped_periods = 3;
    if (is(0.002)) in.wanted.force_N.x = kNaN;
    return in;
  }

 private:
  double unit() { return static_cast<double>(random_() >> 11) * 0x1p-53; }
  bool is(double p) { return unit() < p; }
  Vec3 ball(double most) {
    const auto within = [&] { return most * (2.0 * unit() - 1.0); };
    return {within(), within(), within()};
  }

  std::mt19937_64 random_{1};
  bool armed_ = true;
  model::Wrench wanted_;
  Vec3 position_m_;
  double speed_mps_ = 0.5, angle_rad_ = 0.0;
};

std::int64_t now_ns() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return std::int64_t{1'000'000'000} * now.tv_sec + now.tv_nsec;
}

std::int64_t clock_ns() {
  std::int64_t least = std::numeric_limits<std::int64_t>::max();
  for (int i = 0; i < 100; ++i) {
    const std::int64_t before_ns = now_ns();
    least = std::min(least, now_ns() - before_ns);
  }
  return least;
}

struct CheckedTick {
  std::int64_t took_ns = std::numeric_limits<std::int64_t>::max();
  std::array<bool, kStageCount> acted{};
  bool acted_in(std::size_t row) const {
    return row == kNone ? std::ranges::none_of(acted, std::identity{}) : acted[row];
  }
};

std::vector<CheckedTick> check(const std::vector<GateInput>& inputs) {
  std::vector<CheckedTick> ticks(inputs.size());
  const std::int64_t clock = clock_ns();
  for (int time = 0; time < kTimes; ++time) {
    Gate gate(kLimits, kPeriod_s, 1.0);
    for (std::size_t i = 0; i < inputs.size(); ++i) {
      const auto before = gate.counters();
      const std::int64_t start_ns = now_ns();
      const firmware::gate::LimitedForce verdict = gate.limit(inputs[i]);
      const std::int64_t end_ns = now_ns();
      asm volatile("" : : "g"(&verdict) : "memory");
      ticks[i].took_ns = std::min(ticks[i].took_ns, end_ns - start_ns - clock);
      for (std::size_t s = 0; s < kStageCount; ++s)
        ticks[i].acted[s] = gate.counters()[s] > before[s];
    }
  }
  return ticks;
}

/// Of the ticks in which that stage acted; null: it never did.
json longest(const std::vector<CheckedTick>& ticks, std::size_t row) {
  std::int64_t most = -1;
  for (const CheckedTick& tick : ticks)
    if (tick.acted_in(row)) most = std::max(most, tick.took_ns);
  return most < 0 ? json(nullptr) : json(most);
}

json measure() {
  Chance chance;
  std::vector<GateInput> any(kChanceTicks);
  for (GateInput& in : any) in = chance.next();
  const std::vector<CheckedTick> by_chance = check(any);
  json out;
  for (std::size_t row = 0; row <= kNone; ++row) {
    std::vector<GateInput> own(kTicks);
    for (int i = 0; i < kTicks; ++i) own[static_cast<std::size_t>(i)] = input_for(row, i);
    const char* name = row == kNone ? "none" : firmware::gate::kStageName[row];
    out[name] = {{"alone", longest(check(own), row)}, {"longest", longest(by_chance, row)}};
  }
  return out;
}

}  // namespace
}  // namespace tact::rig

int main(int argc, char** argv) {
  CLI::App app{
      "tact-rig-gate: time of Gate::limit while each stage acts, ns, as JSON; on the virtual bench "
      "one instruction is one ns."};
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  fmt::print("{}\n", tact::rig::measure().dump(2));
  return 0;
}
