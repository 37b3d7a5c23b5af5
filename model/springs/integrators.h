// SPDX-License-Identifier: Apache-2.0
// integrators.h - six ways to step masses on springs, and a step of one: m x'' + c x' + k x = f.
//
//     explicit Euler        MA-2   x+ = x + h v                  v+ = v + h a(x, v)
//     improved Euler        MA-3   v+ = v + h a(x, v)            x+ = x + h v+
//     midpoint-averaging    MA-4   x* = x + alpha h v            v* = v + alpha h a(x, v)
//                           MA-5   v+ = v + h a(x*, v*)
//                           MA-6   x+ = x + h (v + v+) / 2
//     RK2                   MA-8b  as MA-4, 5 with alpha = 1/2,  x+ = x + h v*
//     RK4                   MA-8   classical
//     implicit Euler        MA-9   v+ = (v + h (f - k x) / m) / (1 + h c / m + h^2 k / m),
//                                  x+ = x + h v+
//
//     x  position, m    v  velocity, m/s    a  acceleration, m/s^2    h  step, s
//     alpha  in (0, 1]
//
// Improved Euler is the semi-implicit (symplectic) one, not Heun's. The source of
// midpoint-averaging tries alpha = 1/2, 3/8 and 5/8; only 1/2 is fit for use: 3/8 makes energy
// (integrator_stability.h). Source: MA-2 to MA-9.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "model/law/law.h"
#include "model/rt.h"

namespace tact::model::springs {

enum class Integrator : std::uint8_t {
  kExplicitEuler,
  kImprovedEuler,
  kMidpointAveraging,
  kRk2,
  kRk4,
  kImplicitEuler,
};

struct IntegratorName {
  Integrator integrator;
  std::string_view name, meaning;
  int force_evaluations = 0;  // a step; implicit Euler adds its iterations
};

inline constexpr std::array kIntegratorNames{
    IntegratorName{Integrator::kExplicitEuler, "explicit-euler",
                   "grows without damping; for comparison", 1},
    IntegratorName{Integrator::kImprovedEuler, "improved-euler",
                   "semi-implicit: one evaluation, stable to 2 / omega undamped", 1},
    IntegratorName{Integrator::kMidpointAveraging, "midpoint-averaging",
                   "two evaluations, second order at alpha 1/2", 2},
    IntegratorName{Integrator::kRk2, "rk2", "two evaluations, grows without damping", 2},
    IntegratorName{Integrator::kRk4, "rk4", "four evaluations, fourth order", 4},
    IntegratorName{Integrator::kImplicitEuler, "implicit-euler",
                   "stable at every step, damps; a fixed number of iterations", 1},
};

/// Its name in a scene.
constexpr std::string_view name_of(Integrator integrator) {
  return kIntegratorNames[static_cast<std::size_t>(integrator)].name;
}

/// An integrator with its one parameter.
struct Method {
  Integrator integrator = Integrator::kMidpointAveraging;
  double alpha = 0.5;  // midpoint-averaging alone reads it
};

struct Oscillator {
  double mass_kg = 0.0;            // m, > 0
  double damping_Ns_per_m = 0.0;   // c
  double stiffness_N_per_m = 0.0;  // k
  double force_N = 0.0;            // f
};

struct OscillatorState {
  double position_m = 0.0;
  double velocity_mps = 0.0;
  law::LawStatus status = law::LawStatus::kOk;  // kInvalid: nothing was stepped
};

/// One step. A mass or step not above 0, or anything not finite: kInvalid, all zero.
OscillatorState step(const Oscillator& oscillator, const OscillatorState& from,
                     const Method& method, double step_s) RT_SAFE;

/// Where the oscillator really is after time_s (m, k >= 0; any damping).
OscillatorState exact(const Oscillator& oscillator, const OscillatorState& from, double time_s);

}  // namespace tact::model::springs
