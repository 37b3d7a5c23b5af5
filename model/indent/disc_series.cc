// SPDX-License-Identifier: Apache-2.0
#include "model/indent/disc_series.h"

#include <algorithm>
#include <cmath>

namespace tact::model::indent {

law::LawResponse DiscSeries::respond(double depth_m) const RT_SAFE {
  return law::press_response(depth_m, end_m(), [this](double inside_m) RT_SAFE {
    std::size_t i = 0;
    while (i + 1 < size_ && disc_[i + 1].begin_m <= inside_m) ++i;
    const Disc& at = disc_[i];
    const double s_m = inside_m - at.begin_m, stiffness_N_per_m = at.series_N_per_m;
    return law::LawResponse{
        .force_N = at.begin_N + stiffness_N_per_m * s_m,
        .stiffness_N_per_m = stiffness_N_per_m,
        .energy_J = at.begin_J + (at.begin_N + 0.5 * stiffness_N_per_m * s_m) * s_m};
  });
}

std::size_t DiscSeries::profile(double depth_m, std::span<double> ring_m) const RT_SAFE {
  double left_m = depth_m > 0.0 ? depth_m : 0.0;
  const double force_N = respond(left_m).force_N;
  const std::size_t count = std::min(size_ + 1, ring_m.size());
  for (std::size_t j = 0; j < count; ++j) {
    ring_m[j] = j < size_ ? std::fmax(left_m, 0.0) : 0.0;
    if (j < size_)
      left_m -= std::min(force_N, disc_[j].flat_N) / disc_[j].stiffness_N_per_m;  // DS-16
  }
  return count;
}

void visit(ParameterVisitor& v, DiscSeriesParameters& p) {
  v.number("force_N", {1e-4, 100.0}, "of a slow press at working_depth_m", p.force_N);
  v.number("working_depth_m", kDepth_m, "press up to here", p.working_depth_m);
  v.number("exponent", {1.01, 4.0, kHard}, "e: how the force grows at working_depth_m", p.exponent);
  v.number("exponent_slope", {-1.0, 1.0}, "s: at the depth d the exponent is e + s ln(d / d_w)",
           p.exponent_slope, Need::kOptional);
  v.number("first_depth_m", kDepth_m, "at which the first disc is flat", p.first_depth_m);
  v.count("discs", {2, kMaxDiscs}, "in series", p.discs);
}

Result<DiscSeries> make_disc_series(const DiscSeriesParameters& p) {
  if (auto wrong = check_meaning("disc_series", p)) return *wrong;
  if (!(p.first_depth_m < p.working_depth_m))
    return Error{
        "disc_series: first_depth_m must be below working_depth_m, at which the last disc is flat"};
  DiscSeries series;
  series.size_ = p.discs;
  const double last = static_cast<double>(p.discs - 1);
  const double first_ln = std::log(p.first_depth_m / p.working_depth_m);
  DiscSeries::Disc before;  // DS-14, DS-15
  for (std::size_t i = 0; i < p.discs; ++i) {
    DiscSeries::Disc& disc = series.disc_[i];
    const double x_ln = first_ln * (last - static_cast<double>(i)) / last;
    disc.flat_m = p.working_depth_m * std::exp(x_ln);
    disc.flat_N = p.force_N * std::exp((p.exponent + 0.5 * p.exponent_slope * x_ln) * x_ln);
    disc.series_N_per_m = (disc.flat_N - before.flat_N) / (disc.flat_m - before.flat_m);
    if (!(disc.series_N_per_m > before.series_N_per_m))
      return Error{
          "disc_series: the stiffness falls where a disc goes flat; raise exponent or bring "
          "exponent_slope nearer to 0"};
    disc.begin_N = before.flat_N;
    disc.begin_m = before.flat_m;
    disc.begin_J =
        before.begin_J + 0.5 * (before.begin_N + before.flat_N) * (before.flat_m - before.begin_m);
    before = disc;
  }
  double stiffer_m_per_N = 0.0;  // 1 / K_(i+1)
  for (std::size_t i = p.discs; i-- > 0;) {
    DiscSeries::Disc& disc = series.disc_[i];
    const double own_m_per_N = 1.0 / disc.series_N_per_m;
    disc.stiffness_N_per_m = 1.0 / (own_m_per_N - stiffer_m_per_N);
    stiffer_m_per_N = own_m_per_N;
  }
  return series;
}

}  // namespace tact::model::indent
