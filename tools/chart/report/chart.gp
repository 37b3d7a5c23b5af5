# SPDX-License-Identifier: Apache-2.0
# caption; families, and is_peer of each; $points: their points, errors in %; $front: the line that no law of tact
# passes; least_us, most_us, most_force: of all points; peers: where and when they were measured
law_inks = '#0072B2 #009E73 #56B4E9 #004D73 #6A3D9A #44AA99 #332288'
peer_inks = '#D55E00 #CC3311 #882255 #E69F00'  # warm
colours = ''
symbols = ''
law = 0
peer = 0
do for [i=1:words(families)] {
  if (word(is_peer, i) + 0) {
    colours = colours.' '.word(peer_inks, peer % 4 + 1)
    symbols = symbols.' '.sprintf('%d', 5 + 2 * (peer % 4))
    peer = peer + 1
  } else {
    colours = colours.' '.word(law_inks, law % 7 + 1)
    symbols = symbols.' '.sprintf('%d', 4 + 2 * (law % 5))
    law = law + 1
  }
}
set multiplot title caption
set logscale xy
set xrange [least_us / 6.0:3.0 * most_us]
set format x '%g'
set format y '%g'
set key outside right top font ',9' Left reverse
set lmargin 9
set rmargin 28
do for [panel=1:3] {
  if (panel == 1) {
    set yrange [*:2.0 * most_force]
    set size 1,0.46
    set origin 0,0.5
    set ylabel 'force error, RMS, % of the peak'
    set label 1 'a hand notices a difference of 7 %' at graph 0.5, first 7 center offset 0,0.5 \
      font ',8' tc rgb '#555555'
    set arrow 1 from graph 0, first 7 to graph 1, first 7 nohead dt 2 lc rgb '#555555'
  }
  if (panel == 2) {
    unset label 1
    set yrange [*:*]
    set size 1,0.25
    set origin 0,0.25
    set ylabel 'worst, % of the own force'
  }
  if (panel == 3) {
    unset arrow 1
    set origin 0,0
    set xlabel "time of a tick, median, us; of a law: detect, render, limit of the whole tool\n\
beside a point: knots, layers, rings, nodes, curves; of fem mm, else iterations\n".peers
    set ylabel 'shape error, RMS, %'
  }
  plot $front using (panel == 1 ? $1 : NaN):2 with steps lw 4 lc rgb '#c8c8c8' \
         title (panel == 1 ? 'front of tact' : ''), \
       $front using (panel == 1 ? $1 : NaN):2:3 with labels left offset 3,-1.2 font ',10' tc rgb '#555555' notitle, \
       for [i=1:words(families)] $points using ($1 == i ? $2 : NaN):panel+2 \
         with linespoints pt (word(symbols, i) + 0) ps 1.3 lw 1 dt 3 lc rgb word(colours, i) \
         title (panel == 1 ? word(families, i) : ''), \
       for [i=1:words(families)] $points using ($1 == i ? $2 : NaN):panel+2:(strcol(panel+5)) \
         with labels left offset 0.8,(i % 2 ? 0.4 : -0.4) font ',8' tc rgb word(colours, i) notitle
}
unset multiplot
