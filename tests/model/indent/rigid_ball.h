// SPDX-License-Identifier: Apache-2.0
// rigid_ball.h - a law of the liver's tip against a rigid ball on a half-space: E 5 kPa, nu 0.45,
// R 4 mm, from 0.3 to 12 mm.
//
// By the contact radius, which no law here uses (C. Segedin, Mathematika 4 (1957) 156).
#pragma once

#include <gtest/gtest.h>

#include <cmath>

#include "model/law/law.h"

namespace tact::tests {

inline void check_follows_ball(const model::law::Law& law, double tolerance_ratio) {
  const double plane_Pa = 5000.0 / (1.0 - 0.45 * 0.45), R = 0.004;
  int checked = 0;
  for (double a = 0.01 * R; a < 0.999999 * R; a += 1e-4 * (R - a)) {
    const double log = std::log((R + a) / (R - a)), depth_m = 0.5 * a * log;
    if (depth_m < 0.0003 || depth_m > 0.012) continue;
    ++checked;
    const double force_N = plane_Pa * (0.5 * (a * a + R * R) * log - a * R);
    EXPECT_NEAR(law.respond(depth_m).force_N / force_N, 1.0, tolerance_ratio) << depth_m;
  }
  EXPECT_GT(checked, 1000);
}

}  // namespace tact::tests
