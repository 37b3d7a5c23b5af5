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

std::vector<Printed> example(const indent::DiscStack& stack) {
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

}  // namespace

Figure disc_layers() {
  const auto stack = indent::make_disc_stack(kExample);
  const double none = std::numeric_limits<double>::quiet_NaN();
  std::vector<report::Row> rows;
  rows.reserve(6);
  for (std::size_t i = 0; i < 6; ++i)
    rows.push_back({static_cast<double>(i + 1),
                    static_cast<double>(i + 1) * stack->disc().flat_force_N(),
                    1e6 * indent::delay_through_layer_s(kExample.delays, i + 1),
                    i < kPrintedForce_N.size() ? kPrintedForce_N[i] : none,
                    i < kPrintedDelay_us.size() ? kPrintedDelay_us[i] : none});
  return {.name = "disc_layers",
          .of = "[2] fig. 3",
          .shows = "force and delay of the layers, with the worked example",
          .numbers = example(*stack),
          .curves = curves_of(
              "disc_layers",
              {"layers", "force_N", "delay_us", "printed_force_N", "printed_delay_us"}, rows),
          .picture = {.name = "disc_layers", .width_px = 900, .height_px = 600, .script = R"gp(
f = 'disc_layers.csv'
set title "[2] fig. 3: force and delay of layers that go flat one after the other\n\
points: numbers of its worked example; lines: tact, unrounded"
set xlabel "layers"
set xrange [0.5:6.5]
set xtics 1
set ylabel "force of the layers, N"
set y2label "delay of the layers, us"
set ytics nomirror
set y2tics
set yrange [0:6]
set y2range [0:100]
set key top left
plot 4.0 lc rgb '#999999' dt 3 title 'contact force, 4.0 N: five layers', \
     f using 2:3 with lines lt 1 lw 2 title 'force', \
     f using 2:5 with points lt 1 pt 6 ps 2 title 'force, printed', \
     f using 2:4 axes x1y2 with lines lt 2 lw 2 title 'delay', \
     f using 2:6 axes x1y2 with points lt 2 pt 4 ps 2 title 'delay, printed'
)gp"}};
}

}  // namespace tact::tools::figures
