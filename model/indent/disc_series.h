// SPDX-License-Identifier: Apache-2.0
// disc_series.h - linear disc springs in series: all carry one force, and go flat one after the
// other.
//
//     DS-14  D_i = d_w x_i,  x_i = (D_1 / d_w)^((n-i)/(n-1)),  P_i = F_w x_i^(e + (s/2) ln x_i)
//     DS-15  K_i = (P_i - P_(i-1)) / (D_i - D_(i-1)),   1/k_i = 1/K_i - 1/K_(i+1),  k_n = K_n
//     DS-16  d = sum of min(F, P_i) / k_i,   1/K = sum of 1/k_i over P_i > F
//     DS-17  U = sum of min(F, P_i)^2 / (2 k_i)
//
//     d    depth, m, press positive            F    force, N         K, U  stiffness, energy
//     P_i  force at which disc i is flat, N    D_i  depth then, m    k_i   its stiffness, N/m
//     F_w  force at the depth d_w, N           e, s the exponent is e + s ln(d / d_w)
//
// The source describes discs that go flat one after the other, but its formulas give one spring
// (X8). Here each flat disc leaves a stiffer stack. The stiffnesses are chosen so that the points
// where discs go flat lie on a power law; between them F is the chord, at most 3 % above it for e =
// 1.5 and loads that differ by 2.2. Below D_1, F = K_1 d; beyond d_w the force is constant. K jumps
// where a disc goes flat. It cannot pull.
#pragma once

#include <array>
#include <cstddef>

#include "model/law/law.h"
#include "model/parameters.h"
#include "model/result.h"

namespace tact::model::indent {

inline constexpr std::size_t kMaxDiscs = 31;

struct DiscSeriesParameters {
  double force_N = 0.0;          // F_w
  double working_depth_m = 0.0;  // d_w
  double exponent = 1.5;         // e, above 1
  double exponent_slope = 0.0;   // s
  double first_depth_m = 0.0;    // D_1, below d_w
  std::size_t discs = 0;         // n
};
void visit(ParameterVisitor& v, DiscSeriesParameters& p);

class DiscSeries final : public law::Law {
 public:
  law::LawResponse respond(double depth_m) const RT_SAFE override;
  law::LawRange range() const RT_SAFE override { return {.pull_m = 0.0, .press_m = end_m()}; }
  /// u_j = depth minus the first j discs' share, at radius j D_1 by our choice (LW-2).
  std::size_t profile(double depth_m, std::span<double> ring_m) const RT_SAFE override;
  double ring_pitch_m() const RT_SAFE override { return disc_[0].flat_m; }

  std::size_t size() const RT_SAFE { return size_; }
  double stiffness_N_per_m(std::size_t i) const RT_SAFE { return disc_[i].stiffness_N_per_m; }
  double flat_force_N(std::size_t i) const RT_SAFE { return disc_[i].flat_N; }

 private:
  friend Result<DiscSeries> make_disc_series(const DiscSeriesParameters&);
  DiscSeries() = default;
  double end_m() const RT_SAFE { return disc_[size_ - 1].flat_m; }

  struct Disc {
    double stiffness_N_per_m = 0.0;                      // k_i
    double flat_N = 0.0, flat_m = 0.0;                   // P_i, D_i
    double series_N_per_m = 0.0;                         // K_i, of all that are not flat
    double begin_N = 0.0, begin_m = 0.0, begin_J = 0.0;  // where disc i - 1 goes flat
  };
  std::array<Disc, kMaxDiscs> disc_{};
  std::size_t size_ = 0;
};

/// The error names the parameter and what is allowed.
Result<DiscSeries> make_disc_series(const DiscSeriesParameters& parameters);

}  // namespace tact::model::indent
