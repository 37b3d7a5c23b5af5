// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "tools/stability/laws/laws.h"
#include "tools/stability/pictures/pictures.h"

namespace tact::tools::stability {

namespace {

constexpr double kOverlap = 1.06;  // of cells, so that no seam shows

}  // namespace

std::vector<report::Picture> printed_rhombus_pictures(Grid grid) {
  const bool quick = grid == Grid::kQuick;
  return {{.name = "printed_rhombus",
           .width_px = 1200,
           .height_px = 800,
           // Half a cell of map_printed_rhombus.cc, in degrees and in decades.
           .script = fmt::format("dx = {}\ndy = {}\n", kOverlap * (quick ? 57.0 / 36 : 57.0 / 180),
                                 kOverlap * (quick ? 1.0 / 12 : 1.0 / 60)) +
                     R"gp(
f = 'printed_rhombus.csv'
set title "The rhombus chain as printed: which of ten units is first to get longer while pressed\n\
cells measured, lines: kN = kT exp((i-1)/beta) tan^2(theta0), beta = 2, i = 1 (thick) .. 10"
set xlabel "angle theta0 of the rods, degrees"
set ylabel "kT / kN of the first unit"
set logscale y
set xrange [3:60]
set yrange [0.1:10]
set cbrange [0.5:11.5]
set palette maxcolors 11
set palette defined (0.5 '#c6510a', 4 '#f59a4f', 9 '#fde3c8', \
  10.4 '#fdf3e8', 10.5 '#b7e0b5', 11.5 '#b7e0b5')
set cblabel "first unit that fails (11: none of ten)"
set cbtics 1
set key off
set style fill solid noborder
set label 1 "the surface pulls the tool in" at 47,5.5 center front boxed
set label 2 "deeper units get longer\nwhile the surface is pressed" at 27,0.75 center front boxed
set label 3 "softer than its own springs" at 9.5,0.16 center front boxed
set label 4 "  liver: 1.2, 42.392 deg" at 42.392,1.2 \
  point pt 7 ps 1.5 front boxed
set samples 500
plot f using 2:3:($2-dx):($2+dx):($3*10**-dy):($3*10**dy):4 with boxxyerror lc palette, \
     for [i=1:10] exp(-(i-1)/2.0)/tan(x*pi/180)**2 lc rgb '#000000' lw (i == 1 ? 2.5 : 0.7)
)gp"}};
}

std::vector<report::Picture> law_limit_pictures(Grid) {
  std::string script = R"gp(
f = 'law_limits.csv'
set multiplot layout 1,2 title "Every law up to its range and beyond it: what it gives" font ',14'
set xlabel "depth / range (press positive, pull negative)"
set ylabel "force / force at the end of the range"
set xrange [-1.5:2.5]
set yrange [-2.2:2.2]
set key top left
set arrow 1 from 1,-2.2 to 1,2.2 nohead lc rgb '#999999' dt 3
set label 1 "beyond: force stays,\nstatus 'saturated'" at 1.1,1.6
set label 2 "within the range" at 0.1,-1.7
set label 3 "pulled" at -1.4,-2.0
plot 0 lc rgb '#444444' notitle)gp";
  const auto curves = [&](int column) {
    int i = 0;
    for (const NamedLaw& named : probed_laws())
      script += fmt::format(
          ", \\\n  f using (strcol(2) eq '{0}' ? $3 : NaN):{1} with lines lw 1.8 lc "
          "{2} dt {3} title '{0}'",
          // Eight inks, then the same ones dashed.
          named.name, column, i % 8 + 1, i / 8 + 1),
          ++i;
  };
  curves(6);
  script += R"gp(
set ylabel "tangent stiffness / mean stiffness of the range"
set yrange [-0.1:3.2]
set key top right
set arrow 1 from 1,-0.1 to 1,3.2 nohead lc rgb '#999999' dt 3
set label 1 "no stiffness left" at 1.1,0.15
set label 2 "stiff: needs damping" at 0.05,3.05
set label 3 "pulled" at -1.4,0.15
plot 0 lc rgb '#444444' notitle)gp";
  curves(7);
  script += "\nunset multiplot\n";
  return {{.name = "law_limits", .width_px = 1600, .height_px = 800, .script = script}};
}

