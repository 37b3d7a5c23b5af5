# SPDX-License-Identifier: Apache-2.0
# softest, stiffest: of the walls, N/m; bounded_N_per_m: bounded without the passivity stage, 0 if none is
set logscale x
set xlabel "stiffness of the wall, N/m"
set ylabel "swing of the tool after 4 s, mm"
set key top left
set yrange [0:*]
set xrange [0.9*softest:1.1*stiffest]
if (bounded_N_per_m > 0) {
  set arrow 1 from bounded_N_per_m,graph 0 to bounded_N_per_m,graph 1 nohead lc rgb '#D55E00' dt 2 lw 1.5
}
plot 'wall.csv' using 2:($4*1e3) with linespoints pt 7 lc 2 lw 2 title "without the passivity stage", \
     'wall.csv' using 2:($8*1e3) with linespoints pt 5 lc 1 lw 2 title "with it"
