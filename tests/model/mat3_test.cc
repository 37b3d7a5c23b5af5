// SPDX-License-Identifier: Apache-2.0
#include "model/mat3.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace tact::model::mat3_test {

constexpr Mat3 kA{{Vec3{2.0, 1.0, 0.0}, Vec3{-1.0, 3.0, 0.5}, Vec3{0.25, 0.0, 4.0}}};

TEST(Mat3, InverseTimesItselfIsOne) {
  const Mat3 one = kA * inverse(kA);
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_NEAR(norm(one.row[i] - diagonal(1.0).row[i]), 0.0, 1e-15);
}

TEST(Mat3, MultipliesRowByColumn) {
  // first row of A A: (2 2 + 1 -1 + 0, 2 1 + 1 3, 0 + 0.5 + 0)
  EXPECT_EQ((kA * kA).row[0], (Vec3{3.0, 5.0, 0.5}));
  EXPECT_EQ(transpose(transpose(kA)), kA);
}

TEST(Mat3, ASingularOrNanMatrixHasTheInverseZero) {
  const Mat3 flat{{Vec3{1.0, 2.0, 3.0}, Vec3{2.0, 4.0, 6.0}, Vec3{0.0, 1.0, 0.0}}};
  EXPECT_EQ(inverse(flat), Mat3{});
  EXPECT_EQ(inverse(Mat3{}), Mat3{});
  Mat3 broken = kA;
  broken.row[1].y = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(inverse(broken), Mat3{});
}

TEST(Mat3, SingularValuesOfARotatedStretchAreTheStretches) {
  const double c = std::cos(0.7), s = std::sin(0.7);
  const Mat3 turn{{Vec3{c, -s, 0.0}, Vec3{s, c, 0.0}, Vec3{0.0, 0.0, 1.0}}};
  const Mat3 tilt{{Vec3{1.0, 0.0, 0.0}, Vec3{0.0, s, -c}, Vec3{0.0, c, s}}};
  const Mat3 stretch{{Vec3{0.1, 0.0, 0.0}, Vec3{0.0, 7.0, 0.0}, Vec3{0.0, 0.0, 2.0}}};
  const auto sigma = singular_values(turn * tilt * stretch * transpose(turn));
  EXPECT_NEAR(sigma[0], 7.0, 1e-13);
  EXPECT_NEAR(sigma[1], 2.0, 1e-13);
  EXPECT_NEAR(sigma[2], 0.1, 1e-13);
}

TEST(Mat3, SingularValuesMultiplyToTheDeterminant) {
  const auto sigma = singular_values(kA);
  EXPECT_NEAR(sigma[0] * sigma[1] * sigma[2], std::abs(determinant(kA)), 1e-12);
}

}  // namespace tact::model::mat3_test
