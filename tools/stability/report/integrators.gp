# SPDX-License-Identifier: Apache-2.0
# methods, $theory: z_max over zeta of each; cell_z, cell_zeta: size of a cell.
f = 'integrators.csv'
overlap = 1.06  # of cells, so that no seam shows
dz = overlap * cell_z / 2.0
dzeta = overlap * cell_zeta / 2.0
set multiplot layout 2,4 title "Growth of a damped oscillator: cells measured, \
black line z_{max} of the amplification matrix, red crosses: they disagree" \
  font ',14'
set xrange [0:4]
set yrange [-0.025:2]
set xlabel "z = h omega"
set ylabel "damping ratio zeta"
set key off
set style fill solid noborder
set label 1 "bounded" at 0.12,0.68 front
set label 2 "grows without limit" at 1.8,1.6 front
do for [i=1:words(methods)] {
  m = word(methods, i)
  if (m eq 'implicit Euler') {
    set label 1 "bounded everywhere"
    unset label 2
  }
  set title m
  plot f using (strcol(2) eq m && strcol(8) eq 'bounded' ? $4 : NaN):3:(dz):(dzeta) \
         with boxxyerror lc rgb '#a6cee3', \
       f using (strcol(2) eq m && strcol(8) eq 'grows' ? $4 : NaN):3:(dz):(dzeta) \
         with boxxyerror lc rgb '#fdbf6f', \
       $theory using (strcol(1) eq m ? $2 : NaN):3 with lines lc rgb '#000000' lw 2.5, \
       f using (strcol(2) eq m && strcol(7) ne strcol(8) ? $4 : NaN):3 with points pt 2 lc rgb '#e31a1c'
}
unset multiplot
