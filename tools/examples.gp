# SPDX-License-Identifier: Apache-2.0
# Draws NAME.png from NAME.csv and NAME_touches.csv of fdcg-servo replay. Needs name: an example of testdata/scenes.
is_sheet = name eq 'press_sheet'
is_ball = name eq 'hold_sphere'
has_two = name eq 'two_devices'
fingers = is_ball ? 3 : 2
heading = is_sheet ? 'A finger presses a soft sheet, drags along it and leaves it' : \
          is_ball  ? 'Three fingers of one device hold a ball up, turn it by a third and put it down' : \
          has_two  ? 'Two devices, a thumb and a finger, lift one cube, turn it by a quarter and put it down' : \
                     'Two fingers of one device lift a cube, turn it by a quarter and put it down'
held = is_ball ? 'middle of the ball' : 'foot of the cube'
hand = is_sheet ? 'finger' : has_two ? 'thumb and finger' : 'hand'
set datafile separator ','
set datafile missing NaN # what a filter leaves out: the line goes on
set terminal pngcairo size 900,800 font 'sans,9' background rgb 'white' rounded
set output name . '.png'
hip = '#c2410c'
god = '#1d4ed8'
ink = '#334155'
# the first finger's line is the widest: equal ones show as bands
array colour[3] = [hip, god, '#4ade80']
array width[3] = [4.5, 2.4, 1]
session = name . '.csv'
touches = name . '_touches.csv'
# of a row of the touches: fingers are counted over all devices, of which each has one where there are two
finger(device, contact) = has_two ? device + 1 : contact + 1
of(i, value) = finger(column(2), column(4)) == i ? value : NaN
finger_name(i) = has_two ? (i == 1 ? 'thumb' : 'finger') : sprintf('finger %d', i)
turned(z, w) = 2 * atan2(z, w) * 180 / pi

set border 11 lw 1 lc rgb ink
set tics textcolor rgb ink nomirror
set grid lc rgb '#e2e8f0' lt 1
set key at graph 1,1.17 right top horizontal textcolor rgb ink samplen 2.5
set xrange [0:8]
set lmargin at screen 0.08; set rmargin at screen 0.92
set multiplot
set label 1 heading at screen 0.08,0.978 left font 'sans,12' textcolor rgb ink

set bmargin at screen 0.69; set tmargin at screen 0.92
set format x ''
set ylabel 'height (mm)' textcolor rgb ink
if (is_sheet) {
  set yrange [-15:35]
  plot session using 1:($4 * 1e3) skip 1 with lines lw 1.6 lc rgb hip title hand, \
       session using 1:(strcol(11) eq 'free' ? NaN : $7 * 1e3) skip 1 with lines lw 1.6 lc rgb god title 'god-object, on the sheet'
} else {
  set y2label 'turned (degrees)' textcolor rgb ink
  set y2tics 30 textcolor rgb ink
  set y2range [-15:135]
  set yrange [-15:135]
  plot session using 1:($15 == 0 ? $4 * 1e3 : NaN) skip 1 with lines lw 1.6 lc rgb hip title hand, \
       session using 1:($15 == 0 ? $24 * 1e3 : NaN) skip 1 with lines lw 1.6 lc rgb god title held, \
       session using 1:($15 == 0 ? turned($27, $28) : NaN) skip 1 axes x1y2 with lines lw 1.6 dt 2 lc rgb ink title 'turned'
  unset y2tics; unset y2label
}
unset label 1

set bmargin at screen 0.38; set tmargin at screen 0.61
set yrange [0:*]
set ylabel 'force (N)' textcolor rgb ink
if (is_sheet) {
  plot session using 1:(sqrt($8**2 + $9**2 + $10**2)) skip 1 with lines lw 1.6 lc rgb hip title 'on the finger', \
       session using 1:(abs($8)) skip 1 with lines lw 1.6 lc rgb god title 'along the drag: it sticks and slips'
} else {
  set yrange [0:3.9]
  plot for [i = 1:fingers] touches using 1:(of(i, $15)) skip 1 with lines lw width[i] lc rgb colour[i] \
         title 'load of ' . finger_name(i), \
       for [i = 1:fingers] touches using 1:(of(i, $16)) skip 1 with lines lw width[i] lc rgb colour[i] \
         title (i == fingers ? 'below: friction' : '')
}

set bmargin at screen 0.07; set tmargin at screen 0.30
set format x '%g'
set xlabel 'time (s)' offset 0,0.4 textcolor rgb ink
if (is_sheet) {
  set yrange [0:*]
  set ylabel 'deepest dent (mm)' textcolor rgb ink
  plot session using 1:($22 * 1e3) skip 1 with lines lw 1.6 lc rgb god title 'farthest that a corner is from its place'
} else {
  set yrange [0:1.05]
  set ylabel 'margin to slipping' textcolor rgb ink
  plot for [i = 1:fingers] touches using 1:(of(i, $17)) skip 1 with lines lw width[i] lc rgb colour[i] title finger_name(i), \
       0 lc rgb ink dt 3 title '0: it slips'
}
unset multiplot
