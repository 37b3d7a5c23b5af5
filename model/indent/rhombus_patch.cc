// SPDX-License-Identifier: Apache-2.0
#include "model/indent/rhombus_patch.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "model/ranges.h"

namespace tact::model::indent {
namespace {

// Both chosen. kRings: of its own displacements, which tact-lab fit compares (LW-2).
// kTabulatedRange_ratio: beyond the limit of one chain those in the middle keep their force, while
// those at the rim still press.
constexpr std::size_t kRings = 24;
constexpr double kTabulatedRange_ratio = 2.0;  // of the chain's range

}  // namespace

// press_ comes last of the members: its curve reads the chain and the factor.
RhombusPatch::RhombusPatch(const RhombusChain& chain, const RhombusPatchParameters& p)
    : chain_(chain),
      tip_radius_m_(p.tip_radius_m),
      chains_per_m_(2.0 * std::numbers::pi * p.tip_radius_m / p.area_m2),
      press_(kTabulatedRange_ratio * chain.range().press_m / (law::kMaxKnots - 1), law::kMaxKnots,
             [this](double depth_m) RT_SAFE { return under_tip(depth_m); }) {
  ring_pitch_m_ = std::sqrt(2.0 * p.tip_radius_m * press_.end()) / kRings;
}

// RC-15, RC-16
law::CurvePoint RhombusPatch::under_tip(double depth_m) const RT_SAFE {
  const law::LawResponse one = chain_.respond(depth_m);
  return {.value = chains_per_m_ * one.energy_J, .slope = chains_per_m_ * one.force_N};
}

law::LawResponse RhombusPatch::respond(double depth_m) const RT_SAFE {
  return law::press_response(depth_m, press_.end(), [this](double inside_m) RT_SAFE {
    // F and K are closed forms of the chain; U is the integral that only the table has.
    const law::CurvePoint at = under_tip(inside_m);
    return law::LawResponse{.force_N = at.value,
                            .stiffness_N_per_m = at.slope,
                            .energy_J = press_.at(inside_m).integral};
  });
}

std::size_t RhombusPatch::profile(double depth_m, std::span<double> ring_m) const RT_SAFE {
  const double d_m = depth_m > 0.0 ? depth_m : 0.0;
  const std::size_t count = std::min(kRings + 1, ring_m.size());
  for (std::size_t j = 0; j < count; ++j) {
    const double r_m = static_cast<double>(j) * ring_pitch_m_;
    // RC-17  w(r) = d - r^2/(2R) within sqrt(2 R d), 0 beyond
    const double w_m = d_m - r_m * r_m / (2.0 * tip_radius_m_);
    ring_m[j] = j < kRings ? std::fmax(w_m, 0.0) : 0.0;
  }
  return count;
}

void visit(ParameterVisitor& v, RhombusParameters& p) {
  visit(v, p.chain);
  v.number("area_m2", {0.0, 0.01},
           "of the surface under one chain; 0: one chain under the whole tip", p.area_m2,
           Need::kOptional);
}

Result<RhombusPatch> make_rhombus_patch(const RhombusChain& chain,
                                        const RhombusPatchParameters& p) {
  if (!is_positive(p.tip_radius_m) || !is_positive(p.area_m2))
    return Error{"rhombus patch: the tip's radius and area_m2 must be finite and above 0"};
  return RhombusPatch(chain, p);
}

}  // namespace tact::model::indent
