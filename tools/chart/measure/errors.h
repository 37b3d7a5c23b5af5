// SPDX-License-Identifier: Apache-2.0
// errors.h - how far a law is from the reference, in numbers: pure functions over samples.
//
//     force   e = F - F_ref;        RMS and worst over sites and depths, of the peak |F_ref|
//     own     e of a press over |F_ref| of the same site and depth: the worst site at each depth
//     shape   e_j = u_j - u_ref,j;  RMS over the rings of a case, of its |depth|; then RMS and
//             worst over the cases
//
// Press and pull count alike. A case counts as right where |e| is at most 7 % of |F_ref|: the
// least difference of force that a hand can notice (just_noticeable.h).
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace tact::tools::chart {

/// Root of the mean square of what it is given; NaN of nothing.
class Rms {
 public:
  void add(double e) { sum_ += e * e, ++count_; }
  double value() const;

 private:
  double sum_ = 0.0;
  std::size_t count_ = 0;
};

/// Light touch counts as much as a deep press.
inline constexpr std::array kOwnDepths_m{0.001, 0.002, 0.005, 0.010};

/// One depth at one site.
struct Sample {
  std::size_t site = 0;
  bool held_out = false;  // no law was fitted to this site
  double depth_m = 0.0;   // press above 0
  double force_N = 0.0;
  double reference_N = 0.0;
  std::vector<double> ring_m, reference_ring_m;  // NaN: not known, not compared
};

struct ErrorSummary {
  std::size_t cases = 0;
  double force_rms_ratio = 0.0, force_worst_ratio = 0.0;  // of the peak
  double press_rms_ratio = 0.0, pull_rms_ratio = 0.0;     // of the peak; NaN without such a case
  double held_out_rms_ratio = 0.0;                        // of the peak; NaN without such a site
  double worst_site_rms_ratio = 0.0;                      // of that site's own peak
  std::array<double, kOwnDepths_m.size()> own_worst_ratio{};  // with its sign; NaN: no such depth
  double own_largest_ratio = 0.0;                             // of any press, its size
  double within_jnd_ratio = 0.0;                              // share of the cases
  double shape_rms_ratio = 0.0, shape_worst_ratio = 0.0;      // of the depth
};

ErrorSummary summarize(std::span<const Sample> samples);

/// Medians of one machine within this of each other are one time.
inline constexpr double kSameTime_ratio = 0.10;

/// A point of the chart: smaller is better in both.
struct SpeedAndError {
  double tick_us = 0.0;
  double error_ratio = 0.0;
};

/// The points that no other beats in both (Pareto front), fastest first; of equal points the first.
std::vector<std::size_t> front_of(std::span<const SpeedAndError> points);

}  // namespace tact::tools::chart
