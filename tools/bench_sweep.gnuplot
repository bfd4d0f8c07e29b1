# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
#
# Plots what tools/bench_sweep.py measured: gnuplot -e "csv='build/sweep.csv'; png='docs/sweep.png'" THIS
set terminal pngcairo size 1280,560 font "sans,11" linewidth 1.4
set output png
set datafile separator ","
set multiplot layout 1,2
set logscale xy
set grid xtics ytics mxtics linecolor rgb "#dddddd"
set key top left reverse Left
set format x "10^{%T}"
set ylabel "frame, ms (lower quartile)"
set pointsize 0.9

rows(name, column) = sprintf("< awk -F, '$1 == \"%s\" && %s' %s", name, column, csv)
size(name) = rows(name, "$2 == \"1280x1024\"")
count(name) = sprintf("%s | sort -t, -n -k4", rows(name, "$3 == 1000000"))

set title "Splats, 1280x1024"
set xlabel "splats"
set xrange [7e3:4e7]
set yrange [1:2000]
plot size("9 px") using 3:6 with linespoints lc rgb "#1f77b4" pt 6 title "9 px each, 1 thread", \
     size("9 px") using 3:7 with linespoints lc rgb "#1f77b4" pt 7 title "9 px each, 2 threads", \
     size("closed") using 3:6 with linespoints lc rgb "#d62728" pt 4 title "closed surface, 1 thread", \
     size("closed") using 3:7 with linespoints lc rgb "#d62728" pt 5 title "closed surface, 2 threads", \
     x * 1e-5 with lines dt 2 lc rgb "#888888" title "10 ns per splat"

set title "Pixels, 1 M splats"
set xlabel "pixels of the picture (256x256 to 3840x2160)"
set xrange [5e4:1.2e7]
set yrange [1:2000]
plot count("9 px") using 4:6 with linespoints lc rgb "#1f77b4" pt 6 title "9 px each, 1 thread", \
     count("9 px") using 4:7 with linespoints lc rgb "#1f77b4" pt 7 title "9 px each, 2 threads", \
     count("closed") using 4:6 with linespoints lc rgb "#d62728" pt 4 title "closed surface, 1 thread", \
     count("closed") using 4:7 with linespoints lc rgb "#d62728" pt 5 title "closed surface, 2 threads", \
     x * 1e-5 with lines dt 2 lc rgb "#888888" title "10 ns per pixel"
