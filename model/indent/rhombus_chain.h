// SPDX-License-Identifier: Apache-2.0
// rhombus_chain.h - the parallel rhombus-chain law in its energy-consistent form.
//
// N rhombus units (rhombus_unit.h) in series; deeper units have stiffer tangential springs:
//
//     RC-8   kT_i = kT1 exp((i - 1) / beta),  kN_i = kN
//     RC-9   every unit carries the same F:  f_i(x_i) = F,  depth = sum x_i,  U = sum U_i,
//            K = 1 / sum (1 / k_i)
//     RC-10  depth in: the F with depth(F) = d
//     RC-11  u_j = sum of x_i, i > j              profile
//
// Depths in m, forces in N, press positive. The chain saturates at the force limit of its weakest
// unit. In pull its stiffness grows without limit towards straight rods. In press it softens: keep
// the working depth below about 0.6 of range().press_m. The solution is a bounded Newton iteration,
// for set-up, tools and telemetry; the loop reads a table of it (tabulated_law.h).
#pragma once

#include <array>
#include <cstddef>

#include "model/indent/rhombus_unit.h"
#include "model/parameters.h"
#include "model/result.h"

namespace tact::model::indent {

inline constexpr std::size_t kMaxUnits = 64;

struct RhombusChainParameters {
  double rod_length_m = 0.0;                  // a
  double initial_angle_rad = 0.0;             // theta0
  double normal_stiffness_N_per_m = 0.0;      // kN
  double tangential_stiffness_N_per_m = 0.0;  // kT1
  double growth = 0.0;                        // beta
  std::size_t units = 0;                      // N
};
void visit(ParameterVisitor& v, RhombusChainParameters& p);

/// The chain in equilibrium.
struct ChainState {
  double force_N = 0.0;
  double depth_m = 0.0;
  double energy_J = 0.0;
  double stiffness_N_per_m = 0.0;
  std::array<double, kMaxUnits> shortening_m{};  // x_i, N used
  law::LawStatus status = law::LawStatus::kOk;
};

class RhombusChain final : public law::Law {
 public:
  /// F in, depth out (RC-9). Beyond the limit the force is clamped, kSaturated.
  ChainState at_force(double force_N) const RT_SAFE;
  /// Depth in, F out (RC-10). At or beyond straight rods: kSingular, zero force.
  ChainState at_depth(double depth_m) const RT_SAFE;

  law::LawResponse respond(double depth_m) const RT_SAFE override;
  /// Press to the saturation depth; pull to the depth where the force is the negative of its limit.
  law::LawRange range() const RT_SAFE override { return range_; }
  std::size_t profile(double depth_m, std::span<double> ring_m) const RT_SAFE override;
  /// Ring j at radius j 2 a cos(theta0), our choice: the source has no lateral geometry (LW-2).
  double ring_pitch_m() const RT_SAFE override { return ring_pitch_m_; }

  std::size_t unit_count() const RT_SAFE { return count_; }
  const RhombusUnit& unit(std::size_t i) const RT_SAFE { return unit_[i]; }
  double force_limit_N() const RT_SAFE { return unit_limit_[weakest_].force_N; }
  std::size_t weakest_unit() const RT_SAFE { return weakest_; }  // counted from 0
  UnitLimit limit_kind() const RT_SAFE { return unit_limit_[weakest_].kind; }

 private:
  friend Result<RhombusChain> make_rhombus_chain(const RhombusChainParameters&);
  RhombusChain() = default;
  ChainState solve_force(double force_N) const RT_SAFE;

  std::array<RhombusUnit, kMaxUnits> unit_{};
  std::array<UnitPressLimit, kMaxUnits> unit_limit_{};
  std::size_t count_ = 0;
  std::size_t weakest_ = 0;
  double straight_m_ = 0.0;  // of the whole chain, < 0
  double ring_pitch_m_ = 0.0;
  law::LawRange range_;
};

/// Checks RC-14; the error names the parameter and what is allowed.
Result<RhombusChain> make_rhombus_chain(const RhombusChainParameters& parameters);

}  // namespace tact::model::indent
