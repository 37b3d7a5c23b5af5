// SPDX-License-Identifier: Apache-2.0
// plan.h - the cases of the test of safety-limited force output: what each asks of the gate, what
// goes wrong in it, and what must come of it.
//
// A case arms the loop, waits until the gate is open, and begins at t = 0. Forces are shares of the
// force limit in use, so one plan fits every scene and device. A case may tighten one limit, never
// widen it: so a stage that the scene's limits leave no work is put to the test too.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "firmware/gate/gate.h"
#include "model/result.h"

namespace tact::tools::limits {

/// How the commanded force goes with time; along z if nothing else is said.
enum class Shape : std::uint8_t {
  kHold,      // size from 0.1 s on; with an injected fault from the start
  kRamp,      // 0 to size in 0.8 s; with an injected fault size from the start
  kImpulse,   // 10^6 N in one tick, at 0.1 s
  kNan,       // size, then NaN from 0.1 s on
  kInfinity,  // the same with infinity
  kFlip,      // size, sign changed every 0.1 s
  kChatter,   // size, sign changed at 200 Hz
  kDiagonal,  // size along x and along z
  kPump,      // along the velocity: size N s/m
  kWall,      // size N/m below z = 0
};

/// What goes wrong, from 0.1 s on.
enum class InjectedFault : std::uint8_t {
  kNone,
  kNoSample,
  kNanSample,
  kLateTick,  // takes one and a half periods
  kEmergencyStop,
  kDeadMan,
  kDeviceFault,
};

/// What the simulated hand does; on a real device such cases are not run.
enum class HandMove : std::uint8_t { kStill, kSideways, kOutside, kUp, kPress };

/// Where the force acts on the tool; kJaws: on two jaws that are closed, and so on the fingers.
enum class Grip : std::uint8_t { kCentre, kLever, kJaws };

struct Expected {
  firmware::gate::Stage stage = firmware::gate::Stage::kMagnitude;  // must act in the case
  model::Fault fault = model::Fault::kNone;                         // that latches
  double least_peak_ratio = 0.0;          // of the force limit: the case was no void one
  std::optional<double> zero_within_s{};  // of the cause
  double and_ticks = 0.0;                 // besides, at the rate of the run (at_rate)
};

/// The limits that every case is evaluated by, in the order of the report.
enum class Bound : std::uint8_t {
  kForce,
  kTorque,
  kStep,
  kTorqueStep,
  kPower,
  kEnergy,
  kRms,
  kTorqueRms,
  kGrip,
};
inline constexpr std::size_t kBoundCount = 9;

struct Case {
  const char* name;
  const char* what;  // for a reader who knows no code
  Shape shape = Shape::kHold;
  double size = 0.0;  // of the shape: share of force_N, or with kPump N s/m, with kWall N/m
  InjectedFault injected = InjectedFault::kNone;
  int injected_ticks = 0;
  HandMove hand = HandMove::kStill;
  Grip grip = Grip::kCentre;
  double duration_s = 0.4;
  double power_share = 1.0;        // of F v at the limits of force and speed; below 1: tightened
  double continuous_share = 1.0;   // of force_N; below 1: tightened, with thermal_time_s = 0.5
  double budget_share = 0.0;       // of the least energy_J that a scene may have; 0: as it is
  std::optional<Bound> reaches{};  // the limit that it is there to drive to
  Expected expected{};
};

inline constexpr double kCause_s = 0.1;

/// The case as it is run at this rate: bounds in seconds, long enough to see the end of them. Late
/// ticks are borne for longer without hard real time (overrun_counter.h).
Case at_rate(Case c, double period_s, bool hard_real_time);

/// All cases but the wall (wall.h), in the order of the report.
std::span<const Case> all_cases();
/// "all", or names with commas. An error says how to see what there is.
model::Result<std::vector<Case>> choose_cases(const std::string& names);
/// The name of the Z-width test in --plan, and is it asked for?
inline constexpr std::string_view kWallName = "stiff-wall";
inline constexpr const char* kNeedsHand = "needs the simulated hand";
inline constexpr const char* kNoGripForce = "these limits let no force on the fingers";
bool names_wall(const std::string& names);

/// True for cases in which a safety line opens.
inline bool opens_line(const Case& c) {
  return c.injected == InjectedFault::kEmergencyStop || c.injected == InjectedFault::kDeadMan;
}
/// Said of such a case on a real device with the line.
inline constexpr const char* kReportedInSoftware = "set in software: the contact was not opened";
/// The limits of this case: those of the scene, or one tighter.
model::Limits limits_of(const Case& c, const model::Limits& limits);

}  // namespace tact::tools::limits
