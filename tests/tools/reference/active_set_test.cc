// SPDX-License-Identifier: Apache-2.0
// The contact of rigid spheres with a half-space, from the compliance of uniformly pressed squares
// (A. E. H. Love, Phil. Trans. R. Soc. A 228 (1929) 377), held against answers that are known.
#include "tools/reference/press/active_set.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <numbers>
#include <random>

#include "tools/reference/press/half_space.h"

namespace tact::tools::reference::active_set_test {

struct Ball {
  double x_m, y_m, depth_m, force_N;
};

struct Square {
  double x_m, y_m, overlap_m;
  std::size_t ball;
};

/// Of a square of side h under unit pressure: sinking at (x, y) from its middle, times E*.
double sinking(double x, double y, double h) {
  const double a = x + 0.5 * h, b = x - 0.5 * h, c = y + 0.5 * h, d = y - 0.5 * h;
  const auto part = [](double p, double q, double r) {
    return p * std::log((q + std::hypot(p, q)) / (r + std::hypot(p, r)));
  };
  return (part(a, c, d) + part(c, a, b) + part(b, d, c) + part(d, b, a)) / std::numbers::pi;
}

/// Forces of balls that are pressed together.
std::vector<double> forces_N(const Elasticity& material, double radius_m,
                             const std::vector<Ball>& balls, int squares_a_radius) {
  const double h = radius_m / squares_a_radius;
  std::vector<Square> squares;
  for (std::size_t i = 0; i < balls.size(); ++i)
    for (int p = -squares_a_radius; p < squares_a_radius; ++p)
      for (int q = -squares_a_radius; q < squares_a_radius; ++q) {
        const double x = (p + 0.5) * h, y = (q + 0.5) * h, rho = std::hypot(x, y);
        if (rho > 0.999 * radius_m) continue;
        const double overlap_m =
            balls[i].depth_m - radius_m + std::sqrt(radius_m * radius_m - rho * rho);
        if (overlap_m > 0.0) squares.push_back({balls[i].x_m + x, balls[i].y_m + y, overlap_m, i});
      }
  const auto n = static_cast<Eigen::Index>(squares.size());
  Eigen::MatrixXd compliance(n, n);
  Eigen::VectorXd overlap(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Square& s = squares[static_cast<std::size_t>(i)];
    overlap[i] = s.overlap_m;
    for (Eigen::Index j = 0; j <= i; ++j) {
      const Square& t = squares[static_cast<std::size_t>(j)];
      compliance(i, j) = compliance(j, i) =
          sinking(s.x_m - t.x_m, s.y_m - t.y_m, h) / material.contact_modulus_Pa();
    }
  }
  const auto pressure = solve_contact(compliance, overlap);
  EXPECT_TRUE(pressure) << (pressure ? "" : pressure.error().message);
  std::vector<double> out(balls.size(), 0.0);
  for (Eigen::Index i = 0; pressure && i < n; ++i)
    out[squares[static_cast<std::size_t>(i)].ball] += (*pressure)[i] * h * h;
  return out;
}

TEST(ActiveSet, PressesASphereAsSneddonDoes) {
  const Elasticity material{.youngs_modulus_Pa = 5000.0, .poisson_ratio = 0.45};
  for (const double depth_m : {1e-3, 2e-3, 5e-3, 10e-3}) {
    const double known_N = sphere_force_N(material, 4e-3, depth_m);
    EXPECT_NEAR(forces_N(material, 4e-3, {{0, 0, depth_m, 0}}, 12)[0], known_N, 0.015 * known_N);
  }
}

/// Boundary elements by others, on a grid of R / 40: two, four and three spheres; alone they would
/// be up to 718 % off. The grid here is R / 9: 2 %.
void expect_forces(const Elasticity& material, double radius_m, const std::vector<Ball>& balls) {
  const auto found_N = forces_N(material, radius_m, balls, 9);
  for (std::size_t i = 0; i < balls.size(); ++i)
    EXPECT_NEAR(found_N[i], balls[i].force_N, 0.02 * balls[i].force_N + 2e-5) << "sphere " << i;
}

TEST(ActiveSet, CouplesSpheresAsBoundaryElementsDo) {
  expect_forces(
      {.youngs_modulus_Pa = 2000.0, .poisson_ratio = 0.49}, 4.65e-3,
      {{0.000913, -0.009837, 0.002285, 0.009634}, {0.002458, 0.005752, 0.00801, 0.140654}});
  expect_forces({.youngs_modulus_Pa = 2000.0, .poisson_ratio = 0.49}, 5.81e-3,
                {{-0.008858, -0.007882, 0.002466, 0.003836},
                 {0.011778, 0.011146, 0.008593, 0.15328},
                 {-0.003833, 0.002961, 0.005277, 0.052047},
                 {0.011992, -0.011301, 0.007469, 0.119775}});
  expect_forces({.youngs_modulus_Pa = 8000.0, .poisson_ratio = 0.45}, 4.71e-3,
                {{-0.010051, -0.007808, 0.005855, 0.268485},
                 {-0.005479, 0.006901, 0.005855, 0.270215},
                 {0.004796, -0.004879, 0.005855, 0.269266}});
}

TEST(ActiveSet, NeitherPullsNorLetsAnythingInForAnyDefiniteCompliance) {
  std::mt19937 random(1);
  std::normal_distribution<double> number;
  for (int round = 0; round < 100; ++round) {
    const Eigen::Index n = 40;
    Eigen::MatrixXd root(n, n);
    Eigen::VectorXd overlap(n);
    for (Eigen::Index i = 0; i < n; ++i) {
      overlap[i] = number(random);
      for (Eigen::Index j = 0; j < n; ++j) root(i, j) = number(random);
    }
    const Eigen::MatrixXd compliance =
        root * root.transpose() + 0.01 * Eigen::MatrixXd::Identity(n, n);
    const auto pressure = solve_contact(compliance, overlap);
    ASSERT_TRUE(pressure) << pressure.error().message;
    const Eigen::VectorXd gap = compliance * *pressure - overlap;
    EXPECT_GE(pressure->minCoeff(), -1e-8);
    EXPECT_GE(gap.minCoeff(), -1e-8);
    EXPECT_NEAR(pressure->dot(gap), 0.0, 1e-7);
  }
}

TEST(ActiveSet, SaysWhenTheComplianceIsNone) {
  const Eigen::MatrixXd none = -Eigen::MatrixXd::Identity(3, 3);
  const auto pressure = solve_contact(none, Eigen::VectorXd::Ones(3));
  ASSERT_FALSE(pressure);
  EXPECT_NE(pressure.error().message.find("not positive definite"), std::string::npos);
}

}  // namespace tact::tools::reference::active_set_test
