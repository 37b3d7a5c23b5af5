// SPDX-License-Identifier: Apache-2.0
#include "tools/printed/rhombus_paper.h"

#include <cmath>

namespace tact::tools::printed {
namespace {

// 1e-9 (kN + kT tan^2(th)): a difference of the two terms below this is rounding.
double negligible_N_per_m(const RhombusUnit& unit) RT_SAFE {
  const double t = std::tan(unit.initial_angle_rad);
  return 1e-9 * (unit.normal_stiffness_N_per_m + unit.tangential_stiffness_N_per_m * t * t);
}

}  // namespace

PaperUnit paper_forward(const RhombusUnit& unit, double angle_change_rad) RT_SAFE {
  const double a = unit.rod_length_m, th = unit.initial_angle_rad;
  const double kN = unit.normal_stiffness_N_per_m, kT = unit.tangential_stiffness_N_per_m;
  const double half = 0.5 * angle_change_rad;
  PaperUnit out;
  // (4)  dv = 2a (cos(th + dth) - cos(th)),  dl = 2a (sin(th + dth) - sin(th)), as products
  out.widening_m = -4.0 * a * std::sin(th + half) * std::sin(half);
  out.shortening_m = 4.0 * a * std::cos(th + half) * std::sin(half);
  // (6)  D = kN - kT tan(th + dth/2) tan(th)
  out.stiffness_N_per_m = kN - kT * std::tan(th + half) * std::tan(th);
  // (3)  F = kT dv tan(th) + kN dl
  out.force_N = kT * out.widening_m * std::tan(th) + kN * out.shortening_m;
  // (12)  the numerator's terms
  out.energy_J =
      0.5 * kN * out.shortening_m * out.shortening_m + 0.5 * kT * out.widening_m * out.widening_m;
  return out;
}

double paper_initial_stiffness_N_per_m(const RhombusUnit& unit) RT_SAFE {
  const double t = std::tan(unit.initial_angle_rad);
  return unit.normal_stiffness_N_per_m - unit.tangential_stiffness_N_per_m * t * t;
}

bool paper_is_singular(const RhombusUnit& unit) RT_SAFE {
  return paper_initial_stiffness_N_per_m(unit) <= negligible_N_per_m(unit);
}

bool paper_divides_by_zero(const RhombusUnit& unit, const PaperUnit& at) RT_SAFE {
  return std::abs(at.stiffness_N_per_m) <= negligible_N_per_m(unit);
}

PaperInverse paper_inverse(const RhombusUnit& unit, double force_N) RT_SAFE {
  if (!unit.is_valid() || !std::isfinite(force_N)) return {.status = LawStatus::kInvalid};
  if (paper_is_singular(unit)) return {.status = LawStatus::kSingular};
  const double th = unit.initial_angle_rad, two_a = 2.0 * unit.rod_length_m;
  const double kN = unit.normal_stiffness_N_per_m;
  const double b = unit.tangential_stiffness_N_per_m * std::tan(th);
  // (3) is F = 2a (kN sin(th') + b cos(th')) - const, largest where tan(th') = kN / b, least at
  // flat
  const double peak_rad = std::atan2(kN, b) - th, flat_rad = -th;
  const double end_rad = force_N > 0.0 ? peak_rad : flat_rad;
  PaperInverse out;
  out.limit_N = paper_forward(unit, end_rad).force_N;
  if (std::abs(force_N) >= std::abs(out.limit_N)) {
    out.angle_change_rad = end_rad;
    out.status = LawStatus::kSaturated;
  } else {
    // kN sin(th') + b cos(th') = R sin(th' + psi); one Newton step takes the cancellation away
    const double r = std::hypot(kN, b), psi = std::atan2(b, kN);
    const double sine = (force_N / two_a + kN * std::sin(th) + b * std::cos(th)) / r;
    double d = std::asin(sine < 1.0 ? sine : 1.0) - psi - th;
    for (int i = 0; i < 2; ++i) {
      const double slope = two_a * (kN * std::cos(th + d) - b * std::sin(th + d));
      if (slope > 0.0) d -= (paper_forward(unit, d).force_N - force_N) / slope;
    }
    out.angle_change_rad = d;
  }
  out.lambda = std::abs(out.angle_change_rad) / th;
  out.unit = paper_forward(unit, out.angle_change_rad);
  return out;
}

}  // namespace tact::tools::printed
