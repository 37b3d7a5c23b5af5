#include <fmt/format.h>

#include "tools/stability/laws.h"
#include "tools/stability/pictures.h"

namespace tact::tools {

std::vector<Picture> law_loop_pictures(Grid) {
  std::string script = R"gp(
f = 'loop_laws.csv'
set title "Every law loses stability where its tangent stiffness passes K = b / (T/2 + t_d)\n\
each law at several depths of its range, 1 kHz, no help from the hand"
set logscale xy
set xlabel "theory: b / (T/2 + t_d), N/m"
set ylabel "measured: largest stable tangent dF/dd, N/m"
set xrange [80:20000]
set yrange [60:15000]
set key bottom right
set label 1 "oscillation grows until the gate limits it" at 120,6000
set label 2 "comes to rest" at 1500,130
plot x lc 'black' dt 2 title "theory")gp";
  int i = 0;  // laws side by side, or they would hide each other
  for (const NamedLaw& named : probed_laws()) {
    script += fmt::format(
        ", \\\n  f using (strcol(2) eq '{0}' ? $7*{1:.3f} : NaN):8 with points pt {2} ps 0.9 lc "
        "{2} "
        "title '{0}'",
        named.name, 1.0 + 0.03 * (i - 5), i + 1);
    ++i;
  }
  return {{.name = "loop_laws", .width_px = 1200, .height_px = 800, .script = script + "\n"}};
}

}  // namespace tact::tools
