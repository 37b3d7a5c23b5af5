// SPDX-License-Identifier: Apache-2.0
#include "tools/stability/pictures/pictures.h"

namespace tact::tools::stability {

std::vector<report::Picture> tick_pictures(Grid) {
  return {{.name = "ticks", .width_px = 1200, .height_px = 700, .script = R"gp(
f = 'ticks.csv'
set title "Lost and late ticks: largest stable stiffness, 1 kHz, b = 2 N s/m, bare device\n\
points measured, lines theory: K = (2 b / T) E[n] / E[n^2], n periods held"
set logscale y
set xlabel "share p of ticks that are lost, or late"
set ylabel "stiffness K, N/m"
set xrange [0:0.82]
set yrange [100:10000]
set key bottom left
set label 1 "oscillation grows: the gate clips it,\nfades at the second loss in a row,\n\
lets go and latches at the 20th" at 0.45,4500
set label 2 "stable: a lost sample is a force held longer" at 0.3,230
n1(p) = 4000 * (1 - p) / (1 + p)
late(p, n) = 4000 * (1 - p + p*n) / (1 - p + p*n*n)
plot f using (strcol(2) eq 'lost' && $4 == 2 ? $5 : NaN):7 with points pt 7 ps 1.1 lc 1 \
       title "lost samples, force held", n1(x) lc 1 dt 2 notitle, \
     for [i=1:3] n = word("2 4 10", i)+0 f using \
       (strcol(2) eq 'late' && $3 == n && $4 == 2 ? $5 : NaN):7 with points pt 5 ps 1 lc i+1 \
       title sprintf("late ticks, force held for %d periods", n), \
     for [i=1:3] late(x, word("2 4 10", i)) lc i+1 dt 2 notitle
)gp"}};
}

std::vector<report::Picture> loss_pictures(Grid) {
  return {{.name = "loss", .width_px = 1200, .height_px = 800, .script = R"gp(
f = 'loss.csv'
set multiplot layout 2,1 title "A burst of lost samples: 2 N deep in a wall of 1 kN/m, 1 kHz, \
the hand withdraws with 0.1 m/s" font ',14'
set xrange [-0.5:40.5]
set xlabel "samples lost in a row (ms)"
set ylabel "force on the hand, N"
set yrange [-0.1:2.4]
set key center right
set arrow 1 from 2,-0.1 to 2,2.4 nohead lc '#999999' dt 3
set arrow 2 from 20,-0.1 to 20,2.4 nohead lc '#999999' dt 3
set label 1 "hold" at 0.1,2.25
set label 2 "fade to zero in 10 ms" at 2.3,2.25
set label 3 "latched: only an operator's reset leads back" at 20.3,2.25
plot f using ($2 == 1000 ? $3 : NaN):4 with linespoints pt 7 ps 0.7 lc 2 title "held for ever", \
     f using ($2 == 1000 ? $3 : NaN):5 with linespoints pt 7 ps 0.7 lc 1 title "through the gate"
unset label
unset arrow
set ylabel "energy given to the hand, mJ"
set yrange [*:*]
set key top left
set label 1 "active: the loop drives the hand" at 12,3.5
set label 2 "passive: the hand gets less than the wall owes it" at 21,-0.5
plot f using ($2 == 1000 ? $3 : NaN):($6*1e3) with linespoints pt 7 ps 0.7 lc 2 \
       title "held for ever, beyond what the wall gives back", \
     f using ($2 == 1000 ? $3 : NaN):($7*1e3) with linespoints pt 7 ps 0.7 lc 1 \
       title "through the gate", 0 lc 'black' notitle
unset multiplot
)gp"}};
}

}  // namespace tact::tools::stability
