# SPDX-License-Identifier: Apache-2.0
# One panel a case. rows: of panels; cases: names; and of each case: limits; seconds; columns: 3 of the force, 6 of the
# torque; failed: 1 or 0; causes: when it comes, s, or none.
set multiplot layout rows,2
set xlabel 's' offset 0,0.7
set samples 2
set tmargin 1.6
set title offset 0,-0.6
do for [i=1:words(cases)] {
  L = word(limits, i) + 0
  c = word(columns, i) + 0
  trace = 'trace_'.word(cases, i).'.csv'
  if (word(failed, i) + 0) {
    set title word(cases, i).'  FAILED' noenhanced textcolor rgb '#b00020'
  } else {
    set title word(cases, i) noenhanced textcolor rgb '#222222'
  }
  set ylabel (c == 6 ? 'N m' : 'N')
  set xrange [0:word(seconds, i) + 0]
  set yrange [-1.6*L:1.6*L]
  unset arrow
  if (word(causes, i) ne 'none') {
    t = word(causes, i) + 0
    set arrow 1 from t,graph 0 to t,graph 1 nohead lc rgb '#b00020' dt 3 lw 1.5
  }
  # Limit, commanded (grey), let through (blue, wide), written (black): equal ones lie on each other.
  plot L with lines lc rgb '#b00020' dt 2 notitle, -L with lines lc rgb '#b00020' dt 2 notitle, \
    trace using 2:c with lines lc rgb '#999999' lw 1 notitle, \
    trace using 2:c+1 with lines lc rgb '#56B4E9' lw 4 notitle, \
    trace using 2:c+2 with lines lc rgb '#000000' lw 1 notitle
}
unset multiplot
