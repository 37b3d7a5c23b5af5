// SPDX-License-Identifier: Apache-2.0
#include <limits>

#include "model/indent/rhombus_chain.h"
#include "model/units.h"
#include "tools/figures/figures.h"
#include "tools/printed/rhombus_paper.h"

namespace tact::tools::figures {

using namespace model;

Figure rhombus_units() {
  // RC-13: the printed liver in N/mm. A tenth of its limit.
  constexpr double kForce_N = 1.5;
  const auto chain = indent::make_rhombus_chain({.rod_length_m = 10_mm,
                                                 .initial_angle_rad = 30_deg,
                                                 .normal_stiffness_N_per_m = 1500.0,
                                                 .tangential_stiffness_N_per_m = 1800.0,
                                                 .growth = 2.0,
                                                 .units = 10});
  const auto as_printed_mm = [](const indent::RhombusUnit& unit, double force_N) {
    const auto at = printed::paper_inverse(unit, force_N);
    return at.status == law::LawStatus::kOk ? 1e3 * at.unit.shortening_m
                                            : std::numeric_limits<double>::quiet_NaN();
  };
  const auto pressed = chain->at_force(kForce_N), pulled = chain->at_force(-kForce_N);
  std::vector<report::Row> rows;
  for (std::size_t i = 0; i < chain->unit_count(); ++i) {
    const auto& unit = chain->unit(i);
    rows.push_back({static_cast<double>(i + 1), 1e3 * pressed.shortening_m[i],
                    1e3 * pulled.shortening_m[i], -as_printed_mm(unit, -kForce_N),
                    -as_printed_mm(unit, kForce_N)});
  }
  return {.name = "rhombus_units",
          .of = "[1] figs. 5 to 7",
          .shows = "how the units of a pressed and of a pulled chain share its deformation",
          .numbers = {},
          .curves = curves_of(
              "rhombus_units",
              {"unit", "pressed_mm", "pulled_mm", "printed_pressed_mm", "printed_pulled_mm"}, rows),
          .picture = {.name = "rhombus_units", .width_px = 900, .height_px = 600, .script = R"gp(
f = 'rhombus_units.csv'
set title "[1] figs. 5 to 7: a chain pressed and pulled by 1.5 N\n\
as printed, units from 3 on (pulled: from 2 on) have no solution\n\
no number of the curves is in the copy: both forms by tact, rods, angle and force are ours"
set xlabel "unit, counted from the contact"
set ylabel "shortening, mm"
set xrange [0.5:10.5]
plot 0 lc rgb '#444444' notitle, \
     f using 2:3 with linespoints lt 1 lw 2 pt 7 title 'pressed, energy form', \
     f using 2:4 with linespoints lt 3 lw 2 pt 7 title 'pulled, energy form', \
     f using 2:5 with linespoints lt 2 dt 2 pt 6 ps 1.5 title 'pressed, as printed', \
     f using 2:6 with linespoints lt 4 dt 2 pt 6 ps 1.5 title 'pulled, as printed'
)gp"}};
}

}  // namespace tact::tools::figures
