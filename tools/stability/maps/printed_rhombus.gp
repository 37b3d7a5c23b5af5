# SPDX-License-Identifier: Apache-2.0
# cell_deg, cell_decades: size of a cell.
overlap = 1.06  # of cells, so that no seam shows
dx = overlap * cell_deg / 2.0
dy = overlap * cell_decades / 2.0
f = 'printed_rhombus.csv'
set title "The rhombus chain as printed: which of ten units is first to get longer while pressed\n\
cells measured, lines: kN = kT exp((i-1)/beta) tan^2(theta0), beta = 2, i = 1 (thick) .. 10"
set xlabel "angle theta0 of the rods, degrees"
set ylabel "kT / kN of the first unit"
set logscale y
set xrange [3:60]
set yrange [0.1:10]
set cbrange [0.5:11.5]
set palette maxcolors 11
set palette defined (0.5 '#c6510a', 4 '#f59a4f', 9 '#fde3c8', \
  10.4 '#fdf3e8', 10.5 '#b7e0b5', 11.5 '#b7e0b5')
set cblabel "first unit that fails (11: none of ten)"
set cbtics 1
set key off
set style fill solid noborder
set label 1 "the surface pulls the tool in" at 47,5.5 center front boxed
set label 2 "deeper units get longer\nwhile the surface is pressed" at 27,0.75 center front boxed
set label 3 "softer than its own springs" at 9.5,0.16 center front boxed
set label 4 "  liver: 1.2, 42.392 deg" at 42.392,1.2 \
  point pt 7 ps 1.5 front boxed
set samples 500
plot f using 2:3:($2-dx):($2+dx):($3*10**-dy):($3*10**dy):4 with boxxyerror lc palette, \
     for [i=1:10] exp(-(i-1)/2.0)/tan(x*pi/180)**2 lc rgb '#000000' lw (i == 1 ? 2.5 : 0.7)
