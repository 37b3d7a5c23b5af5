// SPDX-License-Identifier: Apache-2.0
#include "tools/fit/fit_prony.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "tools/fit/fit_search.h"

namespace tact::tools::fit {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using model::Error;
using model::Result;

// Chosen: a thousandth of the force is below a bench's noise.
constexpr double kMinShare = 1e-3;  // less is within the noise

/// Shares >= 0 with the least squares, by trying which of them are 0: at most 2^4 sets.
VectorXd shares_of(const MatrixXd& basis, const VectorXd& force_N) {
  VectorXd best = VectorXd::Zero(basis.cols());
  double least = force_N.squaredNorm();
  for (unsigned set = 1; set < (1U << basis.cols()); ++set) {
    std::vector<Index> in;
    for (Index c = 0; c < basis.cols(); ++c)
      if ((set >> c & 1U) != 0) in.push_back(c);
    const VectorXd part = basis(Eigen::all, in).colPivHouseholderQr().solve(force_N);
    // A negative share would be a tissue that gains force while it is held.
    if (!part.allFinite() || part.minCoeff() < 0.0) continue;
    VectorXd all = VectorXd::Zero(basis.cols());
    all(in) = part;
    const double sum = (basis * all - force_N).squaredNorm();
    if (sum < least) least = sum, best = all;
  }
  return best;
}

class HeldProblem {
 public:
  HeldProblem(const std::vector<HeldForce>& held, const PronyOptions& options)
      : options_(options), time_s_(static_cast<Index>(held.size())), force_N_(time_s_.size()) {
    for (Index i = 0; i < time_s_.size(); ++i) {
      time_s_[i] = held[static_cast<std::size_t>(i)].time_s - held[0].time_s;
      force_N_[i] = held[static_cast<std::size_t>(i)].force_N;
    }
  }

  PronyFit fit(std::size_t terms) const;

 private:
  MatrixXd basis(std::span<const double> log_time) const {
    MatrixXd out = MatrixXd::Ones(time_s_.size(), static_cast<Index>(log_time.size()) + 1);
    for (std::size_t c = 0; c < log_time.size(); ++c)
      out.col(static_cast<Index>(c) + 1) = (-time_s_ / std::exp(log_time[c])).array().exp();
    return out;
  }
  PronyFit finish(const std::vector<double>& log_time) const;

  const PronyOptions& options_;
  VectorXd time_s_, force_N_;
};

PronyFit HeldProblem::finish(const std::vector<double>& log_time) const {
  const MatrixXd at = basis(log_time);
  const VectorXd share_N = shares_of(at, force_N_);
  const VectorXd error_N = at * share_N - force_N_;
  PronyFit out{.initial_N = share_N.sum()};
  const double rms_N = std::sqrt(error_N.squaredNorm() / static_cast<double>(error_N.size()));
  out.residual_ratio = rms_N / out.initial_N;
  out.worst_ratio = error_N.cwiseAbs().maxCoeff() / out.initial_N;
  out.is_good = out.residual_ratio <= options_.good_residual;
  for (std::size_t c = 0; c < log_time.size(); ++c) {
    const double share = share_N[static_cast<Index>(c) + 1] / out.initial_N;
    if (share >= kMinShare) out.terms.push_back({.share = share, .time_s = std::exp(log_time[c])});
  }
  std::sort(out.terms.begin(), out.terms.end(),
            [](const auto& a, const auto& b) { return a.time_s < b.time_s; });
  return out;
}

PronyFit HeldProblem::fit(std::size_t terms) const {
  // Times that the data can show: a third of its first step to three times its length.
  const double shortest = std::log(0.3 * (time_s_[1] - time_s_[0]));
  const double longest = std::log(3.0 * time_s_[time_s_.size() - 1]);
  const double scale =
      1.0 / (force_N_.cwiseAbs().maxCoeff() * std::sqrt(static_cast<double>(time_s_.size())));
  const SearchProblem problem{.residuals = static_cast<std::size_t>(time_s_.size()),
                              .low = std::vector<double>(terms, shortest),
                              .high = std::vector<double>(terms, longest),
                              .residual = [&](std::span<const double> x, std::span<double> r) {
                                const MatrixXd at = basis(x);
                                Eigen::Map<VectorXd>(r.data(), time_s_.size()) =
                                    // Only times are searched: the shares are linear, and solved
                                    // for at each step.
                                    scale * (at * shares_of(at, force_N_) - force_N_);
                                return true;
                              }};
  SearchResult best;
  for (const double shift : {0.5, 0.3, 0.7}) {  // spread over the times that the data can show
    std::vector<double> start(terms);
    for (std::size_t i = 0; i < terms; ++i)
      start[i] = shortest + (longest - shortest) * (static_cast<double>(i) + shift) /
                                static_cast<double>(terms);
    SearchResult found = search(problem, start);
    if (best.x.empty() || found.sum_of_squares < best.sum_of_squares) best = std::move(found);
  }
  return finish(best.x);
}

}  // namespace

Result<PronyFit> fit_prony(const std::vector<HeldForce>& held, const PronyOptions& options) {
  if (held.size() < 2 * (std::max<std::size_t>(1, options.terms) + 1))
    return Error{fmt::format("relaxation: {} rows; {} terms need twice as many and two more",
                             held.size(), std::max<std::size_t>(1, options.terms))};
  for (std::size_t i = 0; i < held.size(); ++i)
    if (!(held[i].force_N >= 0.0) || !(held[0].force_N > 0.0) ||
        (i > 0 && !(held[i].time_s > held[i - 1].time_s)))
      return Error{fmt::format("relaxation: row {}: forces must be above 0 and times rise", i + 1)};
  const HeldProblem problem(held, options);
  if (options.terms > 0) return problem.fit(std::min(options.terms, model::law::kMaxPronyTerms));
  PronyFit best;
  for (std::size_t terms = 1; terms <= model::law::kMaxPronyTerms; ++terms) {
    if (held.size() < 2 * (terms + 1)) break;
    best = problem.fit(terms);
    if (best.is_good) break;
  }
  return best;
}

}  // namespace tact::tools::fit
