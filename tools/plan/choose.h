// SPDX-License-Identifier: Apache-2.0
// choose.h - the least law that is good enough: a pure function over measured candidates.
//
//     enough   force_error <= wanted, shape_error <= wanted, tick p99.9 <= budget; of the whole
//              tool the error of the own force at the worst place and depth <= wanted too
//     least    by time, then by memory, then by the smaller force error
//
// If none is enough, the nearest: the one whose worst excess over a limit, as a ratio, is smallest,
// then by time and memory. That it is not enough is said. Times of two candidates count as equal
// within 10 %: a clock resolves no less, and the next measurement would turn them round.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "model/scene/plan_file.h"
#include "tools/chart/measure/errors.h"

namespace tact::tools::plan {

/// One measured law and size.
struct Candidate {
  model::scene::LawSizes sizes;
  double force_error_ratio = 0.0;  // RMS, of the peak; of the whole tool or of one sphere
  /// Of the whole tool: of the own force, the largest of all places and depths. None: one sphere.
  std::optional<double> own_error_ratio{};
  double shape_error_ratio = 0.0;  // RMS, of the depth
  double tick_median_us = 0.0;
  double tick_p999_us = 0.0;
  double memory_bytes = 0.0;
};

struct Choice {
  bool meets = false;                    // chosen is enough
  std::optional<std::size_t> chosen;     // or the nearest
  std::optional<std::size_t> runner_up;  // the next that is enough, of another law if there is one
  std::string reason;
};

bool is_enough(const Candidate& c, const model::scene::ToleranceSettings& tolerance);
/// The largest of its errors and its time over their limits; at most 1: it is enough.
double excess_ratio(const Candidate& c, const model::scene::ToleranceSettings& tolerance);

/// Candidates with a number that is not finite are never chosen; none at all: no choice.
Choice choose(std::span<const Candidate> candidates,
              const model::scene::ToleranceSettings& tolerance);

}  // namespace tact::tools::plan
