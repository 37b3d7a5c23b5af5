// SPDX-License-Identifier: Apache-2.0
#include "model/indent/disc.h"

#include <cmath>
#include <numbers>
#include <string>

#include "model/ranges.h"

namespace tact::model::indent {
namespace {

// DS-3 without E
double stiffness_per_modulus_m(const DiscDimensions& p) RT_SAFE {
  const double alpha = disc_shape_factor(p.outer_diameter_m / p.inner_diameter_m);
  const double l = p.thickness_m, outer = p.outer_diameter_m;
  return 4.0 / (1.0 - p.poisson_ratio * p.poisson_ratio) * l * l * l / (alpha * outer * outer);
}

}  // namespace

double disc_shape_factor(double diameter_ratio) RT_SAFE {
  const double c = diameter_ratio;
  // (C+1)/(C-1) - 2/ln C; near C = 1 both terms grow without limit, so their series in w = ln C
  double difference = (c + 1.0) / (c - 1.0) - 2.0 / std::log(c);
  if (c - 1.0 < 1e-3) {
    const double w = std::log1p(c - 1.0), w2 = w * w;
    difference = w * (1.0 / 6.0 - w2 * (1.0 / 360.0 - w2 / 15120.0));
  }
  // DS-2  alpha = (1/pi) ((C - 1)/C)^2 / ((C + 1)/(C - 1) - 2/ln C)
  return (c - 1.0) / c * ((c - 1.0) / c) / difference / std::numbers::pi;
}

bool is_monotone(const Disc& disc, DiscForm form) RT_SAFE {
  return form == DiscForm::kLinear || disc.cone_ratio <= std::numbers::sqrt2;
}

DiscResponse respond(const Disc& disc, DiscForm form, double flattening_m) RT_SAFE {
  const double k = disc.stiffness_N_per_m, h0 = disc.travel_m, s = flattening_m, x = s / h0;
  const double eta2 = form == DiscForm::kAlmenLaszlo ? disc.cone_ratio * disc.cone_ratio : 0.0;
  return {// DS-5  f = k s (1 + eta^2 (1-x)(1-x/2))
          .force_N = k * s * (1.0 + eta2 * (1.0 - x) * (1.0 - 0.5 * x)),
          // f' = k (1 + eta^2 (1 - 3x + 1.5 x^2))
          .stiffness_N_per_m = k * (1.0 + eta2 * (1.0 - x * (3.0 - 1.5 * x))),
          // U = k h0^2 (x^2/2 + eta^2 (x^2/2 - x^3/2 + x^4/8))
          .energy_J = k * s * s * (0.5 + eta2 * (0.5 - x * (0.5 - 0.125 * x)))};
}

double flattening_at_m(const Disc& disc, DiscForm form, double force_N) RT_SAFE {
  const double g = force_N / disc.flat_force_N();  // 0 .. 1
  const double half_eta2 = 0.5 * disc.cone_ratio * disc.cone_ratio;
  // Without a cone DS-5 is the linear form, and what follows divides by eta^2.
  if (form == DiscForm::kLinear || half_eta2 < 1e-12) return disc.travel_m * g;
  // With z = x - 1, DS-5 reads  z^3 + p z + q = 0,  p = (1 - eta^2/2)/(eta^2/2) >= 0,
  // q = (1 - g)/(eta^2/2) >= 0: one real root.
  const double p = (1.0 - half_eta2) / half_eta2, q = (1.0 - g) / half_eta2;
  double x = 1.0;
  // eta = sqrt(2) has p = 0: the general root would be 0
  // times infinity; the cube root is what it tends to.
  if (p > 1e-9) {
    const double root = std::sqrt(p / 3.0);
    x -= 2.0 * root * std::sinh(std::asinh(1.5 * q / (p * root)) / 3.0);
  } else {
    x -= std::cbrt(q);
  }
  if (x < 0.5) {  // 1 + z loses the digits of a small x; one Newton step brings them back
    const double f = x * (1.0 + 2.0 * half_eta2 * (1.0 - x) * (1.0 - 0.5 * x));
    x -= (f - g) / (1.0 + 2.0 * half_eta2 * (1.0 - x * (3.0 - 1.5 * x)));
  }
  return disc.travel_m * x;
}

void visit(ParameterVisitor& v, DiscDimensions& p) {
  v.number("outer_diameter_m", {1e-6, 0.1}, "D of a disc", p.outer_diameter_m);
  v.number("inner_diameter_m", {1e-6, 0.1}, "d of a disc", p.inner_diameter_m);
  v.number("thickness_m", {1e-7, 0.1}, "l of a disc", p.thickness_m);
  v.number("free_height_m", {1e-7, 0.1}, "H0 of a disc, above its thickness", p.free_height_m);
  v.number("youngs_modulus_Pa", {1.0, 1e13}, "E of a disc", p.youngs_modulus_Pa);
  v.number("poisson_ratio", {0.0, 0.495, kHard}, "mu of a disc", p.poisson_ratio);
}

Result<Disc> make_disc(const DiscDimensions& p) {
  if (auto wrong = check_meaning("disc", p)) return *wrong;
  if (p.outer_diameter_m <= p.inner_diameter_m || p.free_height_m <= p.thickness_m)
    return Error{
        "disc: outer_diameter_m must be above inner_diameter_m, and free_height_m above "
        "thickness_m, or there is no cone to flatten"};
  const double travel_m = p.free_height_m - p.thickness_m;  // DS-4
  Disc disc{.outer_diameter_m = p.outer_diameter_m,
            .stiffness_N_per_m = p.youngs_modulus_Pa * stiffness_per_modulus_m(p),  // DS-3
            .travel_m = travel_m,
            .cone_ratio = travel_m / p.thickness_m};
  // The form is not known here: whether the disc may snap is asked by who stacks it.
  if (const char* wrong = disc_error(disc, DiscForm::kLinear))
    return Error{std::string("disc: these dimensions have no usable spring: ") + wrong};
  return disc;
}

const char* disc_error(const Disc& disc, DiscForm form) {
  if (!is_positive(disc.outer_diameter_m)) return "outer_diameter_m must be finite and above 0";
  if (!is_positive(disc.stiffness_N_per_m)) return "stiffness_N_per_m must be finite and above 0";
  if (!is_positive(disc.travel_m)) return "travel_m must be finite and above 0";
  if (!(std::isfinite(disc.cone_ratio) && disc.cone_ratio >= 0.0))
    return "cone_ratio must be finite and not below 0";
  if (!is_monotone(disc, form))
    return "cone_ratio (free height less thickness, over thickness) is above 1.414: the disc snaps "
           "through and its force falls with depth; take a thicker disc or the linear form";
  return nullptr;
}

}  // namespace tact::model::indent
