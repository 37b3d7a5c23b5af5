// SPDX-License-Identifier: Apache-2.0
#include "model/indent/disc_stack.h"

#include <cmath>
#include <string>

namespace tact::model::indent {

void visit(ParameterVisitor& v, LayerDelays& p) {
  v.number("first_delay_s", {1e-9, 1.0}, "t1: layer i is late by t1 q^(i-1)", p.first_delay_s);
  v.number("delay_growth_ratio", {0.1, 100.0}, "q", p.delay_ratio);
  v.number("refresh_rate_Hz", {1.0, 1e5}, "no layer moves later than its period",
           p.refresh_rate_Hz);
  v.count("layers", {1, 31, false}, "discs at most", p.layers);
}

void visit(ParameterVisitor& v, DiscStackParameters& p) {
  v.choice("form", kDiscForms, "almen-laszlo: stiffness jumps at each layer; linear: one spring",
           p.form);
  visit(v, p.disc);
  visit(v, p.delays);
}

double delay_through_layer_s(const LayerDelays& delays, std::size_t layer) {
  // DS-7  T_i = t1 (1 + q + .. + q^(i-1)): the sum, because its closed form is 0/0 at q = 1
  double delay_s = delays.first_delay_s, total_s = 0.0;
  for (std::size_t i = 0; i < layer; ++i, delay_s *= delays.delay_ratio) total_s += delay_s;
  return total_s;
}

std::size_t layer_budget(const LayerDelays& delays) {
  // DS-8  T_i < 1/rate. Each T_i is summed again: 64 layers at most, at set-up.
  std::size_t count = 0;
  while (count < delays.layers &&
         delay_through_layer_s(delays, count + 1) < 1.0 / delays.refresh_rate_Hz)
    ++count;
  return count;
}

Result<DiscStack> make_disc_stack(const DiscStackParameters& parameters) {
  const auto disc = make_disc(parameters.disc);
  if (!disc) return disc.error();
  return make_disc_stack(*disc, parameters.form, parameters.delays);
}

Result<DiscStack> make_disc_stack(const Disc& disc, DiscForm form, const LayerDelays& delays) {
  const char* wrong = disc_error(disc, form);
  if (wrong != nullptr) return Error{std::string("disc stack: ") + wrong};
  if (auto bad = check_meaning("disc stack", delays)) return *bad;
  static_assert(kMaxLayers == 64);
  if (delays.layers > kMaxLayers) return Error{"disc stack: layers must be 1 .. 64"};
  if (layer_budget(delays) == 0)
    return Error{
        "disc stack: first_delay_s is not below 1 / refresh_rate_Hz, so no layer may move: shorten "
        "it"};
  DiscStack stack;
  stack.disc_ = disc;
  stack.form_ = form;
  stack.layers_ = layer_budget(delays);
  // Both may end at the same layer: then it is the cap, which a scene can raise.
  stack.truncated_by_ =
      stack.layers_ == delays.layers ? TruncatedBy::kLayerCap : TruncatedBy::kTimeBudget;
  return stack;
}

DiscStackState DiscStack::with_flat_layers(std::size_t flat, double flattening_m) const RT_SAFE {
  const double j = static_cast<double>(flat), h0 = disc_.travel_m, flat_N = disc_.flat_force_N();
  const DiscResponse last = model::indent::respond(disc_, form_, flattening_m);
  const DiscResponse full = model::indent::respond(disc_, form_, h0);
  return {// DS-10  F = j k h0 + f(s)
          .force_N = j * flat_N + last.force_N,
          .depth_m = j * h0 + flattening_m,
          // integral of DS-10: j full layers, each carried on the ones before it
          .energy_J = j * full.energy_J + flat_N * j * (0.5 * (j - 1.0) * h0 + flattening_m) +
                      last.energy_J,
          .stiffness_N_per_m = last.stiffness_N_per_m,
          .moving_layers = flat + 1,
          .last_flattening_m = flattening_m};
}

DiscStackState DiscStack::at_limit() const RT_SAFE {
  DiscStackState out = with_flat_layers(layers_ - 1, disc_.travel_m);
  // Sum and product round differently: a stack at its limit gives exactly its limit.
  out.force_N = force_limit_N();
  out.depth_m = depth_limit_m();
  return out;
}

DiscStackState DiscStack::at_force(double force_N) const RT_SAFE {
  if (!std::isfinite(force_N)) return {.status = law::LawStatus::kInvalid};
  if (force_N <= 0.0) return {.status = law::LawStatus::kNoContact};
  if (force_N > force_limit_N()) {
    DiscStackState out = at_limit();
    out.stiffness_N_per_m = 0.0;
    out.unsupported_force_N = force_N - out.force_N;
    out.status = law::LawStatus::kSaturated;
    return out;
  }
  // DS-9  M = ceil(F/(k h0)); a force that is exactly n k h0 needs n layers
  const double flat = std::ceil(force_N / disc_.flat_force_N()) - 1.0;
  // At the limit rounding may ask for one layer more than there is.
  const double most = static_cast<double>(layers_ - 1);
  const double j = flat < most ? flat : most;
  double rest_N = force_N - j * disc_.flat_force_N();
  if (rest_N < 0.0) rest_N = 0.0;  // rounding of the division
  if (rest_N > disc_.flat_force_N()) rest_N = disc_.flat_force_N();
  DiscStackState out =
      with_flat_layers(static_cast<std::size_t>(j), flattening_at_m(disc_, form_, rest_N));
  // What was asked, not what comes back from the inverse.
  out.force_N = force_N;
  return out;
}

DiscStackState DiscStack::at_depth(double depth_m) const RT_SAFE {
  if (!std::isfinite(depth_m)) return {.status = law::LawStatus::kInvalid};
  if (depth_m < 0.0) return {.status = law::LawStatus::kNoContact};
  if (depth_m > depth_limit_m()) {
    DiscStackState out = at_limit();
    out.stiffness_N_per_m = 0.0;
    out.status = law::LawStatus::kSaturated;
    return out;
  }
  if (depth_m == 0.0)  // touching: no force yet, but the slope that the first layer will have
    return {.stiffness_N_per_m = model::indent::respond(disc_, form_, 0.0).stiffness_N_per_m,
            .status = law::LawStatus::kNoContact};
  // DS-10  j = ceil(d/h0) - 1 full layers
  const double flat = std::ceil(depth_m / disc_.travel_m) - 1.0;
  const double most = static_cast<double>(layers_ - 1);
  const double j = flat < most ? flat : most;
  double s = depth_m - j * disc_.travel_m;
  if (s < 0.0) s = 0.0;  // rounding of the division
  if (s > disc_.travel_m) s = disc_.travel_m;
  DiscStackState out = with_flat_layers(static_cast<std::size_t>(j), s);
  out.depth_m = depth_m;
  return out;
}

law::LawResponse DiscStack::respond(double depth_m) const RT_SAFE {
  const DiscStackState at = at_depth(depth_m);
  return law::response_of(at, at.depth_m, depth_m);
}

std::size_t DiscStack::profile(double depth_m, std::span<double> ring_m) const RT_SAFE {
  const double d = at_depth(depth_m).depth_m;
  const std::size_t count = layers_ + 1 < ring_m.size() ? layers_ + 1 : ring_m.size();
  for (std::size_t j = 0; j < count; ++j) {
    // u_j = d - j h0 until nothing is left; the rim is at rest
    const double u = d - static_cast<double>(j) * disc_.travel_m;
    // LW-2: the layers go along depth; drawn as rings by our choice.
    ring_m[j] = u > 0.0 && j < layers_ ? u : 0.0;
  }
  return count;
}

}  // namespace tact::model::indent
