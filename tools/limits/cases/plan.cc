// SPDX-License-Identifier: Apache-2.0
#include "tools/limits/cases/plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <sstream>

namespace tact::tools::limits {
namespace {

using firmware::gate::Stage;
using model::Error;
using model::Fault;
using model::Result;

// A missed sample is held, then the force fades in 10 ms; outside the workspace it takes 50 ms. One
// tick is lost where the cause is noticed, half a one to rounding.
constexpr double kAtOnce_s = 0.0;
constexpr double kStale_s = 0.010;
constexpr double kWorkspace_s = 0.050;
constexpr double kFadeTicks = 1.5;
// Late ticks of two periods: 20 with hard real time, 100 without, where a stall may come between.
constexpr double kLateTicks = 42;
constexpr double kLateTicksNonRt = 250;

constexpr int kForGood = 1'000'000;  // ticks

/// The stage acts, and force and torque come to zero: within_s of the cause and so many ticks more.
constexpr Expected ends(Stage stage, Fault fault, double least_peak_ratio = 0.0,
                        double within_s = kAtOnce_s, double and_ticks = 0.0) {
  return {.stage = stage,
          .fault = fault,
          .least_peak_ratio = least_peak_ratio,
          .zero_within_s = within_s,
          .and_ticks = and_ticks};
}

/// Something goes wrong for so many ticks while the limit is commanded.
constexpr Case goes_wrong(const char* name, const char* what, InjectedFault injected, int ticks,
                          const Expected& expected, Grip grip = Grip::kCentre) {
  return {.name = name,
          .what = what,
          .shape = Shape::kRamp,
          .size = 1.0,
          .injected = injected,
          .injected_ticks = ticks,
          .grip = grip,
          .duration_s = injected == InjectedFault::kLateTick ? 0.5 : 0.4,
          .expected = expected};
}

constexpr std::array kCases{
    Case{.name = "ramp",
         .what = "The commanded force rises slowly to one and a half times the limit.",
         .shape = Shape::kRamp,
         .size = 1.5,
         .duration_s = 1.0,
         .reaches = Bound::kForce,
         .expected = {.stage = Stage::kMagnitude, .least_peak_ratio = 0.999}},
    Case{.name = "diagonal",
         .what = "Each axis stays below the limit, the vector does not.",
         .shape = Shape::kDiagonal,
         .size = 0.9,
         .reaches = Bound::kForce,
         .expected = {.stage = Stage::kMagnitude, .least_peak_ratio = 0.999}},
    Case{.name = "step",
         .what = "The commanded force jumps from zero to the limit in one tick.",
         .shape = Shape::kHold,
         .size = 1.0,
         .reaches = Bound::kStep,
         .expected = {.stage = Stage::kSlew, .least_peak_ratio = 0.99}},
    Case{.name = "impulse",
         .what = "A million newtons are commanded for one tick.",
         .shape = Shape::kImpulse,
         .expected = {.stage = Stage::kMagnitude, .least_peak_ratio = 0.01}},
    Case{.name = "sign-flip",
         .what = "The commanded force changes its sign every 0.1 s, at the limit.",
         .shape = Shape::kFlip,
         .size = 1.0,
         .duration_s = 0.6,
         .reaches = Bound::kStep,
         .expected = {.stage = Stage::kSlew, .least_peak_ratio = 0.9}},
    Case{.name = "chatter",
         .what = "The commanded force changes its sign 400 times a second (200 Hz), at the limit.",
         .shape = Shape::kChatter,
         .size = 1.0,
         .reaches = Bound::kStep,
         .expected = {.stage = Stage::kSlew, .least_peak_ratio = 0.05}},
    Case{.name = "torque",
         .what = "The force acts on a lever, so that the torque passes its limit before the force.",
         .shape = Shape::kRamp,
         .size = 1.0,
         .grip = Grip::kLever,
         .duration_s = 1.0,
         .reaches = Bound::kTorque,
         .expected = {.stage = Stage::kMagnitude, .least_peak_ratio = 0.9}},
    Case{.name = "torque-step",
         .what = "The force on that lever jumps to its limit in one tick.",
         .shape = Shape::kHold,
         .size = 1.0,
         .grip = Grip::kLever,
         .reaches = Bound::kTorqueStep,
         .expected = {.stage = Stage::kSlew, .least_peak_ratio = 0.5}},
    Case{.name = "nan-force",
         .what = "The model computes NaN (not a number) in mid-force.",
         .shape = Shape::kNan,
         .size = 0.5,
         .expected = ends(Stage::kFinite, Fault::kForceNotFinite, 0.45)},
    Case{.name = "infinite-force",
         .what = "The model computes infinity in mid-force.",
         .shape = Shape::kInfinity,
         .size = 0.5,
         .expected = ends(Stage::kFinite, Fault::kForceNotFinite, 0.45)},
    Case{.name = "nan-sample",
         .what = "The device reports NaN as its position in mid-force.",
         .shape = Shape::kHold,
         .size = 0.5,
         .injected = InjectedFault::kNanSample,
         .injected_ticks = 1,
         .expected = ends(Stage::kFinite, Fault::kSampleNotFinite)},
    goes_wrong("stale-samples",
               "The device gives no new sample for 15 ticks, then goes on. With torque.",
               InjectedFault::kNoSample, 15,
               ends(Stage::kFresh, Fault::kNone, 0.0, kStale_s, kFadeTicks), Grip::kLever),
    goes_wrong("lost-device", "The device gives no new sample any more. With torque.",
               InjectedFault::kNoSample, kForGood,
               ends(Stage::kFresh, Fault::kDeviceLost, 0.0, kStale_s, kFadeTicks), Grip::kLever),
    goes_wrong("late-ticks",
               "Every tick takes one and a half periods: the loop is too slow for its rate.",
               InjectedFault::kLateTick, kForGood,
               ends(Stage::kArmed, Fault::kLoopLate, 0.0, kAtOnce_s, kLateTicks)),
    goes_wrong("e-stop", "The emergency stop opens in mid-force, and in mid-torque.",
               InjectedFault::kEmergencyStop, kForGood, ends(Stage::kArmed, Fault::kEmergencyStop),
               Grip::kLever),
    goes_wrong("e-stop-released",
               "The emergency stop opens for 50 ticks and closes again: nothing moves by itself.",
               InjectedFault::kEmergencyStop, 50, ends(Stage::kArmed, Fault::kEmergencyStop)),
    goes_wrong("dead-man", "The dead-man switch is released under force.", InjectedFault::kDeadMan,
               kForGood, ends(Stage::kArmed, Fault::kDeadManReleased)),
    goes_wrong("device-fault", "The device reports a fault of its own in mid-force.",
               InjectedFault::kDeviceFault, 1, ends(Stage::kArmed, Fault::kDeviceFailed)),
    Case{.name = "speed",
         .what = "The hand tears the tool sideways, faster than permitted.",
         .shape = Shape::kHold,
         .size = 0.5,
         .hand = HandMove::kSideways,
         .duration_s = 0.6,
         .expected = ends(Stage::kWorkspace, Fault::kNone, 0.45, kWorkspace_s, kFadeTicks)},
    Case{.name = "workspace",
         .what = "The hand carries the tool out of the permitted workspace and stays. With torque.",
         .shape = Shape::kHold,
         .size = 0.5,
         .hand = HandMove::kOutside,
         .grip = Grip::kLever,
         .duration_s = 0.8,
         .expected = ends(Stage::kWorkspace, Fault::kNone, 0.45, kWorkspace_s, kFadeTicks)},
    Case{.name = "power",
         .what = "The tool moves along with the force; the power limit is made tighter.",
         .shape = Shape::kHold,
         .size = 0.8,
         .hand = HandMove::kUp,
         .duration_s = 0.6,
         .power_share = 0.1,
         .reaches = Bound::kPower,
         .expected = {.stage = Stage::kPower, .least_peak_ratio = 0.3}},
    Case{.name = "continuous",
         .what = "The limit is commanded for long; the continuous limit is made half of it.",
         .shape = Shape::kHold,
         .size = 1.0,
         .duration_s = 2.0,
         .continuous_share = 0.5,
         .reaches = Bound::kRms,
         .expected = {.stage = Stage::kMagnitude, .least_peak_ratio = 0.99}},
    Case{.name = "warm-torque",
         .what = "The same on a lever, so that the torque is held at its limit for long.",
         .shape = Shape::kHold,
         .size = 1.0,
         .grip = Grip::kLever,
         .duration_s = 2.0,
         .continuous_share = 0.5,
         .reaches = Bound::kTorqueRms,
         .expected = {.stage = Stage::kMagnitude, .least_peak_ratio = 0.5}},
    Case{.name = "fingers",
         .what = "The jaws close on tissue that pushes them apart, harder than the fingers may be "
                 "pressed.",
         .shape = Shape::kRamp,
         .size = 4.0,
         .grip = Grip::kJaws,
         .duration_s = 1.0,
         .reaches = Bound::kGrip,
         .expected = {.stage = Stage::kMagnitude, .least_peak_ratio = 0.9}},
    Case{.name = "active-law",
         .what = "A wrong law pushes along every motion, so that it gives energy without end.",
         .shape = Shape::kPump,
         .size = 60.0,
         .hand = HandMove::kPress,
         .duration_s = 3.0,
         .budget_share = 1.1,
         .reaches = Bound::kEnergy,
         .expected = {.stage = Stage::kPassivity, .least_peak_ratio = 0.2}},
};

}  // namespace

Case at_rate(Case c, double period_s, bool hard_real_time) {
  if (c.injected == InjectedFault::kLateTick && !hard_real_time)
    c.expected.and_ticks = kLateTicksNonRt;
  const double more_s = c.expected.and_ticks * period_s;
  if (c.expected.zero_within_s) *c.expected.zero_within_s += more_s;
  c.expected.and_ticks = 0.0;
  // Samples that come back before the fade is over: at high rates, so many do not make 10 ms.
  // Then no zero is asked for; that the stage acted still is.
  if (c.injected == InjectedFault::kNoSample &&
      c.injected_ticks * period_s < c.expected.zero_within_s)
    c.expected.zero_within_s.reset();
  // Slow rates need longer to show that the force stays zero; 1.2: a fifth of it to look on.
  c.duration_s = std::max(c.duration_s, kCause_s + 1.2 * more_s);
  return c;
}

std::span<const Case> all_cases() { return kCases; }

Result<std::vector<Case>> choose_cases(const std::string& names) {
  if (names == "all") return std::vector<Case>(kCases.begin(), kCases.end());
  std::vector<Case> chosen;
  std::istringstream in(names);
  for (std::string name; std::getline(in, name, ',');) {
    if (name == kWallName) continue;
    const auto* found =
        std::find_if(kCases.begin(), kCases.end(), [&](const Case& c) { return name == c.name; });
    if (found == kCases.end())
      return Error{fmt::format("--plan {}: no such case; --list shows them all", name)};
    const auto same = [&](const Case& c) { return name == c.name; };
    if (std::none_of(chosen.begin(), chosen.end(), same)) chosen.push_back(*found);
  }
  if (names.empty()) return Error{"--plan: names no case; --list shows them all"};
  return chosen;
}

bool names_wall(const std::string& names) {
  if (names == "all") return true;
  std::istringstream in(names);
  for (std::string name; std::getline(in, name, ',');)
    if (name == kWallName) return true;
  return false;
}

}  // namespace tact::tools::limits
