# SPDX-License-Identifier: Apache-2.0
# run: its title; series: their titles; peer: which of them is cyclictest's, 0 if none is
f = 'histogram.csv'
set logscale xy
set xlabel 'us, from this value on'
set ylabel 'samples in a bucket of a twentieth decade'
set yrange [0.5:*]
set format y '10^{%L}'
set key top right
set title run noenhanced
# A step is drawn down to half a sample where a bucket is empty: zero has no logarithm. The peer reports whole
# microseconds, which leaves gaps: points.
samples(i, empty) = column(i+1) > 0 ? column(i+1) : empty
if (peer == 0) {
  plot for [i=1:words(series)] f using 1:(samples(i, 0.5)) with steps lw 2 lt i title word(series, i)
} else {
  plot for [i=1:peer-1] f using 1:(samples(i, 0.5)) with steps lw 2 lt i title word(series, i), \
    f using 1:(samples(peer, NaN)) with points pt 7 ps 0.5 lw 2 lt peer title word(series, peer), \
    for [i=peer+1:words(series)] f using 1:(samples(i, 0.5)) with steps lw 2 lt i title word(series, i)
}
