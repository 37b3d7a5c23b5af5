# SPDX-License-Identifier: Apache-2.0
f = 'alpha_search.csv'
set title "[4] fig. 4: RMS error of the velocity over alpha, 10 s after a kick of 1 m/s\n\
printed: of 3/8, 1/2, 5/8 the best is 1/2 at 0.1 s and 3/8 at 0.4 s; the oscillator is ours"
set xlabel "alpha"
set xrange [0.3:0.7]
set ylabel "RMS error, m/s"
set logscale y
set arrow from 0.5, graph 0 to 0.5, graph 1 nohead lc rgb '#999999' dt 3
set arrow from 0.375, graph 0 to 0.375, graph 1 nohead lc rgb '#999999' dt 3
plot f using 2:3 with lines lt 1 lw 2 title 'h = 0.1 s', \
     f using 2:4 with lines lt 2 lw 2 title 'h = 0.4 s'
