// SPDX-License-Identifier: Apache-2.0
#include "tools/limits/cases/player.h"

#include <cmath>
#include <limits>

namespace tact::tools::limits {
namespace {

// Chosen: slow beside any slew, fast beside the case; a million newtons are beyond any limit.
constexpr double kRampTime_s = 0.8;
constexpr double kImpulse_N = 1e6;
constexpr double kFlip_s = 0.1, kChatter_s = 0.0025;  // half a wave
constexpr double kHair_s = 1e-9;                      // times are multiples of the period

/// +1 and -1, each for so long.
double square(double t_s, double half_s) RT_SAFE {
  // A multiple of the period may come out a hair too small, and the sign would change a tick late.
  return std::fmod(std::floor((t_s + kHair_s) / half_s), 2.0) == 0.0 ? 1.0 : -1.0;
}

}  // namespace

Vec3 command_at(const Case& c, const Moment& now, const model::Tool& tool, double limit_N) RT_SAFE {
  if (!now.playing) return {};
  const double size_N = c.size * limit_N;
  const bool after = now.after_cause();
  switch (c.shape) {
    case Shape::kHold:
      // An injected fault needs a force to stop: it lasts from the start.
      return {0, 0, after || c.injected != InjectedFault::kNone ? size_N : 0.0};
    case Shape::kRamp:
      if (c.injected != InjectedFault::kNone) return {0, 0, size_N};
      return {0, 0, size_N * std::fmin(now.t_s() / kRampTime_s, 1.0)};
    case Shape::kImpulse:
      return {0, 0, now.ticks == now.cause_tick() ? kImpulse_N : 0.0};
    case Shape::kNan:
      return {0, 0, after ? std::numeric_limits<double>::quiet_NaN() : size_N};
    case Shape::kInfinity:
      return {0, 0, after ? std::numeric_limits<double>::infinity() : size_N};
    case Shape::kFlip:
      return {0, 0, size_N * square(now.t_s(), kFlip_s)};
    case Shape::kChatter:
      return {0, 0, size_N * square(now.t_s(), kChatter_s)};
    case Shape::kDiagonal:
      return after ? Vec3{size_N, 0, size_N} : Vec3{};
    case Shape::kPump:
      return {0, 0, c.size * tool.velocity_mps.z};
    case Shape::kWall:
      return {0, 0, tool.position_m.z < 0.0 ? -c.size * tool.position_m.z : 0.0};
  }
  return {};
}

bool is_injected(const Case& c, const Moment& now) RT_SAFE {
  if (!now.playing || c.injected == InjectedFault::kNone) return false;
  return now.after_cause() && now.ticks - now.cause_tick() < c.injected_ticks;
}

model::contact::ContactLawResponse CommandLaw::respond(
    const model::contact::Indentation& in) RT_SAFE {
  const Vec3 force_N = command_at(case_, now_, tool_, limit_N_);
  model::contact::ContactLawResponse response;
  // A tool of one sphere: others would command the force again.
  if (in.sphere != 0) return response;
  response.law.force_N = force_N.z;
  // The law gives the part along the normal; the slope carries the rest through contact.
  response.slope_N = {-force_N.x, -force_N.y, 0.0};  // contact takes the slope from the force
  return response;
}

Fault PlayedDevice::read(hal::Sample& sample, std::int64_t now_ns) RT_SAFE {
  const Fault fault = device_.read(sample, now_ns);
  if (sample.fresh) tool_ = sample.tool;
  if (!is_injected(case_, now_)) return fault;
  switch (case_.injected) {
    case InjectedFault::kNoSample:
      sample.fresh = false;
      break;
    case InjectedFault::kNanSample:
      sample.tool.position_m.z = std::numeric_limits<double>::quiet_NaN();
      break;
    case InjectedFault::kLateTick:
      clock_.sleep_until_ns(now_ns + std::llround(1.5e9 * now_.period_s));
      break;
    case InjectedFault::kDeviceFault:
      return Fault::kDeviceFailed;
    default:
      break;
  }
  return fault;
}

Fault PlayedLines::read(std::int64_t now_ns) RT_SAFE {
  const bool active = is_injected(case_, now_);
  const bool stop = active && case_.injected == InjectedFault::kEmergencyStop;
  const bool let_go = active && case_.injected == InjectedFault::kDeadMan;
  if (simulated_ != nullptr) {
    simulated_->inputs().estop_a.store(!stop, std::memory_order_relaxed);
    simulated_->inputs().estop_b.store(!stop, std::memory_order_relaxed);
    simulated_->inputs().dead_man.store(!let_go, std::memory_order_relaxed);
  }
  const Fault fault = lines_.read(now_ns);
  // A real line that has opened precedes the one that is set.
  if (simulated_ != nullptr || fault != Fault::kNone) return fault;
  if (stop) return Fault::kEmergencyStop;
  return let_go ? Fault::kDeadManReleased : Fault::kNone;
}

}  // namespace tact::tools::limits
