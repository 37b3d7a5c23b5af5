// SPDX-License-Identifier: Apache-2.0
#include "tools/fit/fit_search.h"

#include <Eigen/Core>
#include <algorithm>
#include <unsupported/Eigen/NonLinearOptimization>

#include "tools/program/interrupt.h"

namespace tact::tools::fit {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// A thousand peaks: the search turns away from there at once.
constexpr double kNoLaw = 1e3;        // residual of parameters that make no law
constexpr double kOutOfBounds = 0.1;  // weight of the way back to a bound

std::size_t at(Index i) { return static_cast<std::size_t>(i); }

/// What Eigen's solver wants: residuals and their slopes.
class Functor {
 public:
  using Scalar = double;
  using InputType = VectorXd;
  using ValueType = VectorXd;
  using JacobianType = MatrixXd;
  // NOLINTNEXTLINE(readability-identifier-naming): Eigen's names
  enum { InputsAtCompileTime = Eigen::Dynamic, ValuesAtCompileTime = Eigen::Dynamic };

  explicit Functor(const SearchProblem& problem) : problem_(problem), inside_(problem.low.size()) {}

  Index inputs() const { return static_cast<Index>(problem_.low.size()); }
  Index values() const { return static_cast<Index>(problem_.residuals) + inputs(); }
  int evaluations() const { return evaluations_; }

  int operator()(const VectorXd& x, VectorXd& r) const {
    evaluate(x, r);
    return 0;
  }

  int df(const VectorXd& x, MatrixXd& slope) const {
    VectorXd ahead(values()), behind(values()), moved = x;
    for (Index i = 0; i < inputs(); ++i) {
      const double h = problem_.difference;
      moved[i] = x[i] + h;
      const bool can_ahead = evaluate(moved, ahead);
      moved[i] = x[i] - h;
      const bool can_behind = evaluate(moved, behind);
      moved[i] = x[i];
      slope.col(i).setZero();  // at the edge of what makes a law, this unknown rests
      if (can_ahead && can_behind) slope.col(i) = (ahead - behind) / (2.0 * h);
    }
    return 0;
  }

  const std::vector<double>& clamp(const VectorXd& x) const {
    for (Index i = 0; i < inputs(); ++i)
      inside_[at(i)] = std::clamp(x[i], problem_.low[at(i)], problem_.high[at(i)]);
    return inside_;
  }

 private:
  bool evaluate(const VectorXd& x, VectorXd& r) const {
    ++evaluations_;
    clamp(x);
    for (Index i = 0; i < inputs(); ++i)
      r[values() - inputs() + i] = kOutOfBounds * (x[i] - inside_[at(i)]);
    const bool is_law =
        !program::is_interrupted() && problem_.residual(inside_, {r.data(), problem_.residuals});
    if (!is_law || !r.allFinite()) r.head(values() - inputs()).setConstant(kNoLaw);
    return is_law && r.allFinite();
  }

  const SearchProblem& problem_;
  mutable std::vector<double> inside_;
  mutable int evaluations_ = 0;
};

}  // namespace

SearchResult search(const SearchProblem& problem, const std::vector<double>& start) {
  Functor functor(problem);
  Eigen::LevenbergMarquardt<Functor> solver(functor);
  // A millionth of a logarithm is far below what data can resolve; tighter only takes time.
  solver.parameters.xtol = 1e-6;
  solver.parameters.ftol = 1e-7;
  // the solver does not count the slopes: two evaluations an unknown
  solver.parameters.maxfev =
      std::max(2, problem.most_evaluations / (1 + 2 * static_cast<int>(functor.inputs())));
  VectorXd x = Eigen::Map<const VectorXd>(start.data(), functor.inputs());
  solver.minimize(x);
  VectorXd r(functor.values());
  // The result lies within the bounds, and its residual is its own.
  x = Eigen::Map<const VectorXd>(functor.clamp(x).data(), functor.inputs());
  functor(x, r);
  return {.x = {x.data(), x.data() + x.size()},
          .sum_of_squares = r.squaredNorm(),
          .evaluations = functor.evaluations()};
}

}  // namespace tact::tools::fit
