# Log-log figure of growth.tsv (bench/tables): gnuplot -e "data='growth.tsv'; picture='growth.svg'" growth.gp
set terminal svg size 900,480 font 'sans-serif,12' background 'white'
set output picture
set datafile separator '\t'
set datafile missing '-'
set logscale xy
set xlabel 'independent coordinates'
set key below reverse Left
set grid
set xrange [0.9:80]
set xtics (1, 2, 4, 8, 16, 32, 64)
rows(family, column) = sprintf("< awk -F'\\t' '$1 == \"%s\" {print $2 \"\\t\" $%d}' %s", family, column, data)
set multiplot layout 1,2
set ylabel 'operations'
plot rows('serial', 7) using 1:2 with lines dashtype 2 title 'serial: composite bodies', \
     rows('serial', 8) using 1:2 with lines dashtype 3 title 'serial: articulated bodies', \
     rows('serial', 5) using 1:2 with linespoints pointtype 7 title 'serial: chosen', \
     rows('parallelograms', 5) using 1:2 with linespoints pointtype 5 title 'parallelograms: chosen', \
     20*x**2 with lines dashtype 4 linecolor 'gray' title 'n^2'
set ylabel 's'
set format y '10^{%T}'
plot rows('serial', 10) using 1:($2) with linespoints pointtype 7 title 'serial: compilation', \
     rows('serial', 9) using 1:($2*1e-3) with linespoints pointtype 5 title 'tracing', \
     rows('serial', 13) using 1:($2*1e-9) with linespoints pointtype 9 title 'evaluation, reference', \
     rows('serial', 12) using 1:($2*1e-9) with linespoints pointtype 11 title 'interpreter', \
     rows('serial', 11) using 1:($2*1e-9) with linespoints pointtype 13 title 'machine code'
unset multiplot
