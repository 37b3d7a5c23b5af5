# SPDX-License-Identifier: Apache-2.0
f = 'skin_dent.csv'
set title "[3] fig. 6: dent of 25 rings as printed, by the strain of the first spring\n\
no number of the curves is in the copy: all lines by tact, the strains are ours"
set xlabel "ring"
set ylabel "displacement, mm"
set yrange [] reverse
set key bottom right
plot f using 2:3 with linespoints lt 1 title '0.05', \
     f using 2:4 with linespoints lt 2 title '0.1', \
     f using 2:5 with linespoints lt 3 title '0.2', \
     f using 2:6 with linespoints lt 4 title '0.4'
