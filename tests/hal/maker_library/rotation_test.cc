// SPDX-License-Identifier: Apache-2.0
#include "hal/maker_library/rotation.h"

#include <gtest/gtest.h>

#include <cmath>

namespace tact::hal::maker_library::rotation_test {

TEST(Rotation, ARotationBecomesTheQuaternionThatTurnsTheSame) {
  const double third_turn[3][3] = {{0, 0, 1}, {1, 0, 0}, {0, 1, 0}};  // about (1, 1, 1)
  const model::Quat q = quat_from_rotation(third_turn);
  for (const double part : {q.w, q.x, q.y, q.z}) EXPECT_NEAR(part, 0.5, 1e-15);
  const double half_turns[3][3][3] = {{{1, 0, 0}, {0, -1, 0}, {0, 0, -1}},
                                      {{-1, 0, 0}, {0, 1, 0}, {0, 0, -1}},
                                      {{-1, 0, 0}, {0, -1, 0}, {0, 0, 1}}};
  for (int i = 0; i < 3; ++i) {
    const model::Quat half = quat_from_rotation(half_turns[i]);
    EXPECT_NEAR(half.w, 0.0, 1e-15);
    EXPECT_NEAR(i == 0 ? half.x : i == 1 ? half.y : half.z, 1.0, 1e-15);
  }
}

TEST(Rotation, WhatIsNoRotationIsNoOrientation) {
  const double nan = std::nan("");
  const double none[][3][3] = {{{0, 0, 0}, {0, 0, 0}, {0, 0, 0}},        // never written
                               {{1.1, 0, 0}, {0, 1.1, 0}, {0, 0, 1.1}},  // longer
                               {{1, 0, 0}, {0, 1, 0}, {0, 0, -1}},       // a mirror
                               {{-1, 0, 0}, {0, -1, 0}, {0, 0, -1}},     // the other one
                               {{1, 0.1, 0}, {0, 1, 0}, {0, 0, 1}},      // skewed
                               {{1, 0, 0}, {0, nan, 0}, {0, 0, 1}}};
  for (const auto& r : none) EXPECT_TRUE(std::isnan(quat_from_rotation(r).w));
}

}  // namespace tact::hal::maker_library::rotation_test
