// SPDX-License-Identifier: Apache-2.0
#include "tools/limits/cases/case_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "hal/sim/sim_delta.h"
#include "model/indent/rhombus_patch.h"
#include "model/time_ns.h"
#include "tools/program/interrupt.h"

namespace tact::tools::limits {
namespace {

constexpr double kLongestPeriod_s = 0.01;  // 100 Hz, the slowest scene
constexpr double kLead_s = 0.1;  // beyond the ramp, so that the gate is wide open at t = 0
// A person may have to close an e-stop first.
constexpr double kSimulatedWait_s = 2.0, kRealWait_s = 60.0;
constexpr double kLeverWithoutTorque_m = 0.05;
// The sphere of 2 m around a tool within some tenths of a metre always reaches a plate 1 m below.
constexpr double kHalfPlate_m = 4.0, kPlate_m = -1.0, kReach_m = 2.0;
constexpr double kClear_m = 1.5;  // so far up it does not touch

/// A plate far below and a sphere so large that it is always in contact: contact adds nothing to
/// the command but its own way.
model::scene::Scene plate_scene(const Case& c, const LimitsBench& bench,
                                const model::Limits& limits) {
  model::scene::Scene scene;
  scene.path = "limits";
  scene.rate_Hz = bench.scene.rate_Hz;
  scene.laws.of<model::indent::RhombusParameters>().chain = {.rod_length_m = 0.1,
                                                             .initial_angle_rad = 0.5,
                                                             .normal_stiffness_N_per_m = 1.0,
                                                             .tangential_stiffness_N_per_m = 0.0,
                                                             .growth = 1.0,
                                                             .units = 1};
  scene.contact.tear_force_N = 0.01;
  // on a lever of twice torque over force the torque is the first to pass its limit
  const bool turns = limits.force_N > 0.0 && limits.torque_Nm > 0.0;
  const double lever_m = turns ? 2.0 * limits.torque_Nm / limits.force_N : kLeverWithoutTorque_m;
  scene.tool.spheres = {{{0, c.grip == Grip::kLever ? lever_m : 0.0, 0}, kReach_m}};
  if (c.grip == Grip::kJaws) scene.tool.spheres.push_back(scene.tool.spheres.front());
  scene.organ_mesh = *model::mesh::make_surface_mesh({{-kHalfPlate_m, -kHalfPlate_m, kPlate_m},
                                                      {kHalfPlate_m, -kHalfPlate_m, kPlate_m},
                                                      {kHalfPlate_m, kHalfPlate_m, kPlate_m},
                                                      {-kHalfPlate_m, kHalfPlate_m, kPlate_m}},
                                                     {{0, 1, 2}, {0, 2, 3}});
  return scene;
}

/// The scene is ours, so an error is a mistake of ours: without a plate nothing would be proved.
std::unique_ptr<model::scene::Tissue> make_plate(const model::scene::Scene& scene) {
  auto tissue = model::scene::make_tissue(scene);
  if (tissue) return std::move(*tissue);
  fmt::print(stderr, "tact-limits: {}\n", tissue.error().message);
  std::abort();
}

/// The hand of a case. Arming takes a second or less with the longest ramp of a scene added.
model::HandSettings hand_of(const Case& c, const model::Limits& limits) {
  model::HandSettings hand{.mass_kg = 0.2,
                           .stiffness_N_per_m = 3000.0,
                           .damping_Ns_per_m = 30.0,
                           .repeat = false,
                           .path = {}};
  const double begin_s = 0.1 + limits.ramp_s + kLead_s + kCause_s;  // lines, ramp, lead, cause
  const double away_m = limits.workspace_radius_m;
  const auto path = [&](const Vec3& from_m, const Vec3& to_m, double in_s) {
    hand.path = {{.time_s = 0.0, .position_m = from_m},
                 {.time_s = begin_s, .position_m = from_m},
                 {.time_s = begin_s + in_s, .position_m = to_m}};
  };
  switch (c.hand) {
    case HandMove::kStill:
      hand.path = {
          {.time_s = 0.0, .position_m = {}, .grip_ratio = c.grip == Grip::kJaws ? 1.0 : 0.0}};
      break;
    case HandMove::kSideways:  // a smooth stroke is 1.875 times as fast in its middle
      path({0, -0.8 * away_m, 0}, {0, 0.8 * away_m, 0}, 1.6 * away_m / limits.speed_mps);
      break;
    case HandMove::kOutside:
      path({0, 0.5 * away_m, 0}, {0, away_m + 0.01, 0}, 0.3);
      break;
    case HandMove::kUp:
      path({0, 0, -0.4 * away_m}, {0, 0, 0.4 * away_m}, 2.0 * away_m / limits.speed_mps);
      break;
    case HandMove::kPress:  // light, so that what the loop does is seen
      hand.stiffness_N_per_m = 200.0;
      hand.damping_Ns_per_m = 1.0;
      path({0, 0, 0.01}, {0, 0, -0.01}, 0.2);
      break;
  }
  return hand;
}

std::uint32_t acted_since(std::array<std::uint64_t, firmware::gate::kStageCount>& before,
                          const std::array<std::uint64_t, firmware::gate::kStageCount>& now) {
  std::uint32_t acted = 0;
  for (std::size_t i = 0; i < now.size(); ++i)
    if (now[i] != before[i]) acted |= 1u << i;
  before = now;
  return acted;
}

}  // namespace

model::Limits limits_of(const Case& c, const model::Limits& limits) {
  model::Limits tight = limits;
  if (c.budget_share > 0.0) {  // less than twice what the brake needs is refused in a scene
    const double slew_N_per_s = model::slew_beside_ramp_N_per_s(limits);
    // What the gate's tank keeps for its brake (energy_tank.cc), with the longest period.
    const double fall_s = 0.5 * limits.force_N / slew_N_per_s + kLongestPeriod_s;
    const double need_J =
        (limits.speed_mps * limits.force_N + limits.turn_radps * limits.torque_Nm) * fall_s;
    // Tighter only: a case must never loosen what the scene permits.
    tight.energy_J = std::min(limits.energy_J, c.budget_share * 2.0 * need_J);
  }
  if (c.power_share < 1.0)
    tight.power_W = std::min(limits.power_W, c.power_share * limits.force_N * limits.speed_mps);
  if (c.continuous_share < 1.0) {
    // Chosen: the case lasts four of these times, so the mean comes close to its end.
    constexpr double kWarm_s = 0.5;
    tight.continuous_force_N =
        std::min(limits.continuous_force_N, c.continuous_share * limits.force_N);
    tight.thermal_time_s = std::min(limits.thermal_time_s, kWarm_s);
  }
  return tight;
}

model::Limits checked_limits(const Case& c, const LimitsBench& bench) {
  return model::limits_in_use(limits_of(c, bench.limits), bench.force_share);
}

CaseRun::CaseRun(const Case& c, const LimitsBench& bench)
    : case_(c),
      limits_(checked_limits(c, bench)),
      moment_({.period_s = bench.period_s()}),
      scene_(plate_scene(c, bench, limits_)),
      tissue_(make_plate(scene_)),
      requests_(bench.requests != nullptr ? *bench.requests : own_requests_),
      lead_ticks_(static_cast<int>(std::lround((limits_.ramp_s + kLead_s) / bench.period_s()))),
      most_wait_ticks_(static_cast<int>((bench.device != nullptr ? kRealWait_s : kSimulatedWait_s) /
                                        bench.period_s())) {
  hal::Device* device = bench.device;
  hal::SafetyLines* lines = bench.lines;
  if (device == nullptr) {
    simulated_device_.reset(new hal::sim::SimDelta(
        bench.scene.device.of<hal::sim::SimDeviceSettings>(), hand_of(c, limits_)));
    device = simulated_device_.get();
    // without lines the watch of the loop is alone: with them a paused heartbeat stops it before
    if (c.injected == InjectedFault::kLateTick)
      lines = &no_lines_;
    else
      lines = &simulated_lines_;
    clock_ = std::make_unique<firmware::loop::SimulatedClock>();
  } else {
    clock_ = std::make_unique<firmware::loop::MonotonicClock>();
  }
  // Between loop and device: what it sees written is what the hand gets.
  device_ = std::make_unique<PlayedDevice>(case_, moment_, *device, *clock_);
  lines_ = std::make_unique<PlayedLines>(case_, moment_, *lines,
                                         lines == &simulated_lines_ ? &simulated_lines_ : nullptr);
  law_ = std::make_unique<CommandLaw>(case_, limits_.force_N, moment_, device_->tool());
  model::contact::ContactScene contact = tissue_->contact_scene();
  contact.law = law_.get();
  const model::Limits claimed = limits_of(c, bench.limits);
  const model::Limits claimed_gate =
      bench.gate_limits != nullptr ? bench.gate_limits(claimed) : claimed;
  controller_ = std::make_unique<firmware::loop::Controller>(
      contact, firmware::gate::Gate(claimed_gate, moment_.period_s, bench.force_share),
      bench.hard_real_time,
      c.grip == Grip::kJaws
          ? firmware::gate::GripGate::make(claimed_gate, moment_.period_s, bench.force_share)
          : std::nullopt);
  loop_ = std::make_unique<firmware::loop::RtLoop>(
      firmware::loop::LoopSettings{.period_ns = model::period_ns(bench.scene.rate_Hz)}, *device_,
      *lines_, *controller_, *clock_, requests_, *ring_);
  rows_.reserve(static_cast<std::size_t>(lead_ticks_) +
                static_cast<std::size_t>(c.duration_s / moment_.period_s) + 2);
}

bool CaseRun::play() {
  const int ticks = static_cast<int>(std::lround(case_.duration_s / moment_.period_s));
  firmware::loop::TickRecord record;
  bool has_contact = false;
  int waited = 0, open = 0;
  bool going = true;
  while (going && waited < most_wait_ticks_ && open < lead_ticks_ + ticks) {
    moment_.playing = open >= lead_ticks_;
    moment_.ticks = open - lead_ticks_;
    const bool cause = is_injected(case_, moment_);
    loop_->step();
    while (ring_->pop(record)) keep(record, cause);
    if (!has_contact && record.input.sample.fresh) {
      approach(record.input);
      has_contact = true;
      requests_.arm_at_start.store(true);
    }
    rows_.empty() ? ++waited : ++open;
    // a device keeps its own fault until it is opened again: no use to wait
    if (rows_.empty() && latches(record.output.fault)) {
      refused_ = record.output.fault;
      break;
    }
    going = !program::is_interrupted() && !requests_.stop.load();
  }
  // Zero force and power off, for every end.
  loop_->release_device();
  return going;
}

// Between two ticks, before arming. The sphere comes from outside, no faster than the gate allows:
// one that is found in the tissue has no force.
void CaseRun::approach(const firmware::loop::TickInput& at) {
  constexpr std::uint32_t kPeriods = 20;
  const double reach_m = kPeriods * controller_->gate().speed_limit_mps() * moment_.period_s;
  const double step_m = std::clamp(reach_m, 1e-4, kClear_m);
  firmware::loop::TickInput above = at;
  above.skipped_periods = kPeriods - 1;
  for (double height_m = kClear_m; height_m > -step_m; height_m -= step_m) {
    above.sample.tool.position_m.z = at.sample.tool.position_m.z + std::max(height_m, 0.0);
    controller_->detect_contact(above);
    controller_->render_force(above);
  }
}

void CaseRun::keep(const firmware::loop::TickRecord& record, bool cause) {
  const std::uint32_t acted = acted_since(counted_, controller_->gate().counters());
  const bool armed = record.output.state == firmware::loop::State::kArmed;
  if (rows_.empty() && !armed) return;
  // Full: a push would allocate in the loop.
  if (rows_.size() == rows_.capacity()) return;
  // t = 0 is the deadline of the first tick that is played.
  if (!moment_.playing || moment_.ticks == 0) begin_ns_ = record.due_ns;
  const double lead_s = moment_.playing ? 0.0 : moment_.t_s();
  const firmware::loop::TickInput& in = record.input;
  const firmware::loop::TickOutput& out = record.output;
  rows_.push_back({.t_s = lead_s + 1e-9 * static_cast<double>(record.due_ns - begin_ns_),
                   .commanded_N = out.wanted.force_N,
                   .gated_N = out.written.force_N,
                   .written_N = device_->written().force_N,
                   .commanded_Nm = out.wanted.torque_Nm,
                   .gated_Nm = out.written.torque_Nm,
                   .written_Nm = device_->written().torque_Nm,
                   .tool = in.sample.tool,
                   .fresh = in.sample.fresh,
                   .armed = armed,
                   .cause = cause,
                   .skipped_periods = in.skipped_periods,
                   .acted = acted,
                   .limit = out.limit,
                   .fault = out.fault,
                   .given_energy_J = out.given_energy_J,
                   .rms_N = out.rms_force_N,
                   .gated_grip_N = out.written_grip_N,
                   .written_grip_N = device_->written_grip_N()});
}

}  // namespace tact::tools::limits
