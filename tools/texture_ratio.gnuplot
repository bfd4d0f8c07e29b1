# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
#
# Plots what measure_texture ratio wrote: gnuplot -e "csv='ratio.csv'; png='docs/texture_ratio.png'" THIS
set terminal pngcairo size 960,480 font "sans,11" linewidth 1.4
set output png
set datafile separator ","
set grid xtics ytics linecolor rgb "#dddddd"
set key bottom left reverse Left
set xlabel "share of the texels that are minified, percent"
set ylabel "time of hybrid over time of splat"
set y2label "PSNR of hybrid against splat, dB"
set ytics nomirror
set y2tics
set xrange [0:100]
set yrange [0:1.2]
set y2range [0:100]
set pointsize 0.9
plot csv using ($2 * 100):5 every ::1 with linespoints lc rgb "#1f77b4" pt 7 title "time, hybrid over splat", \
     csv using ($2 * 100):6 every ::1 axes x1y2 with linespoints lc rgb "#d62728" pt 6 title "PSNR, right axis", \
     40 axes x1y2 with lines dt 2 lc rgb "#888888" title "40 dB"
