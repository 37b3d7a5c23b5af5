// SPDX-License-Identifier: Apache-2.0
// disc_stack.h - discs under the contact that flatten one after the other (DS-6 to DS-10).
//
//     DS-7   t_i = q^(i-1) t1,  T_i = t_1 + .. + t_i        modelled delay of layer i, s
//     DS-8   i_max = number of layers with T_i < 1/rate, at most the cap
//     DS-9   force in:  M = ceil(F/(k h0)),  M - 1 layers flat;  depth = (M - 1) h0 + h_M
//     DS-10  depth in:  j = ceil(d/h0) - 1 flat layers,  s = d - j h0,
//                       F = j k h0 + f(s),  f as in disc.h
//
// Depths in m, forces in N, press positive. It cannot pull: no contact at d <= 0. Valid to
// i_max h0; beyond, the force stays at i_max k h0 and truncated_by() says why. Closed form, O(1):
// the loop calls it directly.
//
// Properties (X8 .. X13): in the linear form F = k d for any h0, t1, q and rate. In the
// Almen-Laszlo form the stiffness jumps at every layer by the factor
// (1 + eta^2)/(1 - eta^2/2), 1.26 at eta = 0.4, which a hand can feel as a texture. The delays are
// a model, not computing time: choose them so that the working depth stays within i_max h0.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "model/indent/disc.h"
#include "model/law/law.h"
#include "model/result.h"

namespace tact::model::indent {

inline constexpr std::size_t kMaxLayers = 64;

/// What limits the number of layers.
enum class TruncatedBy : std::uint8_t { kTimeBudget, kLayerCap };

struct LayerDelays {
  double first_delay_s = 0.0;    // t1, > 0
  double delay_ratio = 1.0;      // q, > 0
  double refresh_rate_Hz = 0.0;  // > 0; no layer moves later than 1/rate
  std::size_t layers = 0;        // cap, 1 .. kMaxLayers
};
void visit(ParameterVisitor& v, LayerDelays& p);

/// In the order of DiscForm.
inline constexpr std::array kDiscForms{
    Choice{"almen-laszlo", "the disc as it is: stiffness jumps at every layer"},
    Choice{"linear", "its secant: one linear spring"},
};
static_assert(kDiscForms.size() == static_cast<std::size_t>(DiscForm::kLinear) + 1);

/// Its name in a scene.
constexpr std::string_view name_of(DiscForm form) {
  return kDiscForms[static_cast<std::size_t>(form)].name;
}

struct DiscStackParameters {
  DiscDimensions disc;
  DiscForm form = DiscForm::kAlmenLaszlo;
  LayerDelays delays;
};
void visit(ParameterVisitor& v, DiscStackParameters& p);

/// The stack in equilibrium.
struct DiscStackState {
  double force_N = 0.0;  // that it supports
  double depth_m = 0.0;  // at most i_max h0
  double energy_J = 0.0;
  double stiffness_N_per_m = 0.0;
  std::size_t moving_layers = 0;     // M
  double last_flattening_m = 0.0;    // h_M, of the cut-off layer
  double unsupported_force_N = 0.0;  // force in: the part beyond the limit
  law::LawStatus status = law::LawStatus::kOk;
};

class DiscStack final : public law::Law {
 public:
  DiscStackState at_force(double force_N) const RT_SAFE;  // DS-9
  DiscStackState at_depth(double depth_m) const RT_SAFE;  // DS-10

  law::LawResponse respond(double depth_m) const RT_SAFE override;
  law::LawRange range() const RT_SAFE override {
    return {.pull_m = 0.0, .press_m = depth_limit_m()};
  }
  /// u_j = depth minus the first j layers, at radius j D/2 by our choice: the source has layers in
  /// depth only (LW-2).
  std::size_t profile(double depth_m, std::span<double> ring_m) const RT_SAFE override;
  double ring_pitch_m() const RT_SAFE override { return 0.5 * disc_.outer_diameter_m; }

  const Disc& disc() const RT_SAFE { return disc_; }
  std::size_t layer_count() const RT_SAFE { return layers_; }  // i_max
  TruncatedBy truncated_by() const RT_SAFE { return truncated_by_; }
  double depth_limit_m() const RT_SAFE { return static_cast<double>(layers_) * disc_.travel_m; }
  double force_limit_N() const RT_SAFE {
    return static_cast<double>(layers_) * disc_.flat_force_N();
  }

 private:
  friend Result<DiscStack> make_disc_stack(const Disc&, DiscForm, const LayerDelays&);
  DiscStack() = default;
  DiscStackState with_flat_layers(std::size_t flat, double flattening_m) const RT_SAFE;
  DiscStackState at_limit() const RT_SAFE;

  Disc disc_;
  DiscForm form_ = DiscForm::kAlmenLaszlo;
  std::size_t layers_ = 0;
  TruncatedBy truncated_by_ = TruncatedBy::kLayerCap;
};

/// T_i of DS-7, s; 0 for i = 0.
double delay_through_layer_s(const LayerDelays& delays, std::size_t layer);
/// i_max of DS-8; 0: no layer may move.
std::size_t layer_budget(const LayerDelays& delays);

/// The error names the parameter and what is allowed.
Result<DiscStack> make_disc_stack(const DiscStackParameters& parameters);
/// From a tissue's stiffness and the travel of a layer instead of dimensions.
Result<DiscStack> make_disc_stack(const Disc& disc, DiscForm form, const LayerDelays& delays);

}  // namespace tact::model::indent
