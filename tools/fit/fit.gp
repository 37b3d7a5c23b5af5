# SPDX-License-Identifier: Apache-2.0
# laws: their titles, in the order of the columns from 5 on
f = name.'.points.csv'
set xlabel 'depth, mm (pull below 0)'
set ylabel 'force, N'
set key top left
plot f using 3:($2==0?$4:NaN) with points pt 7 ps 0.8 lc rgb '#000000' title 'data', \
  f using 3:($2==1?$4:NaN) with points pt 6 ps 0.9 lc rgb '#000000' title 'data, held out', \
  for [k=1:words(laws)] f using 3:k+4 with lines lw 1.5 lc rgb word(inks, 1+(k-1)%words(inks)) title word(laws, k)
