// SPDX-License-Identifier: Apache-2.0
#include "model/springs/integrators.h"

#include <cmath>
#include <complex>

namespace tact::model::springs {
namespace {

bool is_usable(const Oscillator& o, const OscillatorState& s, const Method& method,
               double step_s) RT_SAFE {
  return o.mass_kg > 0.0 && step_s > 0.0 && std::isfinite(o.mass_kg) && std::isfinite(step_s) &&
         std::isfinite(o.damping_Ns_per_m) && std::isfinite(o.stiffness_N_per_m) &&
         std::isfinite(o.force_N) && std::isfinite(s.position_m) && std::isfinite(s.velocity_mps) &&
         std::isfinite(method.alpha);
}

// MA-8  x+ = x + h (v_1 + 2 v_2 + 2 v_3 + v_4)/6,   v+ = v + h (a_1 + 2 a_2 + 2 a_3 + a_4)/6
//       v_i = v + p h a_(i-1),   a_i = a(x + p h v_(i-1), v_i),   p = 0, 1/2, 1/2, 1
OscillatorState step_rk4(const Oscillator& o, double x, double v, double h) RT_SAFE {
  const auto acceleration = [&o](double at, double speed) RT_SAFE {
    return (o.force_N - o.stiffness_N_per_m * at - o.damping_Ns_per_m * speed) / o.mass_kg;
  };
  const double v1 = v, a1 = acceleration(x, v);
  const double v2 = v + 0.5 * h * a1, a2 = acceleration(x + 0.5 * h * v1, v2);
  const double v3 = v + 0.5 * h * a2, a3 = acceleration(x + 0.5 * h * v2, v3);
  const double v4 = v + h * a3, a4 = acceleration(x + h * v3, v4);
  return {x + h / 6.0 * (v1 + 2.0 * v2 + 2.0 * v3 + v4),
          v + h / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4)};
}

}  // namespace

OscillatorState step(const Oscillator& o, const OscillatorState& from, const Method& method,
                     double step_s) RT_SAFE {
  if (!is_usable(o, from, method, step_s)) return {.status = law::LawStatus::kInvalid};
  const double h = step_s, x = from.position_m, v = from.velocity_mps;
  const auto acceleration = [&o](double at, double speed) RT_SAFE {
    return (o.force_N - o.stiffness_N_per_m * at - o.damping_Ns_per_m * speed) / o.mass_kg;
  };
  const double a = acceleration(x, v);
  switch (method.integrator) {
    case Integrator::kExplicitEuler:
      return {x + h * v, v + h * a};  // MA-2
    case Integrator::kImprovedEuler: {
      const double next = v + h * a;  // MA-3
      return {x + h * next, next};
    }
    case Integrator::kMidpointAveraging: {
      const double alpha = method.alpha;
      // MA-5 at the place of MA-4, then MA-6
      const double next = v + h * acceleration(x + alpha * h * v, v + alpha * h * a);
      return {x + 0.5 * h * (v + next), next};
    }
    case Integrator::kRk2: {
      const double middle = v + 0.5 * h * a;  // MA-8b
      return {x + h * middle, v + h * acceleration(x + 0.5 * h * v, middle)};
    }
    case Integrator::kRk4:
      return step_rk4(o, x, v, h);  // MA-8
    case Integrator::kImplicitEuler: {
      const double m = o.mass_kg, k = o.stiffness_N_per_m, c = o.damping_Ns_per_m;
      // MA-9  v+ = (v + h (f - k x)/m)/(1 + h c/m + h^2 k/m),  x+ = x + h v+
      const double next = (v + h / m * (o.force_N - k * x)) / (1.0 + h * c / m + h * h * k / m);
      return {x + h * next, next};
    }
  }
  return {.status = law::LawStatus::kInvalid};
}

OscillatorState exact(const Oscillator& o, const OscillatorState& from, double time_s) {
  const double m = o.mass_kg, k = o.stiffness_N_per_m, c = o.damping_Ns_per_m, t = time_s;
  // Without a spring there is no rest position to swing about: two limits of their own.
  if (k == 0.0 && c == 0.0) {
    const double a = o.force_N / m;
    return {from.position_m + from.velocity_mps * t + 0.5 * a * t * t, from.velocity_mps + a * t};
  }
  if (k == 0.0) {  // v falls towards f / c
    const double final_mps = o.force_N / c, rate = c / m;
    const double excess_mps = from.velocity_mps - final_mps;
    return {from.position_m + final_mps * t - excess_mps / rate * std::expm1(-rate * t),
            final_mps + excess_mps * std::exp(-rate * t)};
  }
  // y = x - f / k,  y'' + 2 b y' + k / m y = 0:  y = e^(-b t) (y0 C + (v0 + b y0) S),
  // C = cosh(r t), S = sinh(r t) / r, r^2 = b^2 - k / m (r imaginary below critical damping)
  const double b = 0.5 * c / m, y0 = from.position_m - o.force_N / k, v0 = from.velocity_mps;
  const std::complex<double> r = std::sqrt(std::complex<double>(b * b - k / m));
  const std::complex<double> up = std::exp((r - b) * t), down = std::exp((-r - b) * t);
  const double cosine = 0.5 * (up + down).real();
  // Near critical damping both exponentials are alike, and their difference over r is 0/0.
  const double sine =
      std::abs(r) * t > 1e-8 ? (0.5 * (up - down) / r).real() : t * std::exp(-b * t);
  return {o.force_N / k + y0 * cosine + (v0 + b * y0) * sine,
          v0 * cosine - (b * v0 + k / m * y0) * sine};
}

}  // namespace tact::model::springs
