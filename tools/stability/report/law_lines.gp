# SPDX-License-Identifier: Apache-2.0
f = 'law_lines.csv'
of(s, i) = strcol(2) eq s ? column(i) : NaN
set multiplot layout 2,2 title \
  "Where a law stops being one: points measured, dashed lines theory" font ',14'
set key top right
set title "Disc: cone height over thickness"
set xlabel "eta = h0 / l"
set ylabel "least stiffness / k"
set xrange [0:2]
set arrow 1 from 1.41421,graph 0 to 1.41421,graph 1 nohead lc rgb '#999999'
set label 1 "snaps through:\nrefused" at 1.5,0.6
set label 2 "grows to flat" at 0.2,-0.5
plot f using (of('disc_cone', 3)):4 with points pt 7 lc 1 title "measured", \
     1 - x*x/2 lc 'black' dt 2 title "1 - eta^2/2", 0 lc rgb '#999999' notitle
unset label
unset arrow
set title "Discs: the modelled delay, t1 = 20 us, q = 1.1"
set logscale x
set xlabel "rate of the loop, Hz"
set ylabel "layers that move"
set xrange [200:9000]
set label 1 "beyond: the force stays (time budget)" at 900,25
set label 2 "the stack deforms" at 300,8
plot f using (of('disc_rate', 3)):4 with points pt 7 lc 1 title "measured", \
     log(1 + 0.1/(x*2e-5))/log(1.1) lc 'black' dt 2 title "T_i = 1/rate"
unset label
unset logscale
set title "Rhombus unit: stiff tangential springs, 60 degrees"
set xlabel "kT / kN"
set ylabel "least stiffness / kN"
set xrange [0:4]
set arrow 1 from 2,graph 0 to 2,graph 1 nohead lc rgb '#999999'
set label 1 "snaps before it is flat:\nsaturates there" at 2.2,0.4
set label 2 "ends flat" at 0.5,-0.4
plot f using (of('rhombus_snap', 3)):4 with points pt 7 lc 1 title "measured", \
     1 - x/2 lc 'black' dt 2 title "1 - (kT/kN)(1 - cos theta0)", 0 lc rgb '#999999' notitle
unset label
unset arrow
set title "Hexagonal rings: force at 5 mm"
set xlabel "rings m"
set ylabel "force, N"
set logscale xy
set xrange [2.5:70]
set yrange [0.2:20000]
set key top left
set label 1 "printed: no limit" at 25,30
set label 2 "energy form: has a limit" at 22,1.1
plot f using (of('hex_node', 3)):4 with points pt 7 lc 2 title "printed, spring per node", \
     98.75*(x/25)**2 lc 2 dt 2 title "in proportion to m^2", \
     f using (of('hex_ring', 3)):4 with points pt 7 lc 5 title "printed, spring per ring", \
     2.323*(x/25) lc 5 dt 2 title "in proportion to m", \
     f using (of('hex_sheet', 3)):4 with points pt 7 lc 1 title "energy form", \
     2.5806 lc 1 dt 2 notitle
unset multiplot
