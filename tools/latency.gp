# SPDX-License-Identifier: Apache-2.0
# The histograms that fdcg-servo latency -o NAME.csv writes, as NAME.png: gnuplot -e "name = 'latency'" tools/latency.gp
set terminal pngcairo size 1000,600 noenhanced
set output name . ".png"
set datafile separator ","
set key top right
set logscale xy
set xlabel "us"
set yrange [0.5:]
set ylabel "reports"
set style fill solid 0.5
set title name . ": time from a write to its echo, and between reports"
plot name . ".csv" using ((strcol(2) eq "round_trip") ? sqrt(($3 > 0 ? $3 : 0.5 * $4) * $4) : NaN):5:($4 - $3) with boxes title "round trip", \
     name . ".csv" using ((strcol(2) eq "interval") ? sqrt(($3 > 0 ? $3 : 0.5 * $4) * $4) : NaN):5:($4 - $3) with boxes title "interval"
