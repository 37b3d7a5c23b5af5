// SPDX-License-Identifier: Apache-2.0
// The published cases of the disc stack: constants of a disc, the stack, and the printed example.
#include <cmath>

#include "model/indent/disc_series.h"
#include "model/indent/disc_stack.h"
#include "tools/verify/report.h"

namespace tact::tools::verify {
namespace disc_cases {

using model::indent::Disc;
using model::indent::DiscForm;
using model::indent::DiscStackState;
using model::indent::LayerDelays;
using model::law::LawStatus;
using nlohmann::json;

model::indent::DiscDimensions dimensions_of(const json& p) {
  return {.outer_diameter_m = number(p.at("D")),
          .inner_diameter_m = number(p.at("d")),
          .thickness_m = number(p.at("l")),
          .free_height_m = number(p.at("H0")),
          .youngs_modulus_Pa = number(p.at("E")),
          .poisson_ratio = number(p.at("mu"))};
}

json constants_results(const json& one_case) {
  const model::indent::DiscDimensions dimensions = dimensions_of(one_case.at("params"));
  const auto disc = model::indent::make_disc(dimensions);
  // The files name every refusal alike.
  if (!disc) return {{"status", "INVALID_ARGUMENT"}};
  const DiscForm form = DiscForm::kAlmenLaszlo;
  const double ratio = dimensions.outer_diameter_m / dimensions.inner_diameter_m;
  return {{"status", model::indent::is_monotone(*disc, form) ? "OK" : "NON_MONOTONE"},
          // DS-1 to DS-5.
          {"C", ratio},
          {"alpha", model::indent::disc_shape_factor(ratio)},
          {"k", disc->stiffness_N_per_m},
          {"h0", disc->travel_m},
          {"F_flat", disc->flat_force_N()},
          {"eta", disc->cone_ratio},
          {"k_AL_initial", model::indent::respond(*disc, form, 0.0).stiffness_N_per_m},
          {"k_AL_flat", model::indent::respond(*disc, form, disc->travel_m).stiffness_N_per_m}};
}

/// A stack in which no layer may move: tact refuses it, the file says what it would do.
json without_layers(const json& inputs) {
  json got{{"status", "TRUNCATED_TIME_BUDGET"}, {"i_max", 0}, {"M", 0}};
  for (const char* zero : {"F", "h", "hM", "F_supported", "T_M", "k_tan", "U"}) got[zero] = 0.0;
  if (inputs.contains("F")) got["F_unsupported"] = inputs.at("F");
  return got;
}

json stack_results(const json& one_case) {
  const json &p = one_case.at("params"), &inputs = one_case.at("inputs");
  const DiscForm form = p.at("law") == "LINEAR" ? DiscForm::kLinear : DiscForm::kAlmenLaszlo;
  const Disc disc{.outer_diameter_m = 1.0,  // no part of these cases
                  .stiffness_N_per_m = number(p.at("k")),
                  .travel_m = number(p.at("h0")),
                  .cone_ratio = number(p.at("eta"))};
  const LayerDelays delays{.first_delay_s = number(p.at("t1")),
                           .delay_ratio = number(p.at("q")),
                           .refresh_rate_Hz = number(p.at("rate")),
                           .layers = p.at("Ncap").get<std::size_t>()};
  const auto stack = model::indent::make_disc_stack(disc, form, delays);
  if (!stack) {
    // make_disc_stack() has one error for all: ask again which of the file's words it is.
    if (!model::indent::is_monotone(disc, form)) return {{"status", "NON_MONOTONE"}};
    const bool too_slow = delays.refresh_rate_Hz > 0.0 && model::indent::layer_budget(delays) == 0;
    return too_slow ? without_layers(inputs) : json{{"status", "INVALID_ARGUMENT"}, {"h", 0.0}};
  }
  const bool force_in = inputs.at("mode") == "FORCE";
  const DiscStackState at = force_in ? stack->at_force(number(inputs.at("F")))
                                     : stack->at_depth(number(inputs.at("depth")));
  const bool slow = at.status == LawStatus::kSaturated &&
                    stack->truncated_by() == model::indent::TruncatedBy::kTimeBudget;
  return {{"status", slow ? "TRUNCATED_TIME_BUDGET" : word(kLawStatus, at.status)},
          {"F", at.force_N},
          // DS-9: with a force in, the rest is not carried beyond the last layer that moves.
          {"F_supported", at.force_N},
          {"F_unsupported", at.unsupported_force_N},
          {"M", at.moving_layers},
          {"h", at.depth_m},
          {"hM", at.last_flattening_m},
          {"k_tan", at.stiffness_N_per_m},
          {"U", at.energy_J},
          {"T_M", model::indent::delay_through_layer_s(delays, at.moving_layers)},
          {"i_max", stack->layer_count()}};
}

json series_results(const json& one_case) {
  const json& p = one_case.at("params");
  const auto series =
      model::indent::make_disc_series({.force_N = number(p.at("force")),
                                       .working_depth_m = number(p.at("depth")),
                                       .exponent = number(p.at("exponent")),
                                       .exponent_slope = number(p.at("exponent_slope")),
                                       .first_depth_m = number(p.at("first_depth")),
                                       .discs = p.at("discs").get<std::size_t>()});
  if (!series) return {{"status", "INVALID_ARGUMENT"}};
  const auto at = series->respond(number(one_case.at("inputs").at("depth")));
  return {{"F", at.force_N},
          {"K", at.stiffness_N_per_m},
          {"U", at.energy_J},
          {"status", word(kLawStatus, at.status)}};
}

double rounded(double value, double unit) { return std::round(value / unit) * unit; }

/// The printed example with its rounding between the steps: C to 2 decimals, alpha to 3, k to 4
/// digits, k h0 to 3 decimals in N, h5 to 3 decimals in micrometres. Nothing else rounds like this.
json printed_results(const json& one_case) {
  const json& p = one_case.at("params");
  const model::indent::DiscDimensions in = dimensions_of(p);
  // DS-11, X10.
  const double ratio = rounded(in.outer_diameter_m / in.inner_diameter_m, 0.01);
  const double alpha = rounded(model::indent::disc_shape_factor(ratio), 0.001);
  const double l = in.thickness_m, outer = in.outer_diameter_m, mu = in.poisson_ratio;
  const double k_exact =
      4.0 * in.youngs_modulus_Pa / (1.0 - mu * mu) * l * l * l / (alpha * outer * outer);
  // Four digits, for any size.
  const double k = rounded(k_exact, std::pow(10.0, std::floor(std::log10(k_exact)) - 3.0));
  const double h0 = in.free_height_m - l, flat_N = rounded(k * h0, 0.001);
  const double force_N = number(one_case.at("inputs").at("F"));
  const double layers = std::ceil(force_N / flat_N);
  const double last_m = rounded((force_N - (layers - 1.0) * flat_N) / k, 1e-9);
  const LayerDelays delays{.first_delay_s = number(p.at("t1")),
                           .delay_ratio = number(p.at("q")),
                           .refresh_rate_Hz = number(p.at("rate")),
                           .layers = model::indent::kMaxLayers};
  json got{{"C", ratio},
           {"alpha", alpha},
           {"k", k},
           {"F1", flat_N},
           {"M", layers},
           {"h5", last_m},
           {"h", (layers - 1.0) * h0 + last_m}};
  for (int i = 2; i <= 5; ++i) got["F_sum" + std::to_string(i)] = i * flat_N;
  for (std::size_t i = 1; i <= 4; ++i)
    got["T" + std::to_string(i)] = model::indent::delay_through_layer_s(delays, i);
  return got;
}

constexpr Verifier kVerifiers[] = {
    {"disc_constants", verify_cases<constants_results>},
    {"disc_stack", verify_cases<stack_results>},
    {"disc_series", verify_cases<series_results>},
    {"disc_patent_rounded", verify_cases<printed_results>},
};

}  // namespace disc_cases

std::span<const Verifier> disc_verifiers() { return disc_cases::kVerifiers; }

}  // namespace tact::tools::verify
