// SPDX-License-Identifier: Apache-2.0
// fit_search.h - the least sum of squares within bounds, by Levenberg and Marquardt's method.
//
// Unknowns are logarithms of parameters, so a step means a ratio; slopes are central differences.
// Out of its bounds an unknown stays at the bound, and the distance counts as one more residual, so
// the search comes back. Deterministic. Source: Eigen's port of MINPACK (J. More, 1978).
#pragma once

#include <functional>
#include <span>
#include <vector>

namespace tact::tools::fit {

struct SearchProblem {
  std::size_t residuals = 0;
  std::vector<double> low{}, high{};  // of each unknown
  double difference = 1e-4;           // half the step of a slope
  int most_evaluations = 2000;
  /// Fills the residuals; false where there is nothing to compare (parameters without a law).
  std::function<bool(std::span<const double> x, std::span<double> residual)> residual{};
};

struct SearchResult {
  std::vector<double> x;        // within the bounds
  double sum_of_squares = 0.0;  // of the residuals there
  int evaluations = 0;
};

SearchResult search(const SearchProblem& problem, const std::vector<double>& start);

}  // namespace tact::tools::fit
