// SPDX-License-Identifier: Apache-2.0
#include "model/law/creep.h"

#include <algorithm>
#include <cmath>

namespace tact::model::law {
namespace {

constexpr double kSlowest_per_tick = 1e-9;  // used for 0, where all of the force fades

// CP-2: g_0 - sum g_i x / (p_i - x), p and x per tick.
double modulus_at(const Relaxation& r, double x) {
  double sum = r.share(0);
  for (std::size_t i = 0; i < r.terms(); ++i) sum -= r.share(i + 1) * x / (r.rate_per_tick(i) - x);
  return sum;
}

// It falls from above 0 to below it between two neighbouring rates.
double zero_between(const Relaxation& r, double low, double high) {
  constexpr int kHalvings = 60;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = 0.5 * (low + high);
    (modulus_at(r, middle) > 0.0 ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace

Creep::Creep(const Relaxation& relaxation) : count_(relaxation.terms()) {
  std::array<double, kMaxPronyTerms> rate{};
  for (std::size_t i = 0; i < count_; ++i) rate[i] = relaxation.rate_per_tick(i);
  std::sort(rate.begin(), rate.begin() + static_cast<std::ptrdiff_t>(count_));
  for (std::size_t j = 0; j < count_; ++j) {
    const double x =
        std::max(zero_between(relaxation, j == 0 ? 0.0 : rate[j - 1], rate[j]), kSlowest_per_tick);
    double sum = 0.0;  // of CP-3
    for (std::size_t i = 0; i < count_; ++i) {
      const double away = relaxation.rate_per_tick(i) - x;
      sum += relaxation.share(i + 1) * relaxation.rate_per_tick(i) / (away * away);
    }
    share_[j] = 1.0 / (x * sum);
    tick_share_[j] = -std::expm1(-x);
  }
}

}  // namespace tact::model::law
