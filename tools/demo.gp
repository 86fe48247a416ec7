# SPDX-License-Identifier: Apache-2.0
# Draws picture.png from whole.rgb, close.rgb, frame.gp and path.dat of fdcg_demo_data. Needs mu_s and mu_d.
load 'frame.gp'
set terminal pngcairo size 1140,700 font 'sans,9' background rgb 'white'
set output 'picture.png'
hip = '#c2410c'
god = '#1d4ed8'
ink = '#334155'
set multiplot
set border lc rgb ink
set tics textcolor rgb ink
unset key

# left: the whole object, the god-object's path on it
set lmargin at screen 0.005; set rmargin at screen 0.605
set bmargin at screen 0.02; set tmargin at screen 0.97
set size ratio -1
unset border; unset tics
set xrange [whole_left:whole_left + whole_width]; set yrange [whole_bottom:whole_bottom + whole_height]
set label 1 'HIP (in the hand)' at graph 0.02,0.965 front textcolor rgb hip
set label 2 'god-object (on the surface)' at graph 0.02,0.925 front textcolor rgb god
set object 1 rectangle from close_left,close_bottom to close_left + close_width,close_bottom + close_height \
  front fillstyle empty border lc rgb ink lw 1.5
plot 'whole.rgb' binary array=(whole_columns,whole_rows) format='%uchar' \
       dx=whole_width/whole_columns dy=whole_height/whole_rows \
       origin=(whole_left + 0.5*whole_width/whole_columns,whole_bottom + 0.5*whole_height/whole_rows) with rgbimage, \
     'path.dat' using 2:3 with lines lw 1.2 lc rgb hip, \
     'path.dat' using ($10 > 0 ? $4 : NaN):5 with lines lw 1.8 lc rgb god
unset label 1; unset label 2; unset object 1

# right, above: a close view of the faces, with the spring every few ticks
set lmargin at screen 0.64; set rmargin at screen 0.985
set bmargin at screen 0.47; set tmargin at screen 0.97
set border 15 lw 1 lc rgb ink
set xrange [close_left:close_left + close_width]; set yrange [close_bottom:close_bottom + close_height]
set label 1 sprintf('the frame, %.0f mm wide; the spring every 4 ms', close_width) at graph 0.03,0.95 front textcolor rgb ink
plot 'close.rgb' binary array=(close_columns,close_rows) format='%uchar' \
       dx=close_width/close_columns dy=close_height/close_rows \
       origin=(close_left + 0.5*close_width/close_columns,close_bottom + 0.5*close_height/close_rows) with rgbimage, \
     'path.dat' every 4 using ($10 > 0 ? $2 : NaN):3:($4 - $2):($5 - $3) with vectors nohead lw 0.8 lc rgb '#7c3aed', \
     'path.dat' using ($10 > 0 ? $2 : NaN):3 with lines lw 1.8 lc rgb hip, \
     'path.dat' using ($10 > 0 ? $4 : NaN):5 with lines lw 1.8 lc rgb god
unset label 1

# right, below: friction ratio and force over time
set size noratio
set tics
set grid lc rgb '#e2e8f0' lt 1
set xrange [*:*]
set lmargin at screen 0.665; set rmargin at screen 0.935
set bmargin at screen 0.265; set tmargin at screen 0.43
set format x ''
set yrange [0:1.15*mu_s]
set ytics 0.2
set ylabel '|F_t| / |F_n|' textcolor rgb ink
set label 1 sprintf('{/Symbol m}_s = %g', mu_s) at graph 1.01,first mu_s textcolor rgb ink font ',9'
set label 2 sprintf('{/Symbol m}_d = %g', mu_d) at graph 1.01,first mu_d textcolor rgb ink font ',9'
plot mu_s with lines lc rgb '#94a3b8' dt 2, mu_d with lines lc rgb '#94a3b8' dt 2, \
     'path.dat' using 1:7 with lines lw 1.2 lc rgb god
unset label 1; unset label 2
set bmargin at screen 0.07; set tmargin at screen 0.235
set format x '%g'
set yrange [0:*]
set ytics autofreq
set ylabel 'force (N)' textcolor rgb ink
set xlabel 'time (s)' offset 0,0.4 textcolor rgb ink
plot 'path.dat' using 1:6 with lines lw 1.4 lc rgb hip
unset multiplot
