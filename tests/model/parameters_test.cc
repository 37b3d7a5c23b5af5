// SPDX-License-Identifier: Apache-2.0
#include "model/parameters.h"

#include <gtest/gtest.h>

#include <limits>

namespace tact::model::parameters_test {

struct Spring {
  double stiffness_N_per_m = 30.0, exponent = 1.5, offset_m = -0.1;
  std::size_t rings = 3;
};

void visit(ParameterVisitor& v, Spring& p) {
  v.number("stiffness_N_per_m", {0.01, 1e5}, "k", p.stiffness_N_per_m);
  v.number("exponent", {1.0, 4.0, kHard}, "n", p.exponent);
  v.number("offset_m", {-1.0, 1.0}, "d0", p.offset_m);
  v.count("rings", {1, 31}, "m", p.rings);
}

std::string problem(const Spring& p) {
  const auto found = check_meaning("spring", p);
  return found ? found->message : "";
}

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();

TEST(Parameters, ANumberMayLeaveItsRangeButNotItsSign) {
  EXPECT_EQ(problem({}), "");
  for (const double k : {1e-6, 1e9}) EXPECT_EQ(problem({.stiffness_N_per_m = k}), "") << k;
  for (const double k : {0.0, -1.0, kNaN, kInf}) EXPECT_NE(problem({.stiffness_N_per_m = k}), "");
  for (const double d0 : {-5.0, 0.0, 5.0}) EXPECT_EQ(problem({.offset_m = d0}), "") << d0;
  EXPECT_NE(problem({.offset_m = kNaN}), "");
}

TEST(Parameters, NothingLeavesAHardRange) {
  for (const double n : {1.0, 4.0}) EXPECT_EQ(problem({.exponent = n}), "") << n;
  for (const double n : {0.99, 4.01, kNaN, kInf}) EXPECT_NE(problem({.exponent = n}), "") << n;
  for (const std::size_t m : {1U, 31U}) EXPECT_EQ(problem({.rings = m}), "") << m;
  for (const std::size_t m : {0U, 32U}) EXPECT_NE(problem({.rings = m}), "") << m;
}

TEST(Parameters, TheErrorNamesLawParameterAndRange) {
  EXPECT_EQ(problem({.stiffness_N_per_m = 0.0, .rings = 0}),
            "spring: stiffness_N_per_m = 0; allowed: 0.01 .. 100000");
  EXPECT_EQ(problem({.rings = 32}), "spring: rings = 32; allowed: 1 .. 31");
}

}  // namespace tact::model::parameters_test
