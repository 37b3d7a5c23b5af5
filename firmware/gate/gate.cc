#include "firmware/gate/gate.h"

#include <cmath>

namespace tact::firmware {
namespace {

constexpr double kStaleFade_s = 0.010;
constexpr double kWorkspaceFade_s = 0.050;
constexpr std::uint32_t kLostAfter = 20;  // missed samples in a row

Wrench operator*(double share, const Wrench& w) RT_SAFE {
  return {share * w.force_N, share * w.torque_Nm};
}

}  // namespace

model::Limits limits_for(const model::Limits& scene, const hal::DeviceInfo& device) {
  model::Limits limits = scene;
  limits.force_N = std::fmin(scene.force_N, device.max_force_N);
  limits.torque_Nm = std::fmin(scene.torque_Nm, device.max_torque_Nm);
  limits.workspace_radius_m = std::fmin(scene.workspace_radius_m, device.workspace_radius_m);
  limits.workspace_half_length_m =
      std::fmin(scene.workspace_half_length_m, device.workspace_half_length_m);
  return limits;
}

Gate::Gate(const model::Limits& limits, double period_s, double force_share)
    : period_s_(period_s),
      force_limit_N_(force_share * limits.force_N),
      torque_limit_Nm_(force_share * limits.torque_Nm),
      workspace_radius_m_(limits.workspace_radius_m),
      workspace_half_length_m_(limits.workspace_half_length_m),
      fresh_(kStaleFade_s, kStaleFade_s),
      workspace_(kWorkspaceFade_s, kWorkspaceFade_s),
      ramp_(limits.ramp_s, limits.ramp_s) {
  // All fades after the slew stage together change the force by less than this per tick, so that
  // the written force keeps |dF| <= slew dt. A slew too slow for its ramp keeps at least a tenth.
  const double slew_step_N = limits.slew_N_per_s * period_s;
  const double ramp_step_N = force_limit_N_ * period_s / limits.ramp_s;
  force_step_N_ = std::fmax(slew_step_N - ramp_step_N, 0.1 * slew_step_N);
  torque_step_Nm_ = force_limit_N_ > 0.0 ? force_step_N_ * torque_limit_Nm_ / force_limit_N_ : 0.0;
  ramp_.set(0.0);
}

GateVerdict Gate::judge(const GateInput& input) RT_SAFE {
  GateVerdict verdict{.wrench = input.wanted};
  if (!is_finite(input.wanted.force_N) || !is_finite(input.wanted.torque_Nm)) {
    verdict.wrench = {};
    verdict.fault = Fault::kForceNotFinite;
    ++counter_[static_cast<std::size_t>(Stage::kFinite)];
  }
  check_fresh(input, verdict);
  if (!input.armed || latches(verdict.fault)) {
    note(Stage::kArmed, Fault::kNotArmed, verdict);
    let_go();
    verdict.wrench = {};
    return verdict;
  }
  const double inside = workspace_.step(inside_workspace(input.position_m), period_s_);
  if (inside < 1.0) note(Stage::kWorkspace, Fault::kOutsideWorkspace, verdict);
  verdict.wrench = inside * verdict.wrench;
  limit(verdict);
  const double ramp = ramp_.step(true, period_s_);
  if (ramp < 1.0) note(Stage::kRamp, Fault::kRampingUp, verdict);
  verdict.wrench = ramp * verdict.wrench;
  return verdict;
}

void Gate::note(Stage stage, Fault reason, GateVerdict& verdict) RT_SAFE {
  ++counter_[static_cast<std::size_t>(stage)];
  verdict.limit = reason;
}

void Gate::check_fresh(const GateInput& input, GateVerdict& verdict) RT_SAFE {
  missed_ = input.fresh || !input.armed ? 0 : missed_ + 1;  // a device may take its time to wake
  const double level = fresh_.step(missed_ < 2, period_s_);
  if (missed_ > 0 || level < 1.0)
    note(Stage::kFresh, missed_ == 1 ? Fault::kSampleHeld : Fault::kSampleStale, verdict);
  if (missed_ >= kLostAfter) verdict.fault = Fault::kDeviceLost;
  verdict.wrench = level * verdict.wrench;
}

bool Gate::inside_workspace(const Vec3& p) const RT_SAFE {
  return std::hypot(p.y, p.z) <= workspace_radius_m_ && std::abs(p.x) <= workspace_half_length_m_;
}

void Gate::limit(GateVerdict& verdict) RT_SAFE {
  Wrench& w = verdict.wrench;
  if (limit_magnitude(w.force_N, force_limit_N_))
    note(Stage::kMagnitude, Fault::kForceLimited, verdict);
  if (limit_magnitude(w.torque_Nm, torque_limit_Nm_))
    note(Stage::kMagnitude, Fault::kTorqueLimited, verdict);
  const bool slow_force = limit_slew(w.force_N, before_.force_N, force_step_N_);
  const bool slow_torque = limit_slew(w.torque_Nm, before_.torque_Nm, torque_step_Nm_);
  if (slow_force || slow_torque) note(Stage::kSlew, Fault::kSlewLimited, verdict);
  before_ = w;
}

// Zero now: what comes after starts from zero and ramps up again.
void Gate::let_go() RT_SAFE {
  before_ = {};
  ramp_.set(0.0);
}

}  // namespace tact::firmware
