// SPDX-License-Identifier: Apache-2.0
// table_law.h - a force that was measured over depth, as a law: the least squares of its stiffness.
//
//     TB-1   K(d) = sum k_j h_j(d),  k_j > 0        F = integral of K,  U = integral of F, from 0
//     TB-2   k_j: least sum ((F(d_i) - F_i) / max(F, F_0))^2      F_0 = 0.3 % of the peak
//
//     h_j  hat of knot j: 1 there, 0 at its neighbours      d_j = d_max (j / n)^2, n = 13 at most
//     K    stiffness, N/m   F  force, N   U  energy, J      d_i, F_i  the rows, m, N
//
// K is linear between the knots, so F rises by quadratics without a corner, and U is the exact
// integral: passive for any measured values. The knots are dense at small depth, where errors weigh
// as shares of the force. What is no loading of a passive body is refused, with its row.
// Valid to the deepest row; beyond, the force stays. It cannot pull. It holds for the tip that it
// was measured with.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "model/law/law.h"
#include "model/parameters.h"
#include "model/result.h"

namespace tact::model::indent {

/// What a scene says of it: [table].
struct TableParameters {
  std::string data{};             // absolute path of a CSV file: model/scene/table_file.h
  double force_ratio = 1.0;       // times what was measured
  bool leaves_unloading = false;  // out; else a file that has it is refused
};
void visit(ParameterVisitor& v, TableParameters& p);

struct TableRow {
  int line = 0;  // of the file, for errors
  double depth_m = 0.0, force_N = 0.0;
};

class TableLaw final : public law::Law {
 public:
  static constexpr std::size_t kMaxKnots = 14;

  law::LawResponse respond(double depth_m) const RT_SAFE override;
  law::LawRange range() const RT_SAFE override { return {.pull_m = 0.0, .press_m = end_m()}; }
  std::size_t profile(double depth_m, std::span<double> ring_m) const RT_SAFE override;
  double ring_pitch_m() const RT_SAFE override { return end_m(); }
  /// Share of the work that the unloading, if it was measured, did not give back.
  double lost_ratio() const { return lost_ratio_; }

 private:
  friend Result<TableLaw> make_table_law(std::span<const TableRow>, const TableParameters&);
  struct Knot {
    double depth_m = 0.0, stiffness_N_per_m = 0.0, force_N = 0.0, energy_J = 0.0;
  };
  TableLaw() = default;
  void fit(std::span<const TableRow> loading, double force_ratio);
  void set_stiffness(std::span<const TableRow> loading, std::span<const double> scale_N,
                     double force_ratio);
  static law::LawResponse between(const Knot& low, const Knot& high, double depth_m) RT_SAFE;
  double end_m() const RT_SAFE { return knot_[count_ - 1].depth_m; }

  std::array<Knot, kMaxKnots> knot_{};
  std::size_t count_ = kMaxKnots;
  double lost_ratio_ = 0.0;
};

/// Rows in the order of the measurement. An error goes behind the file's name: ":7: what; REMEDY".
Result<TableLaw> make_table_law(std::span<const TableRow> rows, const TableParameters& parameters);

}  // namespace tact::model::indent
