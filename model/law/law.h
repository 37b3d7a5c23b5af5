// SPDX-License-Identifier: Apache-2.0
// law.h - interface of every force law.
//
// A law maps the signed displacement of a contact point to a force and a displacement profile:
//
//     d    depth, m: press inward positive, pull outward negative (only while the contact point is
//          held)
//     F    force on the tool along the outward normal, N: F = dU/dd, F(0) = 0
//     K    dF/dd, N/m      U   stored energy, J, U(0) = 0
//     u_j  displacement of ring j into the tissue, m, at radius j * ring_pitch_m; u_0 = d
//
// A law may also have damping, which is not part of its stored energy:
//
//     LW-3   F_total = F(d) + b(d) d',   b >= 0;   not held: F_total >= 0
//
//     d'   speed of the depth, m/s, pressing positive     b  damping, N s/m; b d'^2 is lost
//
// So no stroke returns more energy than it took, for any b and d'. In a loop b is an explicit
// damper: the sum over all spheres must stay below the damping of the device (HL-1), for any mass
// at the tool.
//
// Valid on [range.pull_m, range.press_m]; beyond, the force stays at its limit with status
// kSaturated. NaN gives zero force and kInvalid. Contract tests: tests/model/law/law_contract.h.
#pragma once

#include <cmath>
#include <cstdint>
#include <span>

#include "model/rt.h"

namespace tact::model::law {

enum class LawStatus : std::uint8_t {
  kOk,
  kNoContact,
  kSaturated,
  kSingular,
  kInvalid,
};

struct LawResponse {
  double force_N = 0.0;
  double stiffness_N_per_m = 0.0;
  double energy_J = 0.0;
  LawStatus status = LawStatus::kOk;
};

struct LawRange {
  double pull_m = 0.0;   // <= 0; 0: this law cannot pull
  double press_m = 0.0;  // > 0
};

class Law {
 public:
  virtual ~Law() = default;
  virtual LawResponse respond(double depth_m) const RT_SAFE = 0;
  /// b, N s/m (LW-3); not part of U or K. 0 for d <= 0 and NaN.
  virtual double damping_Ns_per_m(double depth_m) const RT_SAFE {
    (void)depth_m;
    return 0.0;
  }
  virtual LawRange range() const RT_SAFE = 0;
  /// Fills u_0 .. u_N and returns their number: N + 1, at most the size of the span. Not called in
  /// a tick; RT_SAFE, as telemetry calls it while the loop runs.
  virtual std::size_t profile(double depth_m, std::span<double> ring_m) const RT_SAFE = 0;
  virtual double ring_pitch_m() const RT_SAFE = 0;
};

/// Beyond a limit the force is constant, K is 0, and U = U_limit + F (d - d_limit). Within it
/// (inside_m == depth_m) the response is unchanged.
inline LawResponse beyond_limit(const LawResponse& at, double inside_m, double depth_m) RT_SAFE {
  const bool is_beyond = depth_m < inside_m || depth_m > inside_m;  // NaN is not
  if (!is_beyond) return at;
  return {.force_N = at.force_N,
          .stiffness_N_per_m = 0.0,
          .energy_J = at.energy_J + at.force_N * (depth_m - inside_m),
          .status = LawStatus::kSaturated};
}

/// The response of a law that only presses: `inside` answers depths in [0, end_m].
template <typename Inside>
LawResponse press_response(double depth_m, double end_m, const Inside& inside) RT_SAFE {
  if (!std::isfinite(depth_m)) return {.status = LawStatus::kInvalid};
  if (depth_m < 0.0) return {.status = LawStatus::kNoContact};
  const double inside_m = depth_m < end_m ? depth_m : end_m;
  return beyond_limit(inside(inside_m), inside_m, depth_m);
}

/// LawResponse of a law's state; a saturated state is that at limit_m.
template <typename State>
LawResponse response_of(const State& at, double limit_m, double depth_m) RT_SAFE {
  const LawResponse out{at.force_N, at.stiffness_N_per_m, at.energy_J, at.status};
  return beyond_limit(out, at.status == LawStatus::kSaturated ? limit_m : depth_m, depth_m);
}

/// LW-3: force added by the speed, N.
inline double resistance_N(double damping_Ns_per_m, double speed_mps, double force_N,
                           bool held) RT_SAFE {
  const double resistance_N = damping_Ns_per_m * speed_mps;
  if (!std::isfinite(resistance_N)) return 0.0;
  const double least_N = force_N > 0.0 ? -force_N : 0.0;
  return held || resistance_N > least_N ? resistance_N : least_N;
}

}  // namespace tact::model::law
