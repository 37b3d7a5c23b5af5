# SPDX-License-Identifier: Apache-2.0
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
