// SPDX-License-Identifier: Apache-2.0
// jaw_force.h - force of the tissue that pushes the jaws apart; positive opens the fingers.
//
//     f = c (N1 + N2) / 2     c: closing ratio, 0 to 1; N: force on the sphere of a jaw
//                             along the outward normal of the tissue, N, not below 0
//
// Only for a tool with two spheres, one per jaw; otherwise zero. Zero with open jaws, where force
// acts on the outside of the jaws.
#pragma once

#include <cmath>
#include <span>

#include "model/contact/contact.h"

namespace tact::firmware::loop {

inline double jaw_force_N(std::span<const model::contact::SphereContact> jaws,
                          double grip_ratio) RT_SAFE {
  if (jaws.size() != 2 || !(grip_ratio > 0.0)) return 0.0;
  double sum_N = 0.0;
  for (const model::contact::SphereContact& jaw : jaws) {  // bound: 2 (jaws)
    const double normal_N = dot(jaw.force_N, jaw.normal);
    if (std::isnan(normal_N)) return normal_N;  // latches in the gate
    sum_N += std::fmax(normal_N, 0.0);
  }
  // f = c (N1 + N2) / 2
  return std::fmin(grip_ratio, 1.0) * 0.5 * sum_N;
}

}  // namespace tact::firmware::loop
