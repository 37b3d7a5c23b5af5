# SPDX-License-Identifier: Apache-2.0
f = 'skin_press.csv'
set title "[3] fig. 8: force of a press of 7 mm and its release (50 N/m, 2 mm, 25 rings)\n\
no number of the curve is in the copy: all lines by tact, the stroke is ours"
set xlabel "time, s"
set ylabel "force, N"
set yrange [0:*]
plot 3.3 lc rgb '#999999' dt 3 title 'most that its device gives', \
     f using 2:4 with lines lt 2 lw 2 title 'as printed, a body spring per ring', \
     f using 2:5 with lines lt 1 lw 2 title 'energy form'
