// SPDX-License-Identifier: Apache-2.0
#include "tools/reference/press/active_set.h"

#include <Eigen/Cholesky>
#include <vector>

namespace tact::tools::reference {
namespace {

using model::Error;
using model::Result;

constexpr int kTimeout = 10;             // rounds of many that may make it no better
constexpr Eigen::Index kMaxPivots = 50;  // times the unknowns
constexpr double kZero = 1e-10;          // of the largest pressure or overlap

const Error kNotDefinite{
    "the compliance of the patch is not positive definite; ask for another mesh level"};

class ActiveSet {
 public:
  ActiveSet(const Eigen::MatrixXd& compliance, const Eigen::VectorXd& overlap)
      : compliance_(compliance),
        overlap_(overlap),
        in_contact_(static_cast<std::size_t>(overlap.size())),
        pressure_(Eigen::VectorXd::Zero(overlap.size())) {
    // To begin with, all that would overlap touches.
    for (Eigen::Index i = 0; i < overlap.size(); ++i) set(i, overlap[i] > 0.0);
  }

  /// Pressures that close the gap wherever it touches; false if C is not definite.
  bool solve() {
    std::vector<Eigen::Index> in;
    for (Eigen::Index i = 0; i < overlap_.size(); ++i)
      if (is_in_contact(i)) in.push_back(i);
    pressure_.setZero();
    residual_ = -overlap_;
    if (in.empty()) return true;
    const Eigen::MatrixXd inside = compliance_(in, in);
    const Eigen::LLT<Eigen::MatrixXd> factor(inside);
    if (factor.info() != Eigen::Success) return false;
    const Eigen::VectorXd wanted = overlap_(in);
    const Eigen::VectorXd found = factor.solve(wanted);
    pressure_(in) = found;
    residual_ = compliance_ * pressure_ - overlap_;
    return true;
  }

  /// What pulls, and what lies inside without touching.
  std::vector<Eigen::Index> wrong() const {
    // Rounding of a pressure that is zero must not flip it for ever.
    const double least_Pa = -kZero * pressure_.lpNorm<Eigen::Infinity>();
    const double least_m = -kZero * overlap_.lpNorm<Eigen::Infinity>();
    std::vector<Eigen::Index> out;
    for (Eigen::Index i = 0; i < overlap_.size(); ++i)
      if (is_in_contact(i) ? pressure_[i] < least_Pa : residual_[i] < least_m) out.push_back(i);
    return out;
  }

  void flip(Eigen::Index i) { set(i, !is_in_contact(i)); }
  const Eigen::VectorXd& pressure() const { return pressure_; }

 private:
  bool is_in_contact(Eigen::Index i) const { return in_contact_[static_cast<std::size_t>(i)]; }
  void set(Eigen::Index i, bool yes) { in_contact_[static_cast<std::size_t>(i)] = yes; }

  const Eigen::MatrixXd& compliance_;
  const Eigen::VectorXd& overlap_;
  std::vector<bool> in_contact_;
  Eigen::VectorXd pressure_, residual_;
};

}  // namespace

Result<Eigen::VectorXd> solve_contact(const Eigen::MatrixXd& compliance,
                                      const Eigen::VectorXd& overlap) {
  ActiveSet set(compliance, overlap);
  std::size_t fewest = static_cast<std::size_t>(overlap.size()) + 1;
  int timeout = kTimeout;
  for (Eigen::Index round = 0; round <= kMaxPivots * overlap.size(); ++round) {
    if (!set.solve()) return kNotDefinite;
    const std::vector<Eigen::Index> wrong = set.wrong();
    if (wrong.empty()) return set.pressure();
    if (wrong.size() < fewest) {
      fewest = wrong.size();
      timeout = kTimeout;
    } else {
      --timeout;
    }
    if (timeout > 0)
      for (const Eigen::Index i : wrong) set.flip(i);
    else
      // Always the largest number: a fixed order cannot turn in a circle.
      set.flip(wrong.back());
  }
  return kNotDefinite;
}

}  // namespace tact::tools::reference
