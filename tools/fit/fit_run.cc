// SPDX-License-Identifier: Apache-2.0
#include "tools/fit/fit_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "model/scene/laws.h"
#include "model/scene/tissue_law.h"
#include "tools/fit/fit_search.h"

namespace tact::tools::fit {
namespace {

using model::Error;
using model::Result;
using model::scene::Scene;

/// The deepest press and pull of a site, and the ones nearest to half of them.
void thin(FitSite& site) {
  std::vector<FitSample> kept;
  for (const double sign : {1.0, -1.0}) {
    double deepest_m = 0.0;
    for (const FitSample& s : site.samples) deepest_m = std::max(deepest_m, sign * s.depth_m);
    if (!(deepest_m > 0.0)) continue;
    for (const double share : {0.5, 1.0}) {
      const double wanted_m = sign * share * deepest_m;
      const FitSample& nearest = *std::min_element(
          site.samples.begin(), site.samples.end(), [&](const FitSample& a, const FitSample& b) {
            return std::abs(a.depth_m - wanted_m) < std::abs(b.depth_m - wanted_m);
          });
      const bool is_new = kept.empty() || kept.back().depth_m != nearest.depth_m;
      if (is_new) kept.push_back(nearest);
    }
  }
  site.samples = std::move(kept);
}

/// The samples that are fitted.
FitData fitted_part(const FitData& data, const FitLaw& law) {
  FitData part = data;
  std::erase_if(part.sites, [](const FitSite& site) { return site.held_out; });
  if (law.is_slow) std::for_each(part.sites.begin(), part.sites.end(), thin);
  return part;
}

/// One scene whose numbers are turned, and the residuals of the law that it makes.
class Fit {
 public:
  Fit(const FitLaw& law, const Scene& scene, const FitData& data, const FitOptions& options)
      : law_(law), data_(fitted_part(data, law)), options_(options), scene_(scene) {
    // The data is slow or solved: what relaxes is fitted apart (fit_prony.h).
    scene_.relaxation.clear();  // forces at once
    if (data.large_strain) scene_.compliance.large_strain = *data.large_strain;
    reach(scene_, data);
    for (const FitSite& site : data_.sites) samples_ += site.samples.size();
    with_shapes_ = options.shape_weight > 0.0 && data_.has_shapes();
    peak_N_ = data_.peak_N();
    for (const FitParameter& p : law.parameters)
      scene_value_.push_back(std::clamp(p.in(scene_), p.low, p.high));
  }

  SearchProblem problem() {
    SearchProblem out{.residuals = samples_ * (with_shapes_ ? 2 : 1) + 1,
                      .difference = law_.difference,
                      .most_evaluations = law_.most_evaluations};
    for (const FitParameter& p : law_.parameters) {
      // Logarithms: a step means a ratio, in any unit (fit_search.h).
      out.low.push_back(std::log(p.low));
      out.high.push_back(std::log(p.high));
    }
    out.residual = [this](std::span<const double> x, std::span<double> r) {
      set(x);
      const auto answers = answers_of(scene_, law_.law, data_, AnswerBy::kSolving);
      if (answers) fill(*answers, r);
      return answers.has_value();
    };
    return out;
  }

  /// The scene's numbers times the start's ratios, stiffnesses then scaled to the data's force.
  std::vector<double> start(const std::vector<double>& ratios) {
    std::vector<double> x;
    for (std::size_t i = 0; i < law_.parameters.size(); ++i) {
      const FitParameter& p = law_.parameters[i];
      x.push_back(std::log(std::clamp(scene_value_[i] * ratios[i], p.low, p.high)));
    }
    set(x);
    const auto answers = answers_of(scene_, law_.law, data_, AnswerBy::kSolving);
    // A start that makes no law: the search finds its own way, or another start wins.
    if (!answers) return x;
    const double factor = press_factor(*answers);
    for (std::size_t i = 0; i < law_.parameters.size(); ++i) {
      const FitParameter& p = law_.parameters[i];
      if (p.is_stiffness)
        x[i] = std::clamp(x[i] + std::log(factor), std::log(p.low), std::log(p.high));
    }
    return x;
  }

  void set(std::span<const double> x) {
    for (std::size_t i = 0; i < x.size(); ++i) law_.parameters[i].in(scene_) = std::exp(x[i]);
    if (law_.follow) law_.follow(scene_);
  }
  const Scene& scene() const { return scene_; }
  Scene& scene() { return scene_; }

 private:
  double press_factor(const std::vector<FitAnswer>& answers) const {
    double sum_ab = 0.0, sum_aa = 0.0;
    std::size_t i = 0;
    for (const FitSite& site : data_.sites)
      for (const FitSample& s : site.samples) {
        const double force_N = answers[i++].force_N;
        if (!(s.depth_m > 0.0)) continue;
        sum_ab += force_N * s.force_N, sum_aa += force_N * force_N;
      }
    return sum_ab > 0.0 && sum_aa > 0.0 ? sum_ab / sum_aa : 1.0;
  }

