// SPDX-License-Identifier: Apache-2.0
// hex_paper.h - the hexagonal surface as its source prints it, for comparison and no more.
//
//     HX-10  alpha_i eps_i/(1 + eps_i) = c for all rings,  alpha_i = 2i - 1,  c = eps_1/(1 + eps_1)
//     HX-8   eps_i = c/(alpha_i - c)
//     HX-9   l_i = r sqrt(eps_i (2 + eps_i)) = r sqrt(c (2 alpha_i - c))/(alpha_i - c)
//     HX-6   Z_j = sum of l_i, i > j;   Z_0 = d,  Z_m = 0
//     HX-11  depth in: the c with sum l_i = d
//     HX-12  F = K_N sum W_j Z_j,  W_0 = 1,  W_j = 1 (one body spring per ring) or 6 j (per node)
//     HX-13  m = (1 + alpha_m)/2,  alpha_m = c (1 + eps_m)/eps_m,  eps_m = sqrt(1 + b^2) - 1
//
//     eps_i  strain of a surface spring of ring i     r    ring pitch, m
//     l_i    drop from ring i-1 to ring i, m          K_N  body spring, N/m
//     Z_j    displacement of ring j, m                b    l_m/r, slope at the rim
//
// What is wrong with it (X14, X15): horizontal balance alone fixes the shape, so vertical
// balance cannot hold with equal body springs, and the force grows without limit with m instead of
// converging. Yet F depends on d alone, so no stroke makes energy: the law here is a table of HX-12
// over the depth whose exact integral is the energy. No scene can
// choose it. Pulled, it is its own mirror image. The source's 50 N/m and 2
// mm are meant for one body spring per ring: per node they reach 3.3 N at 0.165 mm.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "model/indent/hex_sheet.h"
#include "model/law/hermite_table.h"

namespace tact::tools::printed {

using model::Result;
using model::indent::HexWeight;
using model::law::Law;
using model::law::LawRange;
using model::law::LawResponse;
using model::law::LawStatus;

inline constexpr std::size_t kMaxPaperRings = 64;

/// The printed shape. rings = 0: there is none for this input.
struct PaperShape {
  std::size_t rings = 0;
  double first_strain = 0.0;                        // eps_1
  double boundary_slope = 0.0;                      // l_m/r
  std::array<double, kMaxPaperRings> strain{};      // eps_i, ring 1 first
  std::array<double, kMaxPaperRings> drop_m{};      // l_i, ring 1 first
  std::array<double, kMaxPaperRings + 1> ring_m{};  // Z_j
};

/// HX-8, HX-9, HX-6 from the strain of the first spring, >= 0.
PaperShape paper_shape_at_strain(double pitch_m, std::size_t rings, double first_strain) RT_SAFE;
/// HX-11, depth >= 0.
PaperShape paper_shape_at_depth(double pitch_m, std::size_t rings, double depth_m) RT_SAFE;
/// HX-12, N: F = K_N sum W_j Z_j.
double paper_force_N(const PaperShape& shape, double stiffness_N_per_m, HexWeight weight) RT_SAFE;

/// HX-13: how many rings a rim slope asks for. kSaturated: less than one, take one; kInvalid: no
/// finite number.
struct PaperRings {
  double exact = 0.0;
  std::size_t rings = 0;
  LawStatus status = LawStatus::kOk;
};
PaperRings paper_rings(double first_strain, double boundary_slope) RT_SAFE;

struct HexPaperParameters {
  double ring_pitch_m = 0.0;            // r, > 0
  double body_stiffness_N_per_m = 0.0;  // K_N, > 0, the same everywhere
  std::size_t rings = 0;                // m, 1 .. kMaxHexRings
  HexWeight weight = HexWeight::kRing;
  double working_depth_m = 0.0;  // > 0
};

class HexPaper final : public Law {
 public:
  LawResponse respond(double depth_m) const RT_SAFE override;
  LawRange range() const RT_SAFE override { return {-p_.working_depth_m, p_.working_depth_m}; }
  /// Solved directly, not from a table: for telemetry and tools, outside the loop.
  std::size_t profile(double depth_m, std::span<double> ring_m) const RT_SAFE override;
  double ring_pitch_m() const RT_SAFE override { return p_.ring_pitch_m; }

 private:
  friend Result<HexPaper> make_hex_paper(const HexPaperParameters&);
  explicit HexPaper(const HexPaperParameters& parameters);

  HexPaperParameters p_;
  model::law::HermiteTable table_;
};

/// The error names the parameter and what is allowed.
Result<HexPaper> make_hex_paper(const HexPaperParameters& parameters);

}  // namespace tact::tools::printed
