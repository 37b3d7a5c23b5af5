# SPDX-License-Identifier: Apache-2.0
f = 'step_sizes.csv'
set multiplot layout 1,3 title "[4] fig. 8: one mass by three methods at three steps. \
No number of the curves is in the copy: all lines by tact, the oscillator is ours" font ',13'
set xlabel "time, s"
set ylabel "displacement, m"
set yrange [-0.5:0.8]
do for [k=1:3] {
  set title (k == 1 ? '(a) explicit Euler' : k == 2 ? '(b) improved Euler' : '(c) midpoint-averaging')
  plot f using ($2 == 0.02 ? $3 : NaN):4 with lines lt 7 lw 2 title 'truth', \
       f using ($2 == 0.02 ? $3 : NaN):(column(4+k)) with lines lt 1 title 'h = 0.02 s', \
       f using ($2 == 0.1 ? $3 : NaN):(column(4+k)) with points lt 3 pt 7 title '0.1 s', \
       f using ($2 == 0.4 ? $3 : NaN):(column(4+k)) with linespoints lt 2 pt 6 title '0.4 s'
}
unset multiplot