namespace {

constexpr char kLines[] = R"gp(
f = 'law_lines.csv'
of(s, i) = strcol(2) eq s ? column(i) : NaN
set multiplot layout 2,2 title \
  "Where a law stops being one: points measured, dashed lines theory" font ',14'
set key top right
set title "Disc: cone height over thickness"
set xlabel "eta = h0 / l"
set ylabel "least stiffness / k"
set xrange [0:2]
set arrow 1 from 1.41421,graph 0 to 1.41421,graph 1 nohead lc rgb '#999999'
set label 1 "snaps through:\nrefused" at 1.5,0.6
set label 2 "grows to flat" at 0.2,-0.5
plot f using (of('disc_cone', 3)):4 with points pt 7 lc 1 title "measured", \
     1 - x*x/2 lc 'black' dt 2 title "1 - eta^2/2", 0 lc rgb '#999999' notitle
unset label
unset arrow
set title "Discs: the modelled delay, t1 = 20 us, q = 1.1"
set logscale x
set xlabel "rate of the loop, Hz"
set ylabel "layers that move"
set xrange [200:9000]
set label 1 "beyond: the force stays (time budget)" at 900,25
set label 2 "the stack deforms" at 300,8
plot f using (of('disc_rate', 3)):4 with points pt 7 lc 1 title "measured", \
     log(1 + 0.1/(x*2e-5))/log(1.1) lc 'black' dt 2 title "T_i = 1/rate"
unset label
unset logscale
set title "Rhombus unit: stiff tangential springs, 60 degrees"
set xlabel "kT / kN"
set ylabel "least stiffness / kN"
set xrange [0:4]
set arrow 1 from 2,graph 0 to 2,graph 1 nohead lc rgb '#999999'
set label 1 "snaps before it is flat:\nsaturates there" at 2.2,0.4
set label 2 "ends flat" at 0.5,-0.4
plot f using (of('rhombus_snap', 3)):4 with points pt 7 lc 1 title "measured", \
     1 - x/2 lc 'black' dt 2 title "1 - (kT/kN)(1 - cos theta0)", 0 lc rgb '#999999' notitle
unset label
unset arrow
set title "Hexagonal rings: force at 5 mm"
set xlabel "rings m"
set ylabel "force, N"
set logscale xy
set xrange [2.5:70]
set yrange [0.2:20000]
set key top left
set label 1 "printed: no limit" at 25,30
set label 2 "energy form: has a limit" at 22,1.1
plot f using (of('hex_node', 3)):4 with points pt 7 lc 2 title "printed, spring per node", \
     98.75*(x/25)**2 lc 2 dt 2 title "in proportion to m^2", \
     f using (of('hex_ring', 3)):4 with points pt 7 lc 5 title "printed, spring per ring", \
     2.323*(x/25) lc 5 dt 2 title "in proportion to m", \
     f using (of('hex_sheet', 3)):4 with points pt 7 lc 1 title "energy form", \
     2.5806 lc 1 dt 2 notitle
unset multiplot
)gp";

}  // namespace

std::vector<report::Picture> law_line_pictures(Grid) {
  return {{.name = "law_lines", .width_px = 1400, .height_px = 1000, .script = kLines}};
}

std::vector<report::Picture> law_loop_pictures(Grid) {
  std::string script = R"gp(
f = 'loop_laws.csv'
set title "A closed-form law loses stability where its tangent stiffness passes b / (T/2 + t_d),\n\
also one that relaxes; the nodes of a patch give way, so it holds further\n\
each law at several depths of its range, 1 kHz, no help from the hand"
set logscale xy
set xlabel "theory: b / (T/2 + t_d), N/m"
set ylabel "measured: largest stable tangent dF/dd, N/m"
set xrange [80:20000]
set yrange [60:200000]
set key bottom right
set label 1 "oscillation grows until the gate limits it" at 120,60000
set label 2 "comes to rest" at 1000,130
plot x lc 'black' dt 2 title "theory")gp";
  int i = 0;  // laws side by side, or they would hide each other
  for (const NamedLaw& named : probed_laws()) {
    script += fmt::format(
        ", \\\n  f using (strcol(2) eq '{0}' ? $7*{1:.3f} : NaN):8 with points pt {2} ps 0.9 lc "
        "{2} title '{0}'",
        named.name, 1.0 + 0.03 * (i - 5), i + 1);
    ++i;
  }
  return {{.name = "loop_laws", .width_px = 1200, .height_px = 800, .script = script + "\n"}};
}

}  // namespace tact::tools::stability
