# SPDX-License-Identifier: Apache-2.0
f = 'loop.csv'
near(a, b) = abs(a - b) <= 1e-6 * (abs(a) + abs(b)) + 1e-12
# cells of one rate, delay, friction, hand
cell(r, d, c, h) = near($2, r) && near($3, d) && near($4, c) && strcol(5) eq h
set multiplot layout 2,2 title \
  "Largest stable stiffness K of a haptic wall F = K x: points measured, dashed lines theory" \
  font ',14'
set logscale xy
set format y "10^{%L}"
set ylabel "stiffness K, N/m"
rates = "500 1000 2000 4000"
frictions = "0.02 0.1 0.3"

set title "Damping and rate: no delay, ideal encoder, no friction, no help from the hand"
set xlabel "damping b of the device, N s/m"
set xrange [0.15:13]
set yrange [50:200000]
set key bottom right
set label 1 "oscillation grows\nuntil the gate limits it" at 0.2,60000
set label 2 "comes to rest" at 0.8,100
plot for [i=1:4] r = word(rates, i)+0 f using \
       (cell(r, 0, 0, 'bare') && $6 == 0 ? $7 : NaN):10 \
       with points pt 7 ps 1.1 lc i title word(rates, i)." Hz", \
     for [i=1:4] 2*x*word(rates, i) lc i dt 2 notitle, NaN lc 'black' dt 2 title "K = 2 b / T"

set title "Age of the force: b = 1 N s/m, ideal encoder, no friction, no help"
unset logscale x
set xlabel "delay t_d beyond the hold, ms"
set xrange [-0.1:3.2]
set yrange [100:20000]
set key top right
set label 1 "oscillation grows" at 1.2,3000
set label 2 "comes to rest" at 0.2,200
plot for [i=1:4] r = word(rates, i)+0 f using \
       (near($2, r) && $7 == 1 && $4 == 0 && strcol(5) eq 'bare' && $6 == 0 ? $3*1e3 : NaN):10 \
       with points pt 7 ps 1.1 lc i title word(rates, i)." Hz", \
     for [i=1:4] 1/(0.5/word(rates, i) + x*1e-3) lc i dt 2 notitle, \
     NaN lc 'black' dt 2 title "K = b / (T/2 + t_d)"

set title "Encoder and friction: b = 10 N s/m, 1 kHz, no delay, no help"
set logscale x
set xlabel "step D of the counted position, mm"
set xrange [4e-3:0.13]
set yrange [20:200000]
set key bottom left
set label 1 "oscillation grows until the gate limits it" at 5e-3,90000 front boxed
set label 2 "buzzes by a few counts:\nfelt, but does not grow" at 4.2e-2,12000 front boxed
set label 3 "comes to rest" at 5.5e-3,2500
plot f using (cell(1000, 0, 0, 'bare') && $7 == 10 && $6 > 0 ? $6*1e3 : NaN):10 \
       with points pt 7 ps 1.1 lc 'black' title "c = 0: does not grow below", \
     for [i=1:3] c = word(frictions, i)+0 f using \
       (cell(1000, 0, c, 'bare') && $7 == 10 && $6 > 0 ? $6*1e3 : NaN):11 \
       with points pt 5 ps 1.1 lc i title sprintf("c = %g N: comes to rest below", c), \
     2*10*1000 lc 'black' dt 2 title "K = 2 b / T", \
     for [i=1:3] 2*word(frictions, i)/(x*1e-3) lc i dt 2 notitle, \
     NaN lc 1 dt 2 title "K = 2 c / D"

set title "The hand: 1 kHz, delay 0.5 ms, ideal encoder, no friction"
unset label 3
set xlabel "damping b of the device, N s/m"
set xrange [0.15:13]
set yrange [50:200000]
set key bottom right
set label 1 "hands help: the line holds for every hand" at 0.2,100000
set label 2 "comes to rest" at 0.4,70
hands = "bare light firm"
what = "'no help, constant push' 'light: 0.15 kg, 600 N/m, 15 N s/m' \
'firm: 0.4 kg, 1500 N/m, 30 N s/m'"
plot for [i=1:3] f using (cell(1000, 0.5e-3, 0, word(hands, i)) && $6 == 0 ? $7 : NaN):10 \
       with points pt 7 ps 1.1 lc i+4 title word(what, i), \
     x/1e-3 lc 'black' dt 2 title "K = b / (T/2 + t_d)"
unset multiplot
