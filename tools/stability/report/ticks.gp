# SPDX-License-Identifier: Apache-2.0
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
