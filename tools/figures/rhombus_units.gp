# SPDX-License-Identifier: Apache-2.0
f = 'rhombus_units.csv'
set title "[1] figs. 5 to 7: a chain pressed and pulled by 1.5 N\n\
as printed, units from 3 on (pulled: from 2 on) have no solution\n\
no number of the curves is in the copy: both forms by tact, rods, angle and force are ours"
set xlabel "unit, counted from the contact"
set ylabel "shortening, mm"
set xrange [0.5:10.5]
plot 0 lc rgb '#444444' notitle, \
     f using 2:3 with linespoints lt 1 lw 2 pt 7 title 'pressed, energy form', \
     f using 2:4 with linespoints lt 3 lw 2 pt 7 title 'pulled, energy form', \
     f using 2:5 with linespoints lt 2 dt 2 pt 6 ps 1.5 title 'pressed, as printed', \
     f using 2:6 with linespoints lt 4 dt 2 pt 6 ps 1.5 title 'pulled, as printed'
