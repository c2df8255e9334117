# The table of docs/accuracy.md from points.tsv: the least CPU time at each error level, ours and each peer's.
function family(curve) {
  if (curve ~ /CVODE|ARKODE/) return "SUNDIALS"
  if (curve ~ /MuJoCo/) return (curve ~ /equality/) ? "MuJoCo" : "MuJoCo, projected by the user"
  if (curve ~ /Simbody/) return (curve ~ /couplers/) ? "Simbody" : "Simbody, projected by the user"
  if (curve ~ /textbook/) return "textbook"
  if (curve ~ /^by closures/) return "by closures"
  return "mixloop"
}
/^# [^p]/ { machine = substr($0, 3) }
/^#/ { next }
{
  name = family($2)
  if (!($1 in seen)) { seen[$1] = 1; problems[++count] = $1 }
  if (($1, name) in floor) { if ($4 < floor[$1, name]) floor[$1, name] = $4 } else floor[$1, name] = $4
  for (level = 3; level <= 12; ++level)
    if ($4 <= 10 ^ -level && (!(($1, name, level) in least) || $5 < least[$1, name, level])) {
      least[$1, name, level] = $5
      how[$1, name, level] = $2 ", " $3
    }
}
END {
  print "\n" machine ". CPU time of the whole motion, the least of up to seven runs.\n"
  split("by closures|SUNDIALS|textbook|MuJoCo, projected by the user|MuJoCo|Simbody, projected by the user|Simbody", peers, "|")
  for (p = 1; p <= count; ++p) {
    problem = problems[p]
    head = "| " problem ": error | mixloop | by"
    rule = "|---|---|---"
    for (i = 1; i in peers; ++i)
      if ((problem, peers[i]) in floor) { head = head " | " peers[i]; rule = rule "|---" }
    print head " |\n" rule "|"
    for (level = 3; level <= 12; ++level) {
      if (!((problem, "mixloop", level) in least)) continue
      ours = least[problem, "mixloop", level]
      line = sprintf("| 1e-%d | %.3g ms | %s", level, ours * 1e3, how[problem, "mixloop", level])
      for (i = 1; i in peers; ++i)
        if ((problem, peers[i]) in floor)
          line = line " | " (((problem, peers[i], level) in least) ? \
                             sprintf("%.3g x", least[problem, peers[i], level] / ours) : "out of reach")
      print line " |"
    }
    line = "| floor | " sprintf("%.1e", floor[problem, "mixloop"]) " |"
    for (i = 1; i in peers; ++i)
      if ((problem, peers[i]) in floor) line = line " | " sprintf("%.1e", floor[problem, peers[i]])
    print line " |\n"
  }
}