  void fill(std::span<const FitAnswer> answers, std::span<double> r) const {
    // The sum of squares then is a mean: many samples do not outweigh the shape.
    const double share = 1.0 / std::sqrt(static_cast<double>(samples_));
    std::size_t i = 0;
    double log_scales = 0.0;
    for (const FitSite& site : data_.sites) {
      const auto own = answers.subspan(i, site.samples.size());
      const double scale = options_.scale_by_site ? best_scale(site.samples, own) : 1.0;
      // A factor of 0 or less would have no logarithm.
      log_scales += std::log(std::max(scale, 1e-9));
      for (std::size_t k = 0; k < own.size(); ++k, ++i) {
        r[i] = share * (scale * own[k].force_N - site.samples[k].force_N) / peak_N_;
        if (!with_shapes_) continue;
        const double u = shape_error(site.samples[k], own[k]);
        r[samples_ + i] = std::isfinite(u) ? share * options_.shape_weight * u : 0.0;
      }
    }
    // With a factor for each site, one for all is free: their geometric mean shall be 1.
    constexpr double kMeanWeight = 0.1;
    r.back() = kMeanWeight * log_scales / static_cast<double>(data_.sites.size());
  }

  const FitLaw& law_;
  FitData data_;
  FitOptions options_;
  Scene scene_;
  std::vector<double> scene_value_;
  std::size_t samples_ = 0;
  bool with_shapes_ = false;
  double peak_N_ = 0.0;
};

/// A short search from every start, a long one from the best of them.
SearchResult search_from_all(const FitLaw& law, Fit& fit, int& evaluations) {
  constexpr double kShortSearch_ratio = 0.1;
  SearchProblem problem = fit.problem();
  const auto go = [&](const std::vector<double>& start) {
    SearchResult found = search(problem, start);
    evaluations += found.evaluations;
    return found;
  };
  SearchResult best;
  if (law.starts.size() > 1)
    // A tenth shows which valley is the deepest.
    problem.most_evaluations = static_cast<int>(kShortSearch_ratio * law.most_evaluations);
  for (const std::vector<double>& ratios : law.starts) {
    SearchResult found = go(fit.start(ratios));
    if (best.x.empty() || found.sum_of_squares < best.sum_of_squares) best = std::move(found);
  }
  if (law.starts.size() == 1) return best;
  problem.most_evaluations = law.most_evaluations;
  return go(best.x);
}

FittedKey key_of(const FitParameter& p, Scene& scene) {
  // Within a thousandth: the search stops a little beside a bound.
  constexpr double kNearBound_ratio = 1.001;
  const double value = p.in(scene);
  return {p.section, p.key, value,
          value < kNearBound_ratio * p.low || value > p.high / kNearBound_ratio};
}

/// Working depths that reach() had to raise belong into the scene too.
void add_raised(const FitLaw& law, Scene before, Scene& after, std::vector<FittedKey>& keys) {
  const auto add = [&keys](const std::string& section, const char* key, double was, double is) {
    if (is != was) keys.push_back({section, key, is, false});
  };
  const model::scene::LawRow& row = *model::scene::find_law(law.law);
  if (const double* is_m = parameters_of(row, after).find("working_depth_m").number)
    add(law.law, "working_depth_m", *parameters_of(row, before).find("working_depth_m").number,
        *is_m);
  const bool has_pull =
      std::any_of(keys.begin(), keys.end(), [](const FittedKey& k) { return k.section == "pull"; });
  if (has_pull)
    add("pull", "limit_m", before.pull ? before.pull->limit_m : 0.0, after.pull->limit_m);
}

}  // namespace

Result<FittedLaw> fit_law(const FitLaw& law, const Scene& scene, const FitData& data,
                          const FitOptions& options) {
  if ((law.by_place || scene.varies_by_place) && !data.has_places())
    return Error{fmt::format(
        "{} differs from place to place: write the vertex of the organ into a column site of {}{}",
        law.name, data.source, law.by_place ? "" : ", or --set varies_by_place=false")};
  if (law.by_place)  // the map that such a law needs may be missing
    if (const auto possible = make_tissue_law(scene, law.law); !possible) return possible.error();
  Fit fit(law, scene, data, options);
  FittedLaw out{.name = law.name, .choice = law.choice};
  const SearchResult best = search_from_all(law, fit, out.evaluations);
  fit.set(best.x);
  const auto made = make_tissue_law(fit.scene(), law.law);
  if (!made) return made.error();
  // By the loop's tables, with all samples: the force that is rendered is evaluated.
  auto answers = answers_of(fit.scene(), law.law, data);
  if (!answers) return answers.error();
  out.title = (*made)->title();
  out.answers = std::move(*answers);
  out.checked = check(data, out.answers, options.scale_by_site, (*made)->range().press_m);
  for (const FitParameter& p : law.parameters) out.keys.push_back(key_of(p, fit.scene()));
  for (const FitParameter& p : law.followers) out.keys.push_back(key_of(p, fit.scene()));
  add_raised(law, scene, fit.scene(), out.keys);
  return out;
}

}  // namespace tact::tools::fit
