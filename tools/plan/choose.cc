// SPDX-License-Identifier: Apache-2.0
#include "tools/plan/choose.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace tact::tools::plan {
namespace {

using model::scene::ToleranceSettings;

/// A candidate that crashed or timed out has NaN in its row.
bool is_measured(const Candidate& c) {
  return std::isfinite(c.force_error_ratio) && std::isfinite(c.own_error_ratio.value_or(0.0)) &&
         std::isfinite(c.shape_error_ratio) && std::isfinite(c.tick_p999_us) &&
         std::isfinite(c.tick_median_us);
}

std::string text_of(const Candidate& c) {
  const std::string force =
      c.own_error_ratio
          ? fmt::format("force of the whole tool {:.2g} %, of the own at worst {:.2g} %",
                        100.0 * c.force_error_ratio, 100.0 * *c.own_error_ratio)
          : fmt::format("force of one sphere {:.2g} %", 100.0 * c.force_error_ratio);
  return fmt::format("{}: {}, shape {:.2g} %, {:.3g} us (p99.9 {:.3g} us), {:.3g} kB",
                     model::scene::text_of(c.sizes), force, 100.0 * c.shape_error_ratio,
                     c.tick_median_us, c.tick_p999_us, 1e-3 * c.memory_bytes);
}

/// What a candidate lacks, each with its remedy.
std::string lacks(const Candidate& c, const ToleranceSettings& t) {
  std::string out;
  const auto add = [&out](const std::string& part) { out += (out.empty() ? "" : "; ") + part; };
  if (c.force_error_ratio > t.force_error_ratio)
    add(
        fmt::format("force error {:.3g} above tolerance.force_error_ratio = {:.3g}: fit the law "
                    "(tact-lab fit), describe a nearer one ([compliance]) or allow {:.3g}",
                    c.force_error_ratio, t.force_error_ratio, c.force_error_ratio));
  if (c.own_error_ratio.value_or(0.0) > t.force_error_ratio)
    add(fmt::format("{:.3g} of the own force at the worst place, above tolerance.force_error_ratio",
                    *c.own_error_ratio));
  if (c.shape_error_ratio > t.shape_error_ratio)
    add(
        fmt::format("shape error {:.3g} above tolerance.shape_error_ratio = {:.3g}: describe a law "
                    "with a wider shape ([compliance]) or allow {:.3g}",
                    c.shape_error_ratio, t.shape_error_ratio, c.shape_error_ratio));
  if (c.tick_p999_us > t.tick_budget_us)
    add(
        fmt::format("p99.9 of {:.3g} us above tolerance.tick_budget_us = {:.3g}: allow more or use "
                    "a faster machine",
                    c.tick_p999_us, t.tick_budget_us));
  return out;
}

/// The fastest of those left, memory deciding among times that do not differ.
std::size_t least_of(std::span<const Candidate> candidates, const std::vector<std::size_t>& among) {
  double fastest_us = candidates[among.front()].tick_median_us;
  for (const std::size_t i : among) fastest_us = std::min(fastest_us, candidates[i].tick_median_us);
  std::size_t best = among.size();
  for (std::size_t k = 0; k < among.size(); ++k) {
    const Candidate& c = candidates[among[k]];
    // Times within 10 % are one time (choose.h).
    if (c.tick_median_us > (1.0 + chart::kSameTime_ratio) * fastest_us) continue;
    const auto key = [](const Candidate& x) {
      return std::pair{x.memory_bytes, x.force_error_ratio};
    };
    if (best == among.size() || key(c) < key(candidates[among[best]])) best = k;
  }
  return among[best];
}

/// Of `enough`, those beside the least. One of another law says more than another size of the same.
std::vector<std::size_t> others_of(std::span<const Candidate> candidates,
                                   std::span<const std::size_t> enough, std::size_t least) {
  std::vector<std::size_t> other_laws, others;
  for (const std::size_t i : enough) {
    if (candidates[i].sizes.law != candidates[least].sizes.law) other_laws.push_back(i);
    if (i != least) others.push_back(i);
  }
  return other_laws.empty() ? others : other_laws;
}

}  // namespace

bool is_enough(const Candidate& c, const ToleranceSettings& t) {
  return is_measured(c) && excess_ratio(c, t) <= 1.0;
}

double excess_ratio(const Candidate& c, const ToleranceSettings& t) {
  return std::max({c.force_error_ratio / t.force_error_ratio,
                   c.own_error_ratio.value_or(0.0) / t.force_error_ratio,
                   c.shape_error_ratio / t.shape_error_ratio, c.tick_p999_us / t.tick_budget_us});
}

Choice choose(std::span<const Candidate> candidates, const ToleranceSettings& tolerance) {
  std::vector<std::size_t> enough, nearest;
  double least_ratio = std::numeric_limits<double>::infinity();
  for (const Candidate& c : candidates)
    if (is_measured(c)) least_ratio = std::min(least_ratio, excess_ratio(c, tolerance));
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    if (!is_measured(candidates[i])) continue;
    const double ratio = excess_ratio(candidates[i], tolerance);
    if (ratio <= 1.0) enough.push_back(i);
    if (ratio <= least_ratio) nearest.push_back(i);
  }
  Choice out;
  if (nearest.empty()) {
    out.reason = "no law of the scene could be measured";
    return out;
  }
  out.meets = !enough.empty();
  if (!out.meets) {
    out.chosen = least_of(candidates, nearest);
    const Candidate& c = candidates[*out.chosen];
    out.reason =
        fmt::format("no law meets [tolerance]; nearest is {}. {}", text_of(c), lacks(c, tolerance));
    return out;
  }
  out.chosen = least_of(candidates, enough);
  const auto others = others_of(candidates, enough, *out.chosen);
  out.reason = fmt::format(
      "{} of {} measured laws and sizes meet [tolerance]; of these it is the fastest, "
      "within {:g} % the smallest. {}",
      enough.size(), candidates.size(), 100.0 * chart::kSameTime_ratio,
      text_of(candidates[*out.chosen]));
  if (others.empty()) return out;
  out.runner_up = least_of(candidates, others);
  out.reason += fmt::format(". Runner-up: {}", text_of(candidates[*out.runner_up]));
  return out;
}

}  // namespace tact::tools::plan
