# SPDX-License-Identifier: Apache-2.0
f = 'euler_methods.csv'
set title "[4] fig. 2: error of three methods, step 0.05, y' = y - 2x/y\n\
its equation and its numbers are not in the copy: the equation is ours"
set xlabel "x"
set ylabel "y less the truth"
set key top left
plot 0 lc rgb '#444444' notitle, \
     f using 2:3 with linespoints lt 1 pt 7 title 'explicit Euler', \
     f using 2:4 with linespoints lt 2 pt 7 title 'implicit Euler', \
     f using 2:5 with linespoints lt 3 pt 7 title 'RK4'
