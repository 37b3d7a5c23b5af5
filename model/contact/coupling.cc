// SPDX-License-Identifier: Apache-2.0
#include "model/contact/coupling.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "model/contact/small_lu.h"

namespace tact::model::contact {
namespace {

constexpr int kMaxSteps = 16;
constexpr double kTolerance_m = 1e-10;  // 1e-7 N on a tissue of 1 kN/m
// Below this pivot the matrix is nearly singular, and a Newton step would be too long.
constexpr double kMinPivot = 1e-6;
constexpr double kMaxCoupling_ratio = 0.95;  // of the largest coupling that is positive definite

using Vector = std::array<double, kMaxSpheres>;

/// True if another sphere is coupled to this one.
bool is_coupled(const Coupling& c, std::size_t i) RT_SAFE {
  // bound: kMaxSpheres
  return std::ranges::any_of(c[i], [](double m_per_N) RT_SAFE { return m_per_N != 0.0; });
}

// Calls the law. A sphere that is not held gets no force at an indentation <= 0.
void respond(ContactLaw& law, PressingSphere& sphere) RT_SAFE {
  const double indentation_m = sphere.in.indentation_m;
  const bool is_off = !sphere.in.held && !(indentation_m > 0.0);
  if (is_off) sphere.in.indentation_m = 0.0;
  // Called with 0, not omitted: a law with state must know that the sphere is present.
  sphere.response = law.respond(sphere.in);
  sphere.in.indentation_m = indentation_m;
  // Its force stays 0 while e changes, but a law's slope at 0 is not 0.
  if (is_off) sphere.response.law.stiffness_N_per_m = 0.0;
}

/// A negative slope could make the matrix indefinite; 0 instead only slows convergence.
double stiffness_N_per_m(const PressingSphere& sphere) RT_SAFE {
  return sphere.presses ? std::max(sphere.response.law.stiffness_N_per_m, 0.0) : 0.0;
}

// (I + C K) step = miss. Every pivot is positive if diag(1 / K) + C is positive definite; else the
// step is `miss`.
Vector newton_step(const Coupling& c, std::span<const PressingSphere> spheres,
                   Vector miss) RT_SAFE {
  const std::size_t n = spheres.size();
  SmallLu<kMaxSpheres> lu;
  for (std::size_t i = 0; i < n; ++i)    // bound: spheres
    for (std::size_t j = 0; j < n; ++j)  // bound: spheres
      lu.at(i, j) = (i == j ? 1.0 : 0.0) + c[i][j] * stiffness_N_per_m(spheres[j]);
  if (lu.factorise(n, Pivot::kOfDiagonal, kMinPivot)) lu.solve(miss);
  return miss;
}

// Residual of MC-1; 0 for a sphere that does not press.
Vector miss_of(const Coupling& c, std::span<const PressingSphere> spheres) RT_SAFE {
  Vector miss{};
  for (std::size_t i = 0; i < spheres.size(); ++i)  // bound: spheres
    if (spheres[i].presses)
      miss[i] = spheres[i].depth_m - coupled_m(c, spheres, i) - spheres[i].in.indentation_m;
  return miss;
}

// Newton's method from the present indentations; false: the residual exceeds the tolerance or is
// NaN.
bool is_solved(ContactLaw& law, const Coupling& c, std::span<PressingSphere> spheres) RT_SAFE {
  for (std::size_t i = 0; i < spheres.size(); ++i) {  // bound: spheres
    PressingSphere& sphere = spheres[i];
    if (!sphere.presses) {
      sphere.response = {};
      continue;
    }
    // Without coupling e is exactly d: no iteration and no rounding error.
    if (!is_coupled(c, i)) sphere.in.indentation_m = sphere.depth_m;
    respond(law, sphere);
  }
  for (int step = 0; step <= kMaxSteps; ++step) {  // bound: kMaxSteps + 1 (and the last look)
    const Vector miss_m = miss_of(c, spheres);
    // bound: kMaxSpheres
    if (std::ranges::all_of(miss_m, [](double m) RT_SAFE { return std::abs(m) <= kTolerance_m; }))
      return true;
    if (step == kMaxSteps) break;
    const Vector change_m = newton_step(c, spheres, miss_m);
    for (std::size_t i = 0; i < spheres.size(); ++i) {  // bound: spheres
      if (!spheres[i].presses || change_m[i] == 0.0) continue;
      spheres[i].in.indentation_m += change_m[i];
      respond(law, spheres[i]);
    }
  }
  return false;
}

}  // namespace

double coupling_m_per_N(const ContactCoupling& c, const Vec3& n_i, const Vec3& n_j) RT_SAFE {
  const double o = dot(n_i, n_j);
  return o * c.near_field_m_per_N + 0.5 * o * (3.0 - o * o) * c.structural_m_per_N;
}

double coupled_m(const Coupling& c, std::span<const PressingSphere> spheres,
                 std::size_t i) RT_SAFE {
  double sum_m = 0.0;
  for (std::size_t j = 0; j < spheres.size(); ++j)  // bound: spheres
    if (spheres[j].presses) sum_m += c[i][j] * spheres[j].response.law.force_N;
  return sum_m;
}

double press_together(ContactLaw& law, Coupling& c, std::span<PressingSphere> spheres) RT_SAFE {
  // All of C, a half, a quarter, none. Without coupling there is always a solution.
  constexpr int kTries = 4;
  for (int i = 0; i < kTries && !is_solved(law, c, spheres); ++i) {  // bound: kTries (shares of C)
    for (auto& row : c)                                              // bound: kMaxSpheres
      for (double& m_per_N : row) m_per_N *= i + 2 < kTries ? 0.5 : 0.0;  // bound: kMaxSpheres
    // bound: spheres
    for (PressingSphere& sphere : spheres) sphere.in.indentation_m = sphere.depth_m;
  }
  // MC-3  W = sum U_i(e_i) + F' C F / 2
  double energy_J = 0.0;
  for (std::size_t i = 0; i < spheres.size(); ++i)  // bound: spheres
    if (spheres[i].presses)
      energy_J += spheres[i].response.law.energy_J +
                  0.5 * spheres[i].response.law.force_N * coupled_m(c, spheres, i);
  return energy_J;
}

double definite_share(const Coupling& c,
                      const std::array<double, kMaxSpheres>& stiffest_N_per_m) RT_SAFE {
  std::size_t n = kMaxSpheres;  // rows after the last stiffness are those of I
  while (n > 0 && stiffest_N_per_m[n - 1] == 0.0) --n;  // bound: kMaxSpheres
  // MC-6. Scaled by the stiffnesses, as these may be 0: margin I + factor sqrt(K) C sqrt(K)
  const auto is_definite = [&](double factor) RT_SAFE {
    SmallLu<kMaxSpheres> lu;
    for (std::size_t i = 0; i < n; ++i) {  // bound: spheres
      lu.at(i, i) = kMaxCoupling_ratio;
      for (std::size_t j = 0; j < i; ++j) {  // bound: spheres - 1; pairs in all
        const double stiffness_N_per_m = std::sqrt(stiffest_N_per_m[i] * stiffest_N_per_m[j]);
        lu.at(i, j) = lu.at(j, i) = factor * c[i][j] * stiffness_N_per_m;
      }
    }
    return lu.factorise(n, Pivot::kOfDiagonal, 0.0);
  };
  if (is_definite(1.0)) return 1.0;
  constexpr int kHalvings = 10;
  // q to 2^-10
  double low = 0.0, high = 1.0;
  for (int i = 0; i < kHalvings; ++i) {  // bound: kHalvings (of the share)
    const double middle = 0.5 * (low + high);
    (is_definite(middle) ? low : high) = middle;
  }
  return low;
}

}  // namespace tact::model::contact
