// SPDX-License-Identifier: Apache-2.0
// linear_pull.h - any law in press, one linear spring in pull.
//
//     d >= 0: as the law;      d < 0: F = k d,  U = k d^2 / 2,  down to the pull limit
//
// A gripped contact point is a bonded patch: in linear elasticity its force is exactly linear for
// any law in press (RF-2), and a law made for press needs no model of pull.
// k N/m, depths m, press positive. Profile in pull: the law's own at |d|, mirrored.
#pragma once

#include "model/law/law.h"
#include "model/parameters.h"
#include "model/result.h"

namespace tact::model::law {

struct LinearPullParameters {
  double stiffness_N_per_m = 0.0;  // k, > 0
  double limit_m = 0.0;            // largest pull, > 0; beyond, the force stays
};
void visit(ParameterVisitor& v, LinearPullParameters& p);

class LinearPull final : public Law {
 public:
  LawResponse respond(double depth_m) const RT_SAFE override;
  double damping_Ns_per_m(double depth_m) const RT_SAFE override {
    return press_->damping_Ns_per_m(depth_m);
  }
  LawRange range() const RT_SAFE override { return {-pull_.limit_m, press_->range().press_m}; }
  std::size_t profile(double depth_m, std::span<double> ring_m) const RT_SAFE override;
  double ring_pitch_m() const RT_SAFE override { return press_->ring_pitch_m(); }

 private:
  friend Result<LinearPull> make_linear_pull(const Law&, const LinearPullParameters&);
  LinearPull(const Law& press, const LinearPullParameters& pull) : press_(&press), pull_(pull) {}

  const Law* press_;
  LinearPullParameters pull_;
};

/// `press` outlives it.
Result<LinearPull> make_linear_pull(const Law& press, const LinearPullParameters& pull);

}  // namespace tact::model::law
