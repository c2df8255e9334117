# One figure of docs/accuracy.md: error against CPU time. tools/accuracy calls it with `data`, `ours`,
# `peers` (how many curves each) and `output_file`.
set terminal svg size 1000,560 font "sans,13" background "white"
set output output_file
set logscale xy
set format x "10^{%L}"
set format y "10^{%L}"
set xlabel "largest error, relative"
set ylabel "CPU time, s"
set xrange [1:1e-16]
set key outside right top vertical Left reverse samplen 2 font ",10" noenhanced
set grid lc rgb "#dddddd"
plot for [i=0:ours-1] data.".ours" index i using 1:2 with linespoints pt i % 13 + 1 ps 0.6 lw 2 \
       title columnheader(1), \
     for [i=0:peers-1] data.".peers" index i using 1:2 with linespoints dt 2 pt i % 13 + 1 ps 0.5 lw 1 \
       title columnheader(1)
