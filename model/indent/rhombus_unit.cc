// SPDX-License-Identifier: Apache-2.0
#include "model/indent/rhombus_unit.h"

#include <cmath>
#include <numbers>

namespace tact::model::indent {
namespace {

constexpr int kMaxUnitSteps = 100;  // bisection alone needs 60 to reach the last bit

struct InitialSides {
  double s0, c0;  // sin and cos of theta0
};

InitialSides initial_sides(const RhombusUnit& unit) RT_SAFE {
  return {std::sin(unit.initial_angle_rad), std::cos(unit.initial_angle_rad)};
}

struct Sides {
  double s, c;  // sin and cos of theta'
};

// RC-1  s = sin(theta0) - x / 2a,  c = sqrt((1 - s)(1 + s))
Sides sides_at(const RhombusUnit& unit, double s0, double x) RT_SAFE {
  const double s = s0 - x / (2.0 * unit.rod_length_m);
  return {s, std::sqrt((1.0 - s) * (1.0 + s))};
}

struct ForceAndSlope {
  double f, k;
};

/// All that Newton asks of a unit, without the angles: no asin.
ForceAndSlope force_and_slope(const RhombusUnit& unit, InitialSides initial, double x) RT_SAFE {
  const auto [s0, c0] = initial;
  const auto [s, c] = sides_at(unit, s0, x);
  const double kN = unit.normal_stiffness_N_per_m, kT = unit.tangential_stiffness_N_per_m;
  // RC-2  y = x (sin(theta0) + s) / (cos(theta0) + c)
  const double y = x * (s0 + s) / (c0 + c);
  // RC-4  f = kN x + kT y tan(theta')      RC-5  k = kN + kT (cos(theta0) / c^3 - 1)
  return {kN * x + kT * y * s / c, kN + kT * (c0 / (c * c * c) - 1.0)};
}

}  // namespace

bool RhombusUnit::is_valid() const RT_SAFE {
  return std::isfinite(rod_length_m) && rod_length_m > 0.0 && initial_angle_rad > 0.0 &&
         initial_angle_rad < std::numbers::pi / 2.0 && std::isfinite(normal_stiffness_N_per_m) &&
         normal_stiffness_N_per_m > 0.0 && std::isfinite(tangential_stiffness_N_per_m) &&
         tangential_stiffness_N_per_m >= 0.0;
}

UnitPressLimit press_limit(const RhombusUnit& unit) RT_SAFE {
  const double kN = unit.normal_stiffness_N_per_m, kT = unit.tangential_stiffness_N_per_m;
  const double s0 = std::sin(unit.initial_angle_rad), c0 = std::cos(unit.initial_angle_rad);
  const double flat_m = 2.0 * unit.rod_length_m * s0;
  // RC-7: the sideways spring is so stiff that k reaches 0 before the rods are flat.
  if (kT > kN && kT * c0 / (kT - kN) < 1.0) {
    // cos(theta_c) = (kT cos(theta0) / (kT - kN))^(1/3),  x_lim = 2a (sin(theta0) - sin(theta_c))
    const double c = std::cbrt(kT * c0 / (kT - kN));
    const double snap_m = 2.0 * unit.rod_length_m * (s0 - std::sqrt((1.0 - c) * (1.0 + c)));
    return {snap_m, force_and_slope(unit, {s0, c0}, snap_m).f, UnitLimit::kSnap};
  }
  return {flat_m, kN * flat_m, UnitLimit::kFlat};
}

double straight_m(const RhombusUnit& unit) RT_SAFE {
  return -2.0 * unit.rod_length_m * (1.0 - std::sin(unit.initial_angle_rad));
}

UnitResponse respond(const RhombusUnit& unit, double shortening_m) RT_SAFE {
  if (!unit.is_valid() || !std::isfinite(shortening_m)) return {.status = law::LawStatus::kInvalid};
  if (shortening_m <= straight_m(unit)) return {.status = law::LawStatus::kSingular};
  const auto [s0, c0] = initial_sides(unit);
  const double flat_m = 2.0 * unit.rod_length_m * s0;
  const bool beyond_flat = shortening_m > flat_m;
  const double x = beyond_flat ? flat_m : shortening_m;
  const auto [s, c] = sides_at(unit, s0, x);
  const double kN = unit.normal_stiffness_N_per_m, kT = unit.tangential_stiffness_N_per_m;
  const auto [f, k] = force_and_slope(unit, {s0, c0}, x);
  const double y = x * (s0 + s) / (c0 + c);
  // RC-2  sin(theta0 - theta') = (x / 2a)(sin(theta0) + s) / (sin(theta0) c + cos(theta0) s)
  const double sine = x / (2.0 * unit.rod_length_m) * (s0 + s) / (s0 * c + c0 * s);
  // Rounding may take the sine above 1 where the rods are flat.
  const double change_rad = -std::asin(sine < 1.0 ? sine : 1.0);
  UnitResponse out;
  out.angle_rad = beyond_flat ? 0.0 : std::asin(s);
  out.angle_change_rad = change_rad;
  out.lambda = std::abs(change_rad) / unit.initial_angle_rad;
  out.widening_m = y;
  out.force_N = f;
  out.stiffness_N_per_m = k;
  // RC-3  U = kN x^2 / 2 + kT y^2 / 2
  out.energy_J = 0.5 * kN * x * x + 0.5 * kT * y * y;
  out.status = beyond_flat ? law::LawStatus::kSaturated : law::LawStatus::kOk;
  return out;
}

double shortening_at(const RhombusUnit& unit, const UnitPressLimit& limit, double force_N) RT_SAFE {
  if (force_N == 0.0) return 0.0;
  if (force_N >= limit.force_N) return limit.shortening_m;
  // The branch through x = 0: beyond a snap the same force has other roots, which no press reaches.
  double low = force_N > 0.0 ? 0.0 : straight_m(unit);
  double high = force_N > 0.0 ? limit.shortening_m : 0.0;
  const InitialSides initial = initial_sides(unit);
  double x = force_N / force_and_slope(unit, initial, 0.0).k, before = x;
  if (!(x > low && x < high)) x = 0.5 * (low + high);
  for (int i = 0; i < kMaxUnitSteps; ++i) {
    const auto [f, k] = force_and_slope(unit, initial, x);
    (f < force_N ? low : high) = x;
    double next = x - (f - force_N) / k;
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    if (next == x || next == before) return next;  // rounding lets it swing between two neighbours
    before = x;
    x = next;
  }
  return x;
}

}  // namespace tact::model::indent
