# SPDX-License-Identifier: Apache-2.0
f = 'disc_layers.csv'
set title "[2] fig. 3: force and delay of layers that go flat one after the other\n\
points: numbers of its worked example; lines: tact, unrounded"
set xlabel "layers"
set xrange [0.5:6.5]
set xtics 1
set ylabel "force of the layers, N"
set y2label "delay of the layers, us"
set ytics nomirror
set y2tics
set yrange [0:6]
set y2range [0:100]
set key top left
plot 4.0 lc rgb '#999999' dt 3 title 'contact force, 4.0 N: five layers', \
     f using 2:3 with lines lt 1 lw 2 title 'force', \
     f using 2:5 with points lt 1 pt 6 ps 2 title 'force, printed', \
     f using 2:4 axes x1y2 with lines lt 2 lw 2 title 'delay', \
     f using 2:6 axes x1y2 with points lt 2 pt 4 ps 2 title 'delay, printed'
