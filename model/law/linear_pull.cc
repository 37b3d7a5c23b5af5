// SPDX-License-Identifier: Apache-2.0
#include "model/law/linear_pull.h"

#include <algorithm>
#include <cmath>

namespace tact::model::law {

LawResponse LinearPull::respond(double depth_m) const RT_SAFE {
  // NaN goes to the press, which answers kInvalid.
  if (!(depth_m < 0.0) || !std::isfinite(depth_m)) return press_->respond(depth_m);
  const double k = pull_.stiffness_N_per_m;
  if (depth_m >= -pull_.limit_m) return {k * depth_m, k, 0.5 * k * depth_m * depth_m};
  const double limit_N = k * pull_.limit_m;
  // U = k L^2 / 2 up to the limit L, then the constant force goes on storing: k L (|d| - L / 2).
  return {-limit_N, 0.0, limit_N * (-depth_m - 0.5 * pull_.limit_m), LawStatus::kSaturated};
}

std::size_t LinearPull::profile(double depth_m, std::span<double> ring_m) const RT_SAFE {
  if (!(depth_m < 0.0)) return press_->profile(depth_m, ring_m);
  // [pull] says nothing of a shape: drawn is the press of the same depth, turned outward.
  const std::size_t count = press_->profile(-depth_m, ring_m);
  for (double& u_m : ring_m.first(std::min(count, ring_m.size()))) u_m = -u_m;
  return count;
}

void visit(ParameterVisitor& v, LinearPullParameters& p) {
  v.number("stiffness_N_per_m", {0.01, 1e5}, "of a held sphere pulled outward",
           p.stiffness_N_per_m);
  v.number("limit_m", kDepth_m, "beyond it the force stays", p.limit_m);
}

Result<LinearPull> make_linear_pull(const Law& press, const LinearPullParameters& pull) {
  if (auto wrong = check_meaning("pull", pull)) return *wrong;
  return LinearPull(press, pull);
}

}  // namespace tact::model::law
