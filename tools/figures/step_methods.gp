# SPDX-License-Identifier: Apache-2.0
f = 'step_methods.csv'
set multiplot layout 1,2 title "[4] fig. 7: one mass by three methods, h = 0.1 s. \
No number of the curves is in the copy: all lines by tact, the oscillator is ours" font ',13'
set xlabel "time, s"
set ylabel "displacement, m"
set yrange [-0.25:0.45]
plot f using 3:4 with lines lt 7 lw 2 title 'truth', \
     f using 3:5 with lines lt 2 title 'explicit Euler', \
     f using 3:6 with lines lt 3 title 'improved Euler', \
     f using 3:7 with points lt 1 pt 7 title 'midpoint-averaging'
set ylabel "force on the mass, N"
set yrange [*:*]
plot f using 3:8 with lines lt 7 lw 2 title 'truth', \
     f using 3:9 with lines lt 2 title 'explicit Euler', \
     f using 3:10 with lines lt 3 title 'improved Euler', \
     f using 3:11 with points lt 1 pt 7 title 'midpoint-averaging'
unset multiplot
