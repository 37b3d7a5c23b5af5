// SPDX-License-Identifier: Apache-2.0
// RestContact: tangential springs of the tissue, and slip.
#include <algorithm>
#include <cmath>
#include <limits>

#include "model/contact/rest_contact.h"

namespace tact::model::contact {
namespace {

constexpr double kSettled_ratio = 1e-4;  // excess over the cap at which steps and sweeps end

// Limits f by Coulomb's law at the stiffness K, so that f' is parallel to the slip p f':
//
//     MC-9   f' = f - K p f',   |f'| = mu F,   p > 0
//
// Newton on 1 / |f'|, which is nearly linear in p: p grows by
//
//     (|f'| / (mu F) - 1) |f'|^2 / (f' . (I + p K)^-1 K f')
//
// 1 / |f'| is concave, so p rises to the solution from below and |f'| does not fall below mu F:
// setting the length then shortens f'. With f' . K^-1 f' <= f . K^-1 f the slip loses energy after
// any number of steps.
Vec2 slipping_N(const Vec2& f_N, const Tensor2& stiffness_N_per_m, double cap_N) RT_SAFE {
  constexpr int kNewtonSteps = 3;
  // Also of the excess, as an error in each tick's direction of slip adds up while it slides.
  constexpr double kOfExcess_ratio = 1e-3;
  if (!(cap_N > 0.0)) return {};
  const Tensor2& k = stiffness_N_per_m;
  Tensor2 m{.xx = 1.0, .yy = 1.0};  // I + p K
  Vec2 left_N = f_N;
  double g_m_per_N = 0.0, length_N = norm(f_N);
  const double settled_N =
      cap_N + std::min(kOfExcess_ratio * (length_N - cap_N), kSettled_ratio * cap_N);
  for (int step = 0; step < kNewtonSteps && length_N > settled_N; ++step) {  // bound: kNewtonSteps
    g_m_per_N += (length_N / cap_N - 1.0) * length_N * length_N / dot(left_N, solve(m, k * left_N));
    m = {1.0 + g_m_per_N * k.xx, g_m_per_N * k.xy, 1.0 + g_m_per_N * k.yy};
    left_N = solve(m, f_N);
    length_N = norm(left_N);
  }
  // The length is set exactly; only the direction keeps the error of the last step.
  return (cap_N / length_N) * left_N;
}

}  // namespace

// At the contact radius sqrt(R d) of the indentation: CT-1 for a << R. A held patch is as wide as
// the sphere.
Tensor2 RestContact::compliance_m_per_N(std::size_t i) const RT_SAFE {
  // Least contact radius over that of the sphere, chosen: G of MC-5 is unbounded at radius 0.
  constexpr double kMinRadius_ratio = 0.1;
  const double radius_m = scene_.spheres[i].radius_m;
  if (sphere_[i].is_held) return sphere_[i].tangent_compliance.at(radius_m);
  return sphere_[i].tangent_compliance.at(
      std::clamp(std::sqrt(radius_m * std::max(pressing_[i].in.indentation_m, 0.0)),
                 kMinRadius_ratio * radius_m, radius_m));
}

TangentCompliance RestContact::ask_tangent_compliance(std::size_t i, bool held) const RT_SAFE {
  const double fixed_N_per_m = scene_.parameters.sliding_stiffness_N_per_m;
  if (!(fixed_N_per_m > 0.0))
    return scene_.law->tangent_compliance(sphere_[i].surface_point, held, sphere_[i].axes);
  return {.rest_m_per_N = {.xx = 1.0 / fixed_N_per_m, .yy = 1.0 / fixed_N_per_m}};
}

// Only for a sphere without force: no spring stores energy then.
void RestContact::start_tangent_spring(std::size_t i) RT_SAFE {
  sphere_[i].compliance_triangle = sphere_[i].surface_point.triangle;
  // The least compliance of this spring, held and as wide as the sphere, bounds its couplings: the
  // matrix stays positive definite while the spring stiffens.
  sphere_[i].tangent_compliance = ask_tangent_compliance(i, false);
  const double least_m_per_N =
      ask_tangent_compliance(i, true).at(scene_.spheres[i].radius_m).least_eigenvalue();
  shear_.set_own(i, {at_least(compliance_m_per_N(i), least_m_per_N), least_m_per_N});
}

// Removes the tangential force of sphere i: its contact point moves with the tissue of the others.
void RestContact::drop_shift(std::size_t i) RT_SAFE {
  Shear without = shear_;
  without.leave(i);
  without.solve();
  Shear::Shifts f_N{};
  // bound: spheres
  for (std::size_t j = 0; j < count(); ++j) f_N[j] = without.force_N(shift_m_, j);
  shift_m_[i] = shear_.unloaded_m(f_N, i);
  start_tangent_spring(i);
  shear_.solve();
}

// MC-7   t_i <- t_i + (G_i' - G_i) f_i,   G_i' < G_i
// Springs stiffen in steps of 1 %, and on a new triangle. Each keeps its force and so needs less
// displacement; if it would need more, the spring is not changed.
void RestContact::stiffen() RT_SAFE {
  constexpr double kStep_ratio = 0.99;
  Shear::Shifts change_m{};
  bool is_stiffer = false;
  for (std::size_t i = 0; i < count(); ++i) {  // bound: spheres
    if (!is_coupled_[i]) continue;
    const OwnCompliance before = shear_.own(i);
    double most_m_per_N = kStep_ratio * before.m_per_N.trace();
    if (sphere_[i].compliance_triangle != sphere_[i].surface_point.triangle) {
      sphere_[i].compliance_triangle = sphere_[i].surface_point.triangle;
      sphere_[i].tangent_compliance = ask_tangent_compliance(i, sphere_[i].is_held);
      most_m_per_N = std::numeric_limits<double>::infinity();
    }
    const Tensor2 now_m_per_N = compliance_m_per_N(i);
    if (!(now_m_per_N.trace() < most_m_per_N)) continue;
    const OwnCompliance own{at_least(now_m_per_N, before.least_m_per_N), before.least_m_per_N};
    // MC-7: W falls by f . (G - G') f / 2; else the spring is not changed.
    const Vec2 force_N = shear_.force_N(shift_m_, i);
    const Vec2 more_m = own.m_per_N * force_N - before.m_per_N * force_N;
    if (own == before || !(dot(force_N, more_m) <= 0.0)) continue;
    change_m[i] = more_m;
    shear_.set_own(i, own);
    is_stiffer = true;
  }
  if (!is_stiffer) return;
  shear_.solve();
  // bound: spheres
  for (std::size_t i = 0; i < count(); ++i) shift_m_[i] = shift_m_[i] + change_m[i];
}

// Limits |f| to mu F by slip of t; held tissue has no cap. Slip of one sphere changes the forces of
// the others: kMaxSweeps sweeps at most, until no sphere was above its cap by more than
// kSettled_ratio. A remaining excess is removed from the force only, and slips in the next tick.
// Each slip loses energy: W falls by (f + f') . K^-1 (f - f') / 2, however the others move.
void RestContact::resist_sliding() RT_SAFE {
  constexpr int kMaxSweeps = 5;
  constexpr double kRounding_N = 1e-12;  // without friction the cap is 0
  bool is_settled = false;
  for (int sweep = 0; sweep < kMaxSweeps && !is_settled; ++sweep) {  // bound: kMaxSweeps
    is_settled = true;
    for (std::size_t i = 0; i < count(); ++i) {  // bound: spheres
      if (!is_coupled_[i]) continue;
      const Vec2 spring_N = shear_.force_N(shift_m_, i);
      shear_N_[i] = spring_N;
      const double cap_N = scene_.parameters.friction_ratio * pressing_[i].response.law.force_N;
      const double length_N = norm(spring_N);
      if (sphere_[i].is_held || !(length_N > cap_N)) continue;
      if (length_N > (1.0 + kSettled_ratio) * cap_N + kRounding_N) is_settled = false;
      const Tensor2 own_N_per_m = shear_.own_N_per_m(i);
      shear_N_[i] = slipping_N(spring_N, own_N_per_m, cap_N);
      shift_m_[i] = shift_m_[i] - solve(own_N_per_m, spring_N - shear_N_[i]);
    }
  }
  for (std::size_t i = 0; i < count() && !is_settled; ++i) {  // bound: spheres
    if (!is_coupled_[i]) continue;
    const double cap_N = scene_.parameters.friction_ratio * pressing_[i].response.law.force_N;
    shear_N_[i] = shear_.force_N(shift_m_, i);
    const double length_N = norm(shear_N_[i]);
    if (!sphere_[i].is_held && length_N > cap_N)
      shear_N_[i] = (std::max(cap_N, 0.0) / length_N) * shear_N_[i];
  }
}

}  // namespace tact::model::contact
