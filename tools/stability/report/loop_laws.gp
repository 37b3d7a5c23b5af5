# SPDX-License-Identifier: Apache-2.0
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
# laws side by side, or they would hide each other
plot x lc 'black' dt 2 title "theory", for [i=1:words(laws)] \
  f using (strcol(2) eq word(laws, i) ? $7*(1.0 + 0.03*(i - 6)) : NaN):8 \
    with points pt i ps 0.9 lc i title word(laws, i)
