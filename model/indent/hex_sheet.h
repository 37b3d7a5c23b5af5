// SPDX-License-Identifier: Apache-2.0
// hex_sheet.h - a sheet of hexagonal rings of surface springs on body springs, from its energy.
//
// The contact node has w_0 = d, the boundary w_m = 0; the displacements w_i, m, of all other rings
// minimise the stored energy:
//
//     HX-20  U = K_N0 d^2/2 + sum W_i K_N w_i^2/2 + sum n_i (K_T e_i^2/2 + T0 e_i)
//            l_i = w_(i-1) - w_i,  s_i = sqrt(r^2 + l_i^2),  e_i = s_i - r = l_i^2/(s_i + r)
//            n_i = 6 (2i - 1) springs between rings i-1 and i
//            W_i = 6 i (one body spring per node) or 1 (one per ring)
//     HX-21  p(l) = (K_T e + T0) l/s,   p'(l) = K_T l^2/s^2 + (K_T e + T0) r^2/s^3
//     HX-22  W_i K_N w_i + n_(i+1) p(l_(i+1)) - n_i p(l_i) = 0
//     HX-23  F = dU/dd = K_N0 d + 6 p(l_1)
//     HX-24  Newton with a tridiagonal slope, from w_i = d (1 - i/m)^3
//
//     r   ring pitch, m        K_N0, K_N   body springs at the contact node and elsewhere, N/m
//     m   rings                K_T, T0     surface springs, N/m, and their tension at rest, N
//
// U is strictly convex for K_N > 0: one solution, force and stiffness grow with depth. F(-d) =
// -F(d): a held surface can be pulled. Without tension a small indentation is a spike one node wide
// (HX-25); its decay length with tension is sqrt(2 T0 r/K_N) (per node). Valid within the working
// depth; beyond, the force stays. The solution is a bounded iteration, good for set-up, tools and
// telemetry; the loop reads a table of it (tabulated_law.h).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "model/law/law.h"
#include "model/parameters.h"
#include "model/result.h"

namespace tact::model::indent {

inline constexpr std::size_t kMaxHexRings = 31;  // with the contact node, what telemetry shows

enum class HexWeight : std::uint8_t {
  kNode,  // a body spring per node: W_i = 6 i, an elastic foundation
  kRing,  // a body spring per ring: W_i = 1
};

struct HexSheetParameters {
  double ring_pitch_m = 0.0;               // r, > 0
  double contact_stiffness_N_per_m = 0.0;  // K_N0, >= 0
  double body_stiffness_N_per_m = 0.0;     // K_N, > 0
  double surface_stiffness_N_per_m = 0.0;  // K_T, >= 0
  double tension_N = 0.0;                  // T0, >= 0
  std::size_t rings = 0;                   // m, 1 .. kMaxHexRings
  HexWeight weight = HexWeight::kNode;
  double working_depth_m = 0.0;  // > 0
};
/// With rings 0: as few as a tolerance allows (rings_for_tolerance).
void visit(ParameterVisitor& v, HexSheetParameters& p);

/// The sheet in equilibrium.
struct HexSheetState {
  double force_N = 0.0;
  double stiffness_N_per_m = 0.0;
  double energy_J = 0.0;
  double boundary_force_N = 0.0;  // n_m p(l_m), reaction at the boundary
  int iterations = 0;
  std::array<double, kMaxHexRings + 1> ring_m{};  // w_i, m + 1 used
  law::LawStatus status = law::LawStatus::kOk;
};

class HexSheet final : public law::Law {
 public:
  /// Beyond the working depth: the state at the working depth, kSaturated.
  HexSheetState at_depth(double depth_m) const RT_SAFE;

  law::LawResponse respond(double depth_m) const RT_SAFE override;
  law::LawRange range() const RT_SAFE override { return {-p_.working_depth_m, p_.working_depth_m}; }
  std::size_t profile(double depth_m, std::span<double> ring_m) const RT_SAFE override;
  double ring_pitch_m() const RT_SAFE override { return p_.ring_pitch_m; }
  const HexSheetParameters& parameters() const RT_SAFE { return p_; }

 private:
  friend Result<HexSheet> make_hex_sheet(const HexSheetParameters&);
  explicit HexSheet(const HexSheetParameters& parameters) : p_(parameters) {}

  HexSheetParameters p_;
};

/// Checks HX-27; the error names the parameter and what is allowed.
Result<HexSheet> make_hex_sheet(const HexSheetParameters& parameters);

/// The fewest rings whose force at the working depth is within `tolerance_ratio` of that of a
/// sheet of 255 rings; ignores `parameters.rings`. The error contains the deviation of the largest
/// sheet.
Result<std::size_t> rings_for_tolerance(const HexSheetParameters& parameters,
                                        double tolerance_ratio);

}  // namespace tact::model::indent
