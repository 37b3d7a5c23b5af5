// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <limits>

#include "model/indent/disc_stack.h"
#include "model/units.h"
#include "tools/figures/figures.h"

namespace tact::tools::figures {
namespace {

using namespace model;

constexpr double kContact_N = 4.0;
constexpr indent::DiscStackParameters kExample{
    .disc = {.outer_diameter_m = 0.4_mm,
             .inner_diameter_m = 0.204_mm,
             .thickness_m = 22.5e-6,
             .free_height_m = 31.5e-6,
             .youngs_modulus_Pa = 2.06e11,  // X9
             .poisson_ratio = 0.3},
    .form = indent::DiscForm::kLinear,
    .delays = {
        .first_delay_s = 10_us, .delay_ratio = 1.1, .refresh_rate_Hz = 1100.0, .layers = 64}};
constexpr std::array kPrintedForce_N{0.846, 1.692, 2.538, 3.384, 4.23};
constexpr std::array kPrintedDelay_us{10.0, 21.0, 33.1, 46.41};

}  // namespace

std::vector<Printed> disc_example() {
  const indent::DiscStack stack = *indent::make_disc_stack(kExample);
  const auto& d = kExample.disc;
  const double ratio = d.outer_diameter_m / d.inner_diameter_m;
  const auto at = stack.at_force(kContact_N);
  std::vector<Printed> out{{"C", 1.96, ratio},
                           {"alpha", 0.686, indent::disc_shape_factor(ratio)},
                           {"k N/m", 9.397e4, stack.disc().stiffness_N_per_m}};
  for (std::size_t i = 0; i < kPrintedForce_N.size(); ++i)
    out.push_back({"force to layer " + std::to_string(i + 1) + " N", kPrintedForce_N[i],
                   static_cast<double>(i + 1) * stack.disc().flat_force_N()});
  for (std::size_t i = 0; i < kPrintedDelay_us.size(); ++i)
    out.push_back({"delay to layer " + std::to_string(i + 1) + " us", kPrintedDelay_us[i],
                   1e6 * indent::delay_through_layer_s(kExample.delays, i + 1)});
  out.push_back({"layers that move", 5.0, static_cast<double>(at.moving_layers)});
  out.push_back({"last layer um", 6.555, 1e6 * at.last_flattening_m});
  out.push_back({"depth um", 42.555, 1e6 * at.depth_m});
  return out;
}

Rows disc_layers() {
  const indent::DiscStack stack = *indent::make_disc_stack(kExample);
  const double none = std::numeric_limits<double>::quiet_NaN();
  Rows rows;
  for (std::size_t i = 0; i < 6; ++i)
    rows.push_back(
        {{"layers", i + 1},
         {"force_N", static_cast<double>(i + 1) * stack.disc().flat_force_N()},
         {"delay_us", 1e6 * indent::delay_through_layer_s(kExample.delays, i + 1)},
         {"printed_force_N", i < kPrintedForce_N.size() ? kPrintedForce_N[i] : none},
         {"printed_delay_us", i < kPrintedDelay_us.size() ? kPrintedDelay_us[i] : none}});
  return rows;
}

}  // namespace tact::tools::figures
