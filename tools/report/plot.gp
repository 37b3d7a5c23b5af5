# SPDX-License-Identifier: Apache-2.0
# The head of every picture. In front of it stand name, width_px and height_px.
if (!exists('kind')) kind = 'svg'
if (kind eq 'png') { set terminal pngcairo size width_px,height_px font 'DejaVu Sans,11' }
if (kind eq 'svg') { set terminal svg size width_px,height_px font 'DejaVu Sans,Arial,14' background '#ffffff' }
set output name.'.'.kind
set datafile separator ','
set datafile columnheaders
set encoding utf8
set border lc rgb '#444444'
set grid lc rgb '#dddddd'
set key font ',10' opaque
set style textbox opaque noborder fillcolor rgb '#ffffff'
# Colours that people with any colour vision distinguish (Okabe, Ito 2008).
inks = '#0072B2 #D55E00 #009E73 #CC79A7 #E69F00 #56B4E9 #000000 #999999'
do for [ink=1:words(inks)] { set linetype ink lc rgb word(inks, ink) }
