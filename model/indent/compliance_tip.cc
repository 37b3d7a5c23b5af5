// SPDX-License-Identifier: Apache-2.0
#include "model/indent/compliance_tip.h"

#include <array>
#include <cmath>
#include <numbers>

namespace tact::model::indent {
namespace {

// Of s. Below, CT-2 is a difference of nearly equal numbers: its series. At 1e-2 both are right to
// 2e-13; at 1e-3 the closed form would be off by 2e-11.
constexpr double kSmall = 1e-2;

// Gauss-Legendre, 8 points on -1 .. 1, the positive half of them. CT-4 comes out within 1e-5 of the
// depth for indentations up to 1.9 R: enough for a picture.
constexpr std::array<double, 4> kNode{0.1834346424956498, 0.5255324099163290, 0.7966664774136267,
                                      0.9602898564975363};
constexpr std::array<double, 4> kWeight{0.3626837833783620, 0.3137066458778873, 0.2223810344533745,
                                        0.1012285362903763};

/// CT-8 at s > 0, so that dt/dx is finite; t = a/R = tanh s and x = s t.
StrainFactor factor_at(double poisson_ratio, double s) RT_SAFE {
  const double w = 1.0 - 2.0 * poisson_ratio, t = std::tanh(s), x = s * t;
  // CT-9  d(a/R)/dx
  const double dt_dx = (1.0 - t * t) / (t + s * (1.0 - t * t));
  // Beyond the reach of the fit the terms in x stay as they are there; the one in a/R goes on.
  const double y = std::fmin(x, kDeepestIndentation_ratio);
  // CT-8  g = 1 - 0.1210 x + 0.0651 x^2 - 0.0259 x^3 + w (0.2559 a/R + 0.2525 x)
  const double g = 1.0 + y * (-0.1210 + y * (0.0651 - y * 0.0259)) + w * (0.2559 * t + 0.2525 * y);
  double dg_dx = w * 0.2559 * dt_dx;
  if (x < kDeepestIndentation_ratio) dg_dx += -0.1210 + x * (0.1302 - x * 0.0777) + w * 0.2525;
  return {g, dg_dx};
}

}  // namespace

double ElasticTip::contact_modulus_Pa() const RT_SAFE {
  return youngs_modulus_Pa / (1.0 - poisson_ratio * poisson_ratio);
}

double ElasticTip::pulled_stiffness_N_per_m() const RT_SAFE {
  const double shear_Pa = youngs_modulus_Pa / (2.0 * (1.0 + poisson_ratio));
  // ln(3 - 4 nu) / (1 - 2 nu) tends to 2
  const double gap = 1.0 - 2.0 * poisson_ratio;
  return 4.0 * shear_Pa * radius_m * (gap > 1e-12 ? std::log1p(2.0 * gap) / gap : 2.0);
}

double ElasticTip::sideways_stiffness_N_per_m() const RT_SAFE {
  const double shear_Pa = youngs_modulus_Pa / (2.0 * (1.0 + poisson_ratio));
  return 8.0 * shear_Pa * radius_m / (2.0 - poisson_ratio);
}

double ElasticTip::stiffest_press_N_per_m() const {
  if (!large_strain) return 2.0 * contact_modulus_Pa() * radius_m;
  constexpr double kMaxStretch_ratio = 5.0;  // s: a is R within 1e-4
  // CT-9 need not grow with s: sampled, as set-up has the time.
  constexpr int kSteps = 500;
  double most_N_per_m = 0.0;
  for (int i = 1; i <= kSteps; ++i)
    most_N_per_m =
        std::fmax(most_N_per_m, tip_state(*this, kMaxStretch_ratio * i / kSteps).stiffness_N_per_m);
  return most_N_per_m;
}

TipState tip_state(const ElasticTip& tip, double s) RT_SAFE {
  const double t = std::tanh(s), r_m = tip.radius_m;
  // F / (E* R^2) = (1 + t^2) s - t = 4/3 s^3 - 4/5 s^5 + 136/315 s^7 - ...
  const double q = s * s;
  const double f = s < kSmall ? s * q * (4.0 / 3.0 - q * (4.0 / 5.0 - q * 136.0 / 315.0))
                              : (1.0 + t * t) * s - t;
  const double stiff_N_per_m = 2.0 * tip.contact_modulus_Pa() * r_m;  // at a = R
  TipState out{.depth_m = r_m * s * t,
               .force_N = 0.5 * stiff_N_per_m * r_m * f,
               .stiffness_N_per_m = stiff_N_per_m * t,
               .contact_radius_m = r_m * t};
  if (tip.large_strain && s > 0.0) {  // CT-8 and CT-9
    const StrainFactor g = factor_at(tip.poisson_ratio, s);
    out.stiffness_N_per_m = g.factor * out.stiffness_N_per_m + g.slope * out.force_N / r_m;
    out.force_N *= g.factor;
  }
  return out;
}

StrainFactor large_strain_factor(double poisson_ratio, double x) {
  // x = s tanh s by Newton's method, from above: there the slope is between x/s and 1.2.
  constexpr int kSteps = 50;
  double s = x + std::sqrt(x);
  for (int i = 0; i < kSteps; ++i) {
    const double t = std::tanh(s);
    s -= (s * t - x) / (t + s * (1.0 - t * t));
  }
  return factor_at(poisson_ratio, s);
}

double pressed_shape_m(const ElasticTip& tip, const TipState& state, double rho_m) RT_SAFE {
  const double r_m = tip.radius_m, a_m = state.contact_radius_m;
  if (rho_m <= a_m)
    return state.depth_m - r_m + std::sqrt(std::fmax(r_m * r_m - rho_m * rho_m, 0.0));
  // t = rho sin(phi) takes the root out of CT-4
  const double half = 0.5 * std::asin(a_m / rho_m);
  double sum_m = 0.0;
  for (std::size_t i = 0; i < kNode.size(); ++i)
    for (const double side : {-1.0, 1.0}) {
      const double t =
          // A deep tip's a rounds to R, where atanh is infinite.
          std::fmin(rho_m * std::sin(half * (1.0 + side * kNode[i])) / r_m, 1.0 - 1e-12);
      sum_m += kWeight[i] * (state.depth_m - r_m * t * std::atanh(t));
    }
  return 2.0 / std::numbers::pi * half * sum_m;
}

double pulled_shape(const ElasticTip& tip, double rho_m) RT_SAFE {
  if (rho_m <= tip.radius_m) return 1.0;
  return 2.0 / std::numbers::pi * std::asin(tip.radius_m / rho_m);
}

}  // namespace tact::model::indent
