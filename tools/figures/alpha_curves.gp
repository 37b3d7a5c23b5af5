# SPDX-License-Identifier: Apache-2.0
f = 'alpha_curves.csv'
set multiplot layout 1,2 title "[4] fig. 5: velocity by midpoint-averaging. \
No number of the curves is in the copy: all lines by tact, the oscillator is ours" font ',13'
set xlabel "time, s"
set ylabel "velocity, m/s"
do for [h in "0.1 0.4"] {
  set title 'h = '.h.' s'
  plot f using ($2 == h ? $3 : NaN):4 with lines lt 7 lw 2 title 'truth', \
       f using ($2 == h ? $3 : NaN):5 with points lt 1 pt 7 title '1/2', \
       f using ($2 == h ? $3 : NaN):6 with points lt 2 pt 6 title '3/8', \
       f using ($2 == h ? $3 : NaN):7 with points lt 3 pt 4 title '5/8'
}
unset multiplot
