# SPDX-License-Identifier: Apache-2.0
# bin_N_per_m: width of a bin; largest_N_per_m: of all slopes; most: presses in one bin
f = 'presses.csv'
pressed(v) = strcol('state') eq 'pressed' ? v : NaN
flawed(v) = strcol('flaws') ne 'none' ? v : NaN
set multiplot layout 1,2 title "The whole tool pressed at vertices of the organ"
set title "largest slope dF/dd, seen from above; circles: a check fails"
set xlabel "x, mm"
set ylabel "y, mm"
set cblabel "N/m"
set size ratio -1
set key off
set palette defined (0 '#0072B2', 0.5 '#E69F00', 1 '#D55E00')
plot f using (1e3*column('x_m')):(1e3*column('y_m')):(pressed(column('slope_N_per_m'))) \
  with points pt 7 ps 0.6 lc palette, \
  f using (1e3*column('x_m')):(flawed(1e3*column('y_m'))) with points pt 6 ps 1.6 lw 1.5 lc rgb '#000000'
set title "how often which largest slope occurs"
set size noratio
set xlabel "largest slope dF/dd of a press, N/m"
set ylabel "presses"
set xrange [0:1.05*largest_N_per_m]
set yrange [0:1.05*(1 + most)]
set style fill solid 0.6
bin(x) = bin_N_per_m * (floor(x / bin_N_per_m) + 0.5)
plot f using (bin(pressed(column('slope_N_per_m')))):(1.0) smooth frequency with boxes lc rgb '#0072B2'
unset multiplot
