# SPDX-License-Identifier: Apache-2.0
f = 'skin_rings.csv'
set title "[3] fig. 5: force at 5 mm over the number of rings (50 N/m, 2 mm)\n\
no number of the curve is in the copy: all lines by tact, the depth is ours"
set xlabel "rings m"
set ylabel "force, N"
set logscale y
set key top left
plot 3.3 lc rgb '#999999' dt 3 title 'most that its device gives', \
     f using 2:3 with linespoints lt 2 pt 7 title 'as printed, a body spring per ring', \
     f using 2:4 with linespoints lt 5 pt 7 title 'as printed, per node', \
     f using 2:5 with linespoints lt 1 lw 2 pt 7 title 'energy form'
