# SPDX-License-Identifier: Apache-2.0
# laws: in eight inks, then in the same ones dashed.
f = 'law_limits.csv'
of(i, column_number) = strcol(2) eq word(laws, i) ? column(column_number) : NaN
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
plot 0 lc rgb '#444444' notitle, for [i=1:words(laws)] f using (of(i, 3)):6 \
  with lines lw 1.8 lc 1+(i-1)%8 dt 1+(i-1)/8 title word(laws, i)
set ylabel "tangent stiffness / mean stiffness of the range"
set yrange [-0.1:3.2]
set key top right
set arrow 1 from 1,-0.1 to 1,3.2 nohead lc rgb '#999999' dt 3
set label 1 "no stiffness left" at 1.1,0.15
set label 2 "stiff: needs damping" at 0.05,3.05
set label 3 "pulled" at -1.4,0.15
plot 0 lc rgb '#444444' notitle, for [i=1:words(laws)] f using (of(i, 3)):7 \
  with lines lw 1.8 lc 1+(i-1)%8 dt 1+(i-1)/8 title word(laws, i)
unset multiplot
