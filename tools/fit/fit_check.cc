// SPDX-License-Identifier: Apache-2.0
#include "tools/fit/fit_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/report/just_noticeable.h"

namespace tact::tools::fit {
namespace {

using report::kJustNoticeable_ratio;

double local_ratio(double error_N, double force_N) {
  constexpr double kFloor_N = 0.1;  // fit_check.h
  return std::abs(error_N) / std::max(std::abs(force_N), kFloor_N);
}

/// Sums up to a Residual.
class Errors {
 public:
  void add(double error_N, double force_N) {
    sum_ += error_N * error_N;
    worst_N_ = std::max(worst_N_, std::abs(error_N));
    local_ratio_ = std::max(local_ratio_, local_ratio(error_N, force_N));
    ++count_;
  }
  Residual of_peak(double peak_N) const {
    return {.samples = count_,
            .rms_N = count_ > 0 ? std::sqrt(sum_ / static_cast<double>(count_)) : 0.0,
            .worst_N = worst_N_,
            .peak_N = peak_N,
            .local_ratio = local_ratio_};
  }

 private:
  std::size_t count_ = 0;
  double sum_ = 0.0, worst_N_ = 0.0, local_ratio_ = 0.0;
};

/// Root of the mean of the squares that were added; NaN if there were none.
struct RootMeanSquare {
  double sum = 0.0;
  int count = 0;

  void add(double e) {
    if (std::isfinite(e)) sum += e * e, ++count;
  }
  double root() const { return count > 0 ? std::sqrt(sum / count) : std::nan(""); }
};

struct Point {
  double depth_m, force_N;
};

/// dF/dd of the second half of the press over that of the first, by straight lines; NaN: too few.
double growth_of_slope(std::vector<Point> points) {
  // Rest is a point that every press has, measured or not.
  points.push_back({0.0, 0.0});
  std::sort(points.begin(), points.end(),
            [](const Point& a, const Point& b) { return a.depth_m < b.depth_m; });
  // Two for each half.
  constexpr std::size_t kMin = 4;
  if (points.size() < kMin) return std::nan("");
  const auto slope = [&](bool second) {
    const double middle_m = 0.5 * points.back().depth_m;
    double n = 0.0, d = 0.0, f = 0.0, dd = 0.0, df = 0.0;
    for (const Point& p : points) {
      if (second ? p.depth_m < middle_m : p.depth_m > middle_m) continue;
      n += 1.0, d += p.depth_m, f += p.force_N;
      dd += p.depth_m * p.depth_m, df += p.depth_m * p.force_N;
    }
    return (n * df - d * f) / (n * dd - d * d);
  };
  return slope(true) / slope(false) - 1.0;
}

std::string word_of(double growth) {
  // Below half a percent the rounded word would say "by 0 %".
  constexpr double kMinGrowth_ratio = 0.005;
  if (std::abs(growth) < kMinGrowth_ratio) return "stays";
  return fmt::format("{} by {:.0f} %", growth < 0.0 ? "falls" : "grows", 100.0 * std::abs(growth));
}

/// Mean over sites of how dF/dd grows in press, in the data and by the law.
std::string slope_reason(const FitData& data, std::span<const FitAnswer> answers) {
  double of_data = 0.0, of_law = 0.0;
  int sites = 0;
  std::size_t i = 0;
  for (const FitSite& site : data.sites) {
    std::vector<Point> measured, rendered;
    for (const FitSample& s : site.samples) {
      const FitAnswer& answer = answers[i++];
      if (!(s.depth_m > 0.0)) continue;
      measured.push_back({s.depth_m, s.force_N});
      rendered.push_back({s.depth_m, answer.force_N});
    }
    const double a = growth_of_slope(measured), b = growth_of_slope(rendered);
    if (!std::isfinite(a) || !std::isfinite(b)) continue;
    of_data += a, of_law += b, ++sites;
  }
  if (sites == 0) return {};
  of_data /= sites, of_law /= sites;
  // A difference that no hand notices is no reason.
  if (std::abs(of_data - of_law) < kJustNoticeable_ratio) return {};
  const auto way = [](double growth) {
    return growth > kJustNoticeable_ratio    ? "hardens"
           : growth < -kJustNoticeable_ratio ? "softens"
                                             : "is linear";
  };
  const std::string law_way = way(of_law), data_way = way(of_data);
  const std::string what =
      law_way != data_way ? fmt::format("{} in press while the data {}", law_way, data_way)
                          : fmt::format("{} in press {} than the data", law_way,
                                        std::abs(of_law) > std::abs(of_data) ? "more" : "less");
  return fmt::format("{}: from its first to its second half dF/dd {}, in the data it {}", what,
                     word_of(of_law), word_of(of_data));
}

/// The sample that is farthest off by its own force, if a hand notices that.
std::string local_reason(const FitData& data, std::span<const FitAnswer> answers,
                         const Evaluation& j) {
  double worst_ratio = kJustNoticeable_ratio;
  std::string out;
  std::size_t i = 0, at_site = 0;
  for (const FitSite& site : data.sites) {
    const double scale = j.sites[at_site++].scale;
    for (const FitSample& s : site.samples) {
      const double force_N = scale * answers[i++].force_N;
      const double ratio = local_ratio(force_N - s.force_N, s.force_N);
      if (!(ratio > worst_ratio)) continue;
      worst_ratio = ratio;
      out = fmt::format("at {:.3g} mm it gives {:.3g} N, the data {:.3g} N", 1e3 * s.depth_m,
                        force_N, s.force_N);
    }
  }
  return out;
}

std::vector<std::string> reasons_of(const FitData& data, std::span<const FitAnswer> answers,
                                    const Evaluation& j, bool scale_by_site, double press_limit_m) {
  std::vector<std::string> reasons;
  if (press_limit_m < data.deepest_m())
    reasons.push_back(fmt::format("its force stays from {:.3g} mm on, the data goes to {:.3g} mm",
                                  1e3 * press_limit_m, 1e3 * data.deepest_m()));
  if (const std::string slope = slope_reason(data, answers); !slope.empty())
    reasons.push_back(slope);
  const std::string local = local_reason(data, answers, j);
  const auto [low, high] = std::minmax_element(
      j.sites.begin(), j.sites.end(),
      [](const SiteResidual& a, const SiteResidual& b) { return a.best_scale < b.best_scale; });
  const double spread = (high->best_scale - low->best_scale) / (high->best_scale + low->best_scale);
  if (!scale_by_site && spread > kJustNoticeable_ratio)
    reasons.push_back(
        fmt::format("one stiffness for all sites: sites differ by ±{:.0f} %, from "
                    "{} to {}",
                    100.0 * spread, low->name, high->name));
  if (!local.empty()) reasons.push_back(local);
  // None of the known reasons: say at least that it is the form.
  if (reasons.empty()) reasons.emplace_back("its curve has another form than the data");
  return reasons;
}

}  // namespace

double best_scale(std::span<const FitSample> samples, std::span<const FitAnswer> answers) {
  double sum_ab = 0.0, sum_aa = 0.0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    sum_ab += answers[i].force_N * samples[i].force_N;
    sum_aa += answers[i].force_N * answers[i].force_N;
  }
  // Least squares of one factor; a law without force has none that would help.
  return sum_aa > 0.0 ? sum_ab / sum_aa : 1.0;
}

