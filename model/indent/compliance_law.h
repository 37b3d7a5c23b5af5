// SPDX-License-Identifier: Apache-2.0
// compliance_law.h - a linear elastic organ under a round tip at one surface point: two springs in
// series.
//
//     CL-1   d = d_tip(F) + r F         press: indentation by the sphere alone, CT-1 and CT-2
//     CL-2   d = (c_disc + r) F         pull: a bonded disc of the sphere's radius, CT-5
//     CL-3   1/K = 1/K_tip + r          K_tip from CT-3 or CT-9 in press, 1/c_disc in pull
//     CL-4   u_j = taper_j (u_tip(rho_j) + F g_j),  u_0 = d,  0 <= u_j <= u_(j-1)
//
//     r     compliance of the organ at this surface point minus that of a half-space, m/N: positive
//           where a thin lobe bends, negative near the fixed boundary (source: compliance_map.h)
//     g_j   the same for the surface at radius j pitch, m/N; g_0 = r
//
// The load is always the contact patch of the tip: the displacement under a point force would be
// unbounded, or depend on the mesh. With tip.large_strain the indentation is that of CT-8, within
// 0.9 % of every finite-strain sphere of RF-7, up to a depth of 2.15 R. Otherwise strain is small:
// a block under a sphere of R = 5 mm is 14 % softer at 10 mm than this law (RF-1). r and pull are
// always linear. At d = 0 the slope jumps from that of pull to zero; `stiffness` is the mean of
// both. respond() is a table in press and a product in pull: the loop may call it, also at large
// strain. exact() solves CL-1.
#pragma once

#include <array>
#include <span>

#include "model/indent/compliance_tip.h"
#include "model/law/hermite_table.h"
#include "model/law/law.h"
#include "model/result.h"

namespace tact::model::indent {

inline constexpr std::size_t kMaxComplianceRings = 31;

struct ComplianceCurveParameters {
  ElasticTip tip;
  double regular_m_per_N = 0.0;          // r, > -1 / (largest K_tip) and > -c_disc
  double working_depth_m = 0.0;          // press and pull, > 0
  double pull_depth_m = 0.0;             // where the range of a pull is another; 0: as press
  double ring_pitch_m = 0.0;             // > 0
  std::span<const double> ring_m_per_N;  // g_1 .. g_N, 1 to kMaxComplianceRings; read once
  std::size_t table_knots = 65;          // in press
};

class ComplianceCurve final : public law::Law {
 public:
  law::LawResponse respond(double depth_m) const RT_SAFE override;
  law::LawRange range() const RT_SAFE override { return {-pull_depth_m_, press_depth_m_}; }
  std::size_t profile(double depth_m, std::span<double> ring_m) const RT_SAFE override;
  double ring_pitch_m() const RT_SAFE override { return ring_pitch_m_; }

  /// CL-1 by bounded bisection and Newton; depth_m >= 0. For set-up, tools and telemetry.
  TipState exact(double depth_m) const RT_SAFE;
  std::size_t memory_bytes() const { return sizeof *this + press_.memory_bytes(); }
  double regular_m_per_N() const RT_SAFE { return regular_m_per_N_; }
  double pulled_stiffness_N_per_m() const RT_SAFE { return pulled_N_per_m_; }  // 1 / (c_disc + r)

 private:
  friend Result<ComplianceCurve> make_compliance_curve(const ComplianceCurveParameters&);
  ComplianceCurve() = default;

  ElasticTip tip_;
  double regular_m_per_N_ = 0.0;
  double pulled_N_per_m_ = 0.0;
  double pull_depth_m_ = 0.0;
  double press_depth_m_ = 0.0;  // at most working_depth_m
  double ring_pitch_m_ = 0.0;
  std::size_t rings_ = 0;                                       // N
  std::array<double, kMaxComplianceRings + 1> ring_m_per_N_{};  // g_0 .. g_N
  law::HermiteTable press_;
};

/// The error names the parameter and what is allowed.
Result<ComplianceCurve> make_compliance_curve(const ComplianceCurveParameters& parameters);

/// A half-space of E* = 1 Pa under a ball: the indentation profile for laws of springs.
Result<ComplianceCurve> half_space_under(double radius_m, double working_depth_m);
/// The same with a given number of rings, 1 to kMaxComplianceRings.
Result<ComplianceCurve> half_space_under(double radius_m, double working_depth_m,
                                         double ring_pitch_m, std::size_t rings);

}  // namespace tact::model::indent
