# SPDX-License-Identifier: MIT
# awk -f fields.awk FILE.lcm... > fields.hpp: our messages' fields as C++ that a template can walk through, each
# with what its .lcm file says of it; a field without a comment has the one before's.
BEGIN {
  print "// Made by lcmtypes/fields.awk from the .lcm files."
  print "#pragma once\n\n#include <variant>\n"
  for (i = 1; i < ARGC; ++i) {
    type = ARGV[i]
    sub(/.*\//, "", type)
    sub(/\.lcm$/, "", type)
    types = types ", " type
    print "#include \"mixloop/" type ".hpp\""
  }
  print "\nnamespace mixloop {\n\n/// Any of our messages, or none.\nusing AnyMessage = std::variant<std::monostate" types ">;"
}

$1 == "struct" {
  print "\ntemplate <class Visitor>\nvoid visit_fields(const " $2 "& m, Visitor&& visit) {"
}

$1 ~ /^(double|int8_t|int32_t|int64_t)$/ {
  name = $2
  sub(/[[;].*/, "", name)
  if (index($0, "//")) {
    said = $0
    sub(/^[^\/]*\/\/ */, "", said)
    gsub(/["\\]/, "\\\\&", said)
  }
  print "  visit(\"" name "\", \"" said "\", m." name ");"
}

/^}/ { print "}" }

END { print "\n}  // namespace mixloop" }
