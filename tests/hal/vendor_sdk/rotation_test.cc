// SPDX-License-Identifier: Apache-2.0
#include "hal/vendor_sdk/rotation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace tact::hal::vendor_sdk::rotation_test {

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

TEST(Rotation, AQuaternionAndItsNegativeHaveOneRotationVector) {
  const auto about = [](double angle_rad) {
    const double half_rad = 0.5 * angle_rad;
    return model::Quat{std::cos(half_rad), 0.0, 0.6 * std::sin(half_rad), 0.8 * std::sin(half_rad)};
  };
  for (const double angle_rad : {0.0, 1e-14, 1e-9, 0.3, -0.3, 3.0}) {
    const model::Quat q = about(angle_rad);
    for (const double sign : {1.0, -1.0}) {
      const model::Vec3 v = rotation_vector_rad({sign * q.w, sign * q.x, sign * q.y, sign * q.z});
      EXPECT_NEAR(v.x, 0.0, 1e-15);
      EXPECT_NEAR(v.y, 0.6 * angle_rad, 1e-14) << angle_rad;
      EXPECT_NEAR(v.z, 0.8 * angle_rad, 1e-14) << angle_rad;
    }
  }
}

TEST(Rotation, HalfATurnHasThatLengthAndMoreGoesTheOtherWay) {
  constexpr double kPi = std::numbers::pi;
  EXPECT_NEAR(norm(rotation_vector_rad({0.0, 0.0, 0.6, 0.8})), kPi, 1e-15);
  const model::Vec3 v = rotation_vector_rad({std::cos(2.0), std::sin(2.0), 0.0, 0.0});
  EXPECT_NEAR(v.x, 4.0 - 2.0 * kPi, 1e-15);
}

TEST(Rotation, InvalidRotationMatrixGivesNan) {
  const double nan = std::nan("");
  const double none[][3][3] = {{{0, 0, 0}, {0, 0, 0}, {0, 0, 0}},        // never written
                               {{1.1, 0, 0}, {0, 1.1, 0}, {0, 0, 1.1}},  // longer
                               {{1, 0, 0}, {0, 1, 0}, {0, 0, -1}},       // a mirror
                               {{-1, 0, 0}, {0, -1, 0}, {0, 0, -1}},     // the other one
                               {{1, 0.1, 0}, {0, 1, 0}, {0, 0, 1}},      // skewed
                               {{1, 0, 0}, {0, nan, 0}, {0, 0, 1}}};
  for (const auto& r : none) EXPECT_TRUE(std::isnan(quat_from_rotation(r).w));
}

}  // namespace tact::hal::vendor_sdk::rotation_test
