// SPDX-License-Identifier: Apache-2.0
#include "tools/reference/press/half_space.h"

#include <cmath>

namespace tact::tools::reference {
namespace {

/// Where a rising function is zero between 0 and 1: halve the interval to the last bit.
template <typename Function>
double root(const Function& f) {
  double low = 0.0, high = 1.0;
  for (int i = 0; i < 60; ++i) {
    const double t = 0.5 * (low + high);
    (t < 1.0 && f(t) < 0.0 ? low : high) = t;
  }
  return low;
}

}  // namespace

double flat_punch_force_N(const Elasticity& material, double radius_m, double depth_m) {
  // F = 2 E* a d
  return 2.0 * material.contact_modulus_Pa() * radius_m * depth_m;
}

double sphere_contact_radius_m(double sphere_radius_m, double depth_m) {
  // t = a / R: d / R = t artanh(t)
  const double wanted = depth_m / sphere_radius_m;
  return sphere_radius_m * root([wanted](double t) { return t * std::atanh(t) - wanted; });
}

double sphere_force_N(const Elasticity& material, double sphere_radius_m, double depth_m) {
  const double R = sphere_radius_m,
               a = sphere_contact_radius_m(
                   R,
                   depth_m);  // NOLINT(readability-identifier-naming): the symbol of the equation
  // F = E* ((R^2 + a^2) / 2 ln((R + a) / (R - a)) - a R)
  return material.contact_modulus_Pa() *
         ((R * R + a * a) / 2.0 * std::log((R + a) / (R - a)) - a * R);
}

}  // namespace tact::tools::reference
