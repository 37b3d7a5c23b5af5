// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cmath>

#include "model/springs/integrator_stability.h"
#include "tools/stability/laws/probed_methods.h"
#include "tools/stability/pictures/pictures.h"

namespace tact::tools::stability {
namespace {

constexpr double kMax = 4.0;       // z shown
constexpr double kOverlap = 1.06;  // of cells, so that no seam shows

/// z_max over zeta, as a data block that a script can plot.
std::string theory_block(int number, const model::springs::Method& method) {
  constexpr int kPoints = 200;
  std::string out = fmt::format("$theory{} << EOD\nz_max,zeta\n", number);
  for (int i = 0; i <= kPoints; ++i) {
    const double zeta = 2.0 * i / kPoints;
    out += fmt::format("{:.5g},{:.5g}\n",
                       // Infinity is no number for gnuplot: just beyond what is shown.
                       std::fmin(model::springs::largest_stable_z(method, zeta), kMax + 1.0), zeta);
  }
  return out + "EOD\n";
}

}  // namespace

std::vector<report::Picture> integrator_pictures(Grid grid) {
  // Width and height of a cell, as map_integrators.cc has them.
  const double dz = grid == Grid::kQuick ? 4.0 / 15.0 : 4.0 / 60.0;
  const double dzeta = grid == Grid::kQuick ? 2.0 / 8.0 : 2.0 / 40.0;
  std::string script = fmt::format("f = 'integrators.csv'\ndz = {:.6g}\ndzeta = {:.6g}\n",
                                   kOverlap * dz / 2.0, kOverlap * dzeta / 2.0);
  script += R"gp(
set multiplot layout 2,4 title "Growth of a damped oscillator: cells measured, \
black line z_{max} of the amplification matrix, red crosses: they disagree" \
  font ',14'
set xrange [0:4]
set yrange [-0.025:2]
set xlabel "z = h omega"
set ylabel "damping ratio zeta"
set key off
set style fill solid noborder
set label 1 "bounded" at 0.12,0.68 front
set label 2 "grows without limit" at 1.8,1.6 front
)gp";
  int number = 0;
  for (const ProbedMethod& probed : kProbedMethods) {
    ++number;
    script += theory_block(number, probed.method);
    if (probed.method.integrator == model::springs::Integrator::kImplicitEuler)
      script += "set label 1 \"bounded everywhere\"\nunset label 2\n";
    script += fmt::format(
        "set title '{0}'\n"
        "plot f using (strcol(2) eq '{0}' && strcol(8) eq 'bounded' ? $4 : NaN):3:(dz):(dzeta) "
        "with boxxyerror lc rgb '#a6cee3', \\\n"
        "     f using (strcol(2) eq '{0}' && strcol(8) eq 'grows' ? $4 : NaN):3:(dz):(dzeta) "
        "with boxxyerror lc rgb '#fdbf6f', \\\n"
        "     $theory{1} using 1:2 with lines lc rgb '#000000' lw 2.5, \\\n"
        "     f using (strcol(2) eq '{0}' && strcol(7) ne strcol(8) ? $4 : NaN):3 with points pt 2 "
        "lc rgb '#e31a1c'\n",
        probed.name, number);
  }
  script += "unset multiplot\n";
  return {{.name = "integrators", .width_px = 1600, .height_px = 850, .script = script}};
}

}  // namespace tact::tools::stability
