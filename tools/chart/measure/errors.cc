// SPDX-License-Identifier: Apache-2.0
#include "tools/chart/measure/errors.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <tuple>

#include "tools/report/just_noticeable.h"

namespace tact::tools::chart {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kSameDepth_m = 1e-6;

double shape_error(const Sample& s) {
  Rms rms;
  for (std::size_t j = 0; j < std::min(s.ring_m.size(), s.reference_ring_m.size()); ++j) {
    const double e = s.ring_m[j] - s.reference_ring_m[j];
    if (std::isfinite(e)) rms.add(e / s.depth_m);
  }
  return rms.value();
}

}  // namespace

double Rms::value() const {
  return count_ > 0 ? std::sqrt(sum_ / static_cast<double>(count_)) : kNan;
}

ErrorSummary summarize(std::span<const Sample> samples) {
  ErrorSummary out{.cases = samples.size()};
  out.own_worst_ratio.fill(kNan);
  double peak_N = 0.0;
  std::map<std::size_t, double> site_peak_N;
  for (const Sample& s : samples) {
    peak_N = std::max(peak_N, std::abs(s.reference_N));
    site_peak_N[s.site] = std::max(site_peak_N[s.site], std::abs(s.reference_N));
  }
  Rms all, press, pull, held_out, shape;
  std::map<std::size_t, Rms> of_site;
  std::size_t rendered_right = 0;
  for (const Sample& s : samples) {
    const double e_N = s.force_N - s.reference_N;
    const double e = e_N / peak_N;
    all.add(e);
    (s.depth_m > 0.0 ? press : pull).add(e);
    // Of the force there: light touch counts as much as a deep press.
    const double own = e_N / std::abs(s.reference_N);
    if (s.depth_m > 0.0) out.own_largest_ratio = std::max(out.own_largest_ratio, std::abs(own));
    for (std::size_t k = 0; k < kOwnDepths_m.size(); ++k) {
      if (std::abs(s.depth_m - kOwnDepths_m[k]) > kSameDepth_m) continue;
      if (!(std::abs(out.own_worst_ratio[k]) >= std::abs(own)))
        out.own_worst_ratio[k] = own;  // NaN before
    }
    if (s.held_out) held_out.add(e);
    of_site[s.site].add(e_N / site_peak_N[s.site]);
    out.force_worst_ratio = std::max(out.force_worst_ratio, std::abs(e));
    if (std::abs(e_N) <= report::kJustNoticeable_ratio * std::abs(s.reference_N)) ++rendered_right;
    const double u = shape_error(s);
    if (!std::isfinite(u)) continue;
    shape.add(u);
    out.shape_worst_ratio = std::max(out.shape_worst_ratio, u);
  }
  for (const auto& [site, rms] : of_site)
    out.worst_site_rms_ratio = std::max(out.worst_site_rms_ratio, rms.value());
  out.force_rms_ratio = all.value();
  out.press_rms_ratio = press.value();
  out.pull_rms_ratio = pull.value();
  out.held_out_rms_ratio = held_out.value();
  out.shape_rms_ratio = shape.value();
  out.within_jnd_ratio =
      samples.empty() ? kNan
                      : static_cast<double>(rendered_right) / static_cast<double>(samples.size());
  return out;
}

std::vector<std::size_t> front_of(std::span<const SpeedAndError> points) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (std::isfinite(points[i].tick_us) && std::isfinite(points[i].error_ratio))
      order.push_back(i);
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return std::tuple(points[a].tick_us, points[a].error_ratio, a) <
           std::tuple(points[b].tick_us, points[b].error_ratio, b);
  });
  std::vector<std::size_t> front;
  for (const std::size_t i : order)
    // Sorted by time: what is slower has to be nearer to be worth it.
    if (front.empty() || points[i].error_ratio < points[front.back()].error_ratio)
      front.push_back(i);
  return front;
}

}  // namespace tact::tools::chart
