# SPDX-License-Identifier: Apache-2.0
# Draws NAME.png from NAME.csv and NAME_touches.csv of fdcg-servo replay. Needs name.
is_sheet = name eq 'press_sheet'
contacts = name eq 'hold_sphere' ? 3 : 2
set datafile separator ','
set terminal pngcairo size 900,760 font 'sans,9' background rgb 'white'
set output name . '.png'
hip = '#c2410c'
god = '#1d4ed8'
ink = '#334155'
third = '#15803d'
array colour[3] = [hip, god, third]
session = name . '.csv'
touches = name . '_touches.csv'
set border 15 lw 1 lc rgb ink
set tics textcolor rgb ink
set grid lc rgb '#e2e8f0' lt 1
set key top right textcolor rgb ink
set xrange [0:8]
set lmargin at screen 0.09; set rmargin at screen 0.98
set multiplot

set bmargin at screen 0.70; set tmargin at screen 0.97
set format x ''
set ylabel 'height (mm)' textcolor rgb ink
if (is_sheet) {
  plot session using 1:($4 * 1e3) skip 1 with lines lw 1.4 lc rgb hip title 'finger', \
       session using 1:(strcol(11) eq 'free' ? NaN : $7 * 1e3) skip 1 with lines lw 1.4 lc rgb god title 'god-object, on the sheet'
} else {
  plot session using 1:($4 * 1e3) skip 1 with lines lw 1.4 lc rgb hip title 'hand', \
       session using 1:($24 * 1e3) skip 1 with lines lw 1.4 lc rgb god title 'what it holds'
}

set bmargin at screen 0.39; set tmargin at screen 0.66
set yrange [0:*]
set ylabel 'force (N)' textcolor rgb ink
if (is_sheet) {
  plot session using 1:(sqrt($8**2 + $9**2 + $10**2)) skip 1 with lines lw 1.4 lc rgb hip title 'on the finger', \
       session using 1:(abs($8)) skip 1 with lines lw 1.4 lc rgb god title 'sideways'
} else {
  plot for [i = 1:contacts] touches using 1:($4 == i - 1 ? $15 : NaN) skip 1 with points pt 7 ps 0.2 lc rgb colour[i] \
         title sprintf('load of finger %d', i), \
       for [i = 1:contacts] touches using 1:($4 == i - 1 ? $16 : NaN) skip 1 with points pt 7 ps 0.15 lc rgb '#94a3b8' \
         title (i == 1 ? 'friction' : '')
}

set bmargin at screen 0.07; set tmargin at screen 0.35
set format x '%g'
set xlabel 'time (s)' offset 0,0.4 textcolor rgb ink
if (is_sheet) {
  set ylabel 'deepest dent (mm)' textcolor rgb ink
  plot session using 1:($22 * 1e3) skip 1 with lines lw 1.4 lc rgb god title 'of any corner'
} else {
  set yrange [0:1.05]
  set ylabel 'margin to slipping' textcolor rgb ink
  plot for [i = 1:contacts] touches using 1:($4 == i - 1 ? $17 : NaN) skip 1 with points pt 7 ps 0.2 lc rgb colour[i] \
         title sprintf('finger %d', i)
}
unset multiplot
