# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
#
# Plots what measure_volume_popping printed: gnuplot -e "csv='build/popping.csv'; png='docs/volume_popping.png'" THIS
set terminal pngcairo size 900,420 font "sans,11" linewidth 1.3
set output png
set datafile separator ","
set grid xtics ytics linecolor rgb "#dddddd"
set key top center horizontal
set xlabel "degrees about the vertical axis; 0.25 degrees between frames"
set ylabel "rms change between frames"
set xrange [0:90]
set xtics 15
set yrange [0:*]
set arrow from 45, graph 0 to 45, graph 1 nohead dt 2 lc rgb "#888888"
plot csv using 1:2 skip 1 with lines lc rgb "#d62728" title "splats of 3 px", \
     csv using 1:4 skip 1 with lines lc rgb "#1f77b4" title "points of 0.8 px"
