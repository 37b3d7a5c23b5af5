// SPDX-License-Identifier: Apache-2.0
#include "model/springs/integrator_stability.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>

namespace tact::model::springs {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

Amplification product(const Amplification& a, const Amplification& b) {
  return {a[0] * b[0] + a[1] * b[2], a[0] * b[1] + a[1] * b[3],  //
          a[2] * b[0] + a[3] * b[2], a[2] * b[1] + a[3] * b[3]};
}

/// I + B (I + B / 2 (I + B / 3 ...)): the exponential of B, cut after `order` terms.
Amplification taylor(const Amplification& b, int order) {
  Amplification sum{1.0, 0.0, 0.0, 1.0};
  for (int n = order; n > 0; --n) {
    const Amplification next = product(b, sum);
    for (std::size_t i = 0; i < 4; ++i) sum[i] = next[i] / n;
    sum[0] += 1.0, sum[3] += 1.0;
  }
  return sum;
}

/// Smallest z > 0 with a + b z + c z^2 = 0; infinity if there is none.
double smallest_positive_root(double a, double b, double c) {
  if (c == 0.0) return -a / b > 0.0 ? -a / b : kInfinity;
  const double discriminant = b * b - 4.0 * a * c;
  if (discriminant < 0.0) return kInfinity;
  // Both roots from the sum that does not cancel.
  const double q = -0.5 * (b + std::copysign(std::sqrt(discriminant), b));
  double best = kInfinity;
  for (const double root : {q / c, a / q})
    if (root > 0.0) best = std::min(best, root);
  return best;
}

// The three conditions of MA-16 with the matrix MA-12, each divided by its power of z:
//     -2 zeta + (1/2 - alpha (1 - 4 zeta^2)) z - alpha zeta z^2 < 0
//     1 - 2 alpha zeta z > 0
//     2 - 2 zeta z - alpha (1 - 4 zeta^2) z^2 > 0
double midpoint_limit(double alpha, double zeta) {
  const double curl = alpha * (1.0 - 4.0 * zeta * zeta);
  const double by_sum = smallest_positive_root(2.0, -2.0 * zeta, -curl);
  // Undamped, the determinant is 1 + (1/2 - alpha) z^2:
  // below one half it grows at every step (X18).
  if (zeta == 0.0) return alpha < 0.5 ? 0.0 : by_sum;
  return std::min({by_sum, smallest_positive_root(-2.0 * zeta, 0.5 - curl, -alpha * zeta),
                   1.0 / (2.0 * alpha * zeta)});
}

/// R(w) = 1 + w + w^2 / 2 ... : growth a step of the mode exp(w t / h).
double growth(std::complex<double> w, int order) {
  std::complex<double> sum = 1.0;
  for (int n = order; n > 0; --n) sum = 1.0 + w * sum / static_cast<double>(n);
  return std::abs(sum);
}

/// First z at which a mode of RK2 or RK4 grows, by steps and halving; damped. The two modes apart
/// are well conditioned where the matrix has a double eigenvalue.
double searched_limit(int order, double zeta) {
  const std::complex<double> turn = std::sqrt(std::complex<double>(zeta * zeta - 1.0));
  const auto stable = [&](double z) {
    return growth(z * (turn - zeta), order) < 1.0 && growth(z * (-turn - zeta), order) < 1.0;
  };
  // A 64th of the time of the faster mode.
  const double step = 1.0 / (64.0 * (zeta + std::abs(turn)));
  double low = 0.0, high = step;
  while (stable(high)) low = high, high += step;  // a polynomial grows at last
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (stable(middle) ? low : high) = middle;
  }
  return low;
}

}  // namespace

Amplification amplification(const Method& method, double z, double zeta) {
  const double zz = z * z, d = 2.0 * zeta * z;
  const Amplification b{0.0, 1.0, -zz, -d};
  switch (method.integrator) {
    case Integrator::kExplicitEuler:
      return taylor(b, 1);  // MA-10
    case Integrator::kImprovedEuler:
      return {1.0 - zz, 1.0 - d, -zz, 1.0 - d};  // MA-11
    case Integrator::kMidpointAveraging: {
      const double alpha = method.alpha;  // MA-12
      const double p = -zz + 2.0 * alpha * zeta * zz * z;
      const double q = -d + alpha * (4.0 * zeta * zeta - 1.0) * zz;
      return {1.0 + 0.5 * p, 1.0 + 0.5 * q, p, 1.0 + q};
    }
    case Integrator::kRk2:
      return taylor(b, 2);  // MA-13
    case Integrator::kRk4:
      return taylor(b, 4);  // MA-14
    case Integrator::kImplicitEuler: {
      const double scale = 1.0 / (1.0 + d + zz);  // MA-15  (I - B)^-1
      return {scale * (1.0 + d), scale, -scale * zz, scale};
    }
  }
  return {};
}

double spectral_radius(const Amplification& m) {
  const double half = 0.5 * trace(m), det = determinant(m);
  const double square = half * half - det;
  // A conjugate pair: the modulus of both is the root of the determinant.
  if (square < 0.0) return std::sqrt(det);
  return std::abs(half) + std::sqrt(square);
}

bool is_stable(const Amplification& m) {
  const double det = determinant(m), tr = trace(m);
  return det < 1.0 && 1.0 - tr + det > 0.0 && 1.0 + tr + det > 0.0;
}

double largest_stable_z(const Method& method, double zeta) {
  if (!(zeta >= 0.0) || std::isinf(zeta)) return 0.0;
  switch (method.integrator) {
    case Integrator::kExplicitEuler:
      // MA-17, written without the difference that cancels.
      return zeta <= 1.0 ? 2.0 * zeta : 2.0 / (zeta + std::sqrt(zeta * zeta - 1.0));
    case Integrator::kImprovedEuler:
      return 2.0 / (std::sqrt(1.0 + zeta * zeta) + zeta);
    case Integrator::kMidpointAveraging:
      return method.alpha > 0.0 ? midpoint_limit(method.alpha, zeta) : 0.0;
    case Integrator::kRk2:
      return zeta == 0.0 ? 0.0 : searched_limit(2, zeta);
    case Integrator::kRk4:
      return zeta == 0.0 ? std::sqrt(8.0) : searched_limit(4, zeta);
    case Integrator::kImplicitEuler:
      return kInfinity;
  }
  return 0.0;
}

}  // namespace tact::model::springs
