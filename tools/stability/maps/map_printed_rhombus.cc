// SPDX-License-Identifier: Apache-2.0
// The rhombus chain as its source prints it: where does it stop making sense?
//
// Equations (3), (4), (6), (11) as printed let the tangential springs help the load. Per cell of
// angle theta0 and kT/kN: the first unit of ten that gets longer while it is pressed, measured on
// the printed force at a small press, beside
//
//     kN = kT1 exp((i - 1)/beta) tan^2(theta0)        singular at unit i, X2
//
// and what the printed force (12) is of the force that the springs really store, 1/2 for small
// presses. The energy form resists in every cell.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tools/printed/rhombus_paper.h"
#include "tools/stability/maps/scripts.h"
#include "tools/stability/sweep/axes.h"
#include "tools/stability/sweep/map.h"

namespace tact::tools::stability {
namespace {

constexpr double kDegree_rad = std::numbers::pi / 180.0;
constexpr int kUnits = 10;
constexpr double kGrowth = 2.0;         // beta
constexpr double kSmall_rad = -1e-6;    // a press that only shows the slope
constexpr double kPress_ratio = -0.02;  // of theta0: a press that can be seen

struct Cells {
  std::size_t angles = 0, ratios = 0;
};
Cells cells(Grid grid) { return grid == Grid::kQuick ? Cells{18, 12} : Cells{90, 60}; }

double angle_deg(std::size_t i, Grid grid) {
  return 3.0 + 57.0 * (static_cast<double>(i) + 0.5) / static_cast<double>(cells(grid).angles);
}
/// kT/kN from 0.1 to 10.
double spring_ratio(std::size_t i, Grid grid) {
  return std::pow(
      10.0, -1.0 + 2.0 * (static_cast<double>(i) + 0.5) / static_cast<double>(cells(grid).ratios));
}

model::indent::RhombusUnit unit_of(double angle_rad, double ratio, int i) {
  return {.rod_length_m = 0.010,
          .initial_angle_rad = angle_rad,
          .normal_stiffness_N_per_m = 1500.0,
          // (11), with i from 0.
          .tangential_stiffness_N_per_m = 1500.0 * ratio * std::exp(i / kGrowth)};
}

/// Counted from 1; kUnits + 1: none.
int first_failing(double angle_rad, double ratio) {
  for (int i = 0; i < kUnits; ++i) {
    const printed::PaperUnit at = printed::paper_forward(unit_of(angle_rad, ratio, i), kSmall_rad);
    // X2: under a press it gets longer.
    if (!(at.force_N / at.shortening_m > 0.0)) return i + 1;
  }
  return kUnits + 1;
}

int theory_first_failing(double angle_rad, double ratio) {
  const double tangent = std::tan(angle_rad);
  // i > 1 + beta ln(kN / (kT1 tan^2(theta0)))
  const double last_good = 1.0 + kGrowth * std::log(1.0 / (ratio * tangent * tangent));
  return last_good < 1.0 ? 1 : std::min(kUnits + 1, static_cast<int>(std::floor(last_good)) + 1);
}

report::Row run(std::size_t job, Grid grid) {
  const auto [angle, ratio] = Axes<2>{{cells(grid).angles, cells(grid).ratios}}.at(job);
  const double angle_rad = angle_deg(angle, grid) * kDegree_rad;
  const double kT_over_kN = spring_ratio(ratio, grid);
  const model::indent::RhombusUnit unit = unit_of(angle_rad, kT_over_kN, 0);
  const printed::PaperUnit small = printed::paper_forward(unit, kSmall_rad);
  const printed::PaperUnit pressed = printed::paper_forward(unit, kPress_ratio * angle_rad);
  // The paper counts a shortening below zero, the energy form above.
  const model::indent::UnitResponse energy = model::indent::respond(unit, -pressed.shortening_m);
  const int first = first_failing(angle_rad, kT_over_kN);
  const char* what = first > kUnits ? "softer than the springs"
                     : first == 1   ? "the surface pulls the tool in"
                                    : "deeper units get longer while pressed";
  return {{"angle_deg", angle_deg(angle, grid)},
          {"kT_over_kN", kT_over_kN},
          {"first_failing_unit", first},
          {"theory_first_failing_unit", theory_first_failing(angle_rad, kT_over_kN)},
          {"printed_stiffness_ratio",
           small.force_N / small.shortening_m / unit.normal_stiffness_N_per_m},
          {"energy_stiffness_ratio",
           model::indent::respond(unit, 0.0).stiffness_N_per_m / unit.normal_stiffness_N_per_m},
          {"printed_force_12_ratio", pressed.energy_J / -pressed.shortening_m / energy.force_N},
          {"what_happens", what}};
}

std::vector<Finding> check(const report::Table& t) {
  std::size_t agree = 0, energy_resists = 0;
  Spread ratio;
  for (const report::Row& row : t.rows()) {
    agree += number(row, "first_failing_unit") == number(row, "theory_first_failing_unit");
    // RC-5 at rest: kN + kT tan^2(theta0).
    energy_resists += number(row, "energy_stiffness_ratio") >= 1.0;
    ratio.add(number(row, "printed_force_12_ratio"));
  }
  const double share = static_cast<double>(agree) / static_cast<double>(t.rows().size());
  // X2, with the springs that the paper prints for liver: kN 1.5, kT1 1.8.
  const double line_deg = std::atan(std::sqrt(1.5 / 1.8)) / kDegree_rad;
  return {{share >= 0.995, fmt::format("the printed chain fails at the unit that the formula says "
                                       "in {:.2f} % of cells; the liver's first unit at {:.3f} deg",
                                       100.0 * share, line_deg)},
          {energy_resists == t.rows().size(), "the energy form resists in every cell"},
          // X4: one half for small presses, more as they grow.
          {ratio.low > 0.499 && ratio.high < 0.53,
           fmt::format("(12) is {:.4f} to {:.4f} of the force of the stored energy", ratio.low,
                       ratio.high)}};
}

report::Variables variables(Grid grid) {
  return {{"cell_deg", angle_deg(1, grid) - angle_deg(0, grid)},
          {"cell_decades", std::log10(spring_ratio(1, grid) / spring_ratio(0, grid))}};
}

}  // namespace

Map printed_rhombus_map() {
  return {.letter = 'b',
          .name = "printed_rhombus",
          .purpose = "where the printed rhombus law turns its sign, by angle, springs and unit",
          .jobs = [](Grid grid) { return cells(grid).angles * cells(grid).ratios; },
          .run = run,
          .check = check,
          .plot = {.width_px = 1200, .height_px = 800, .script = kPrintedRhombusScript},
          .variables = variables};
}

}  // namespace tact::tools::stability
