// SPDX-License-Identifier: Apache-2.0
// tabulated_law.h - two Hermite tables, press and pull, of any closed-form law, for the loop.
//
// `knots` knots per table, over [pull limit, 0] and [0, 0.95 press limit]. 65 knots in press
// reproduce the rhombus chain RC-13 within 1e-8 of its force limit (LW-1). Beyond the tables the
// force is that of the last knot, the energy is linear, and the status is kSaturated.
// Damping is linear between the knots of press.
#pragma once

#include <vector>

#include "model/law/hermite_table.h"
#include "model/law/law.h"
#include "model/result.h"

namespace tact::model::law {

class TabulatedLaw final : public Law {
 public:
  LawResponse respond(double depth_m) const RT_SAFE override;
  double damping_Ns_per_m(double depth_m) const RT_SAFE override;
  LawRange range() const RT_SAFE override { return {can_pull_ ? pull_.end() : 0.0, press_.end()}; }
  /// Solved directly, not from a table.
  std::size_t profile(double depth_m, std::span<double> ring_m) const RT_SAFE override {
    return source_->profile(depth_m, ring_m);
  }
  std::size_t memory_bytes() const {
    return sizeof *this + press_.memory_bytes() + pull_.memory_bytes();
  }
  double ring_pitch_m() const RT_SAFE override { return source_->ring_pitch_m(); }

 private:
  friend Result<TabulatedLaw> tabulate(const Law&, std::size_t);
  explicit TabulatedLaw(const Law& source) : source_(&source) {}

  const Law* source_;
  HermiteTable press_, pull_;
  bool can_pull_ = false;
  std::vector<double> damping_Ns_per_m_;  // b at the knots of press; empty: none
};

/// `law` must outlive the tables. An error if the force does not grow with depth.
Result<TabulatedLaw> tabulate(const Law& law, std::size_t knots);

}  // namespace tact::model::law
