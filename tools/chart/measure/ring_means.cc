// SPDX-License-Identifier: Apache-2.0
#include "tools/chart/measure/ring_means.h"

#include <algorithm>

namespace tact::tools::chart {

using model::Vec3;

RingMeans::RingMeans(int rings, double pitch_m, double middle_value)
    : pitch_m_(pitch_m),
      middle_value_(middle_value),
      length_m_(static_cast<std::size_t>(rings), 0.0),
      sum_(static_cast<std::size_t>(rings), 0.0) {}

void RingMeans::add_triangle(const std::array<Vec3, 3>& p, const std::array<double, 3>& rho,
                             const std::array<double, 3>& value) {
  const auto [low, high] = std::minmax_element(rho.begin(), rho.end());
  const auto first = std::max<std::size_t>(1, static_cast<std::size_t>(*low / pitch_m_));
  for (std::size_t k = first; k < sum_.size(); ++k) {
    const double r = static_cast<double>(k) * pitch_m_;
    if (r > *high) return;
    std::array<Vec3, 2> cut{};
    double at_cuts = 0.0;
    std::size_t cuts = 0;
    for (std::size_t i = 0; i < 3 && cuts < 2; ++i) {
      const std::size_t j = (i + 1) % 3;
      if ((rho[i] < r) == (rho[j] < r)) continue;
      const double t = (r - rho[i]) / (rho[j] - rho[i]);
      cut[cuts++] = p[i] + t * (p[j] - p[i]);
      at_cuts += value[i] + t * (value[j] - value[i]);
    }
    if (cuts < 2) continue;
    const double part_m = norm(cut[1] - cut[0]);
    length_m_[k] += part_m;
    sum_[k] += part_m * 0.5 * at_cuts;
  }
}

std::vector<double> RingMeans::means() const {
  std::vector<double> out(sum_.size(), middle_value_);
  for (std::size_t k = 1; k < sum_.size(); ++k)
    out[k] = length_m_[k] > 0.0 ? sum_[k] / length_m_[k] : out[k - 1];
  return out;
}

}  // namespace tact::tools::chart