double shape_error(const FitSample& sample, const FitAnswer& answer) {
  RootMeanSquare rms;
  if (sample.depth_m != 0.0)
    for (std::size_t k = 0; k < std::min(sample.ring_m.size(), answer.ring_m.size()); ++k)
      rms.add((answer.ring_m[k] - sample.ring_m[k]) / sample.depth_m);
  return rms.root();
}

Evaluation check(const FitData& data, std::span<const FitAnswer> answers, bool scale_by_site,
                 double press_limit_m) {
  Evaluation out;
  Errors fitted, held_out, press, pull;
  RootMeanSquare shape, held_out_shape;
  std::size_t first = 0;
  for (const FitSite& site : data.sites) {
    const auto own = answers.subspan(first, site.samples.size());
    first += site.samples.size();
    SiteResidual row{.name = site.name, .held_out = site.held_out};
    row.best_scale = best_scale(site.samples, own);
    // Reported even where it is not used: it shows how much the sites differ.
    if (scale_by_site) row.scale = row.best_scale;
    Errors of_site;
    RootMeanSquare site_shape;
    double peak_N = 0.0;
    for (std::size_t i = 0; i < own.size(); ++i) {
      const FitSample& s = site.samples[i];
      const double error_N = row.scale * own[i].force_N - s.force_N;
      peak_N = std::max(peak_N, std::abs(s.force_N));
      of_site.add(error_N, s.force_N);
      (site.held_out ? held_out : fitted).add(error_N, s.force_N);
      (s.depth_m < 0.0 ? pull : press).add(error_N, s.force_N);
      const double u = shape_error(s, own[i]);
      site_shape.add(u);
      (site.held_out ? held_out_shape : shape).add(u);
    }
    row.force = of_site.of_peak(peak_N);
    row.shape_rms_ratio = site_shape.root();
    out.sites.push_back(row);
  }
  const double peak_N = data.peak_N();
  out.fitted = fitted.of_peak(peak_N);
  out.held_out = held_out.of_peak(peak_N);
  out.press = press.of_peak(peak_N);
  out.pull = pull.of_peak(peak_N);
  out.shape_rms_ratio = shape.root();
  out.held_out_shape_rms_ratio = held_out_shape.root();
  const auto is_near = [](const Residual& r) {
    return std::max(r.rms_ratio(), r.local_ratio) <= kJustNoticeable_ratio;
  };
  out.follows = is_near(out.fitted) && is_near(out.held_out);
  const bool suits_all = std::all_of(out.sites.begin(), out.sites.end(), [](const auto& site) {
    return site.force.rms_ratio() <= kJustNoticeable_ratio;
  });
  if (!out.follows || !suits_all)
    out.reasons = reasons_of(data, answers, out, scale_by_site, press_limit_m);
  return out;
}

}  // namespace tact::tools::fit
