# SPDX-License-Identifier: MIT
# awk -f fields.awk FILE.lcm... > fields.hpp: our messages as C++ that a template can walk through: their types, their
# channels, their fields, each with what its .lcm file says of it; a field without a comment has the one before's.
BEGIN {
  print "// Made by lcmtypes/fields.awk from the .lcm files."
  print "#pragma once\n\n#include <array>\n#include <cstdint>\n#include <type_traits>\n#include <variant>\n"
  for (i = 1; i < ARGC; ++i) {
    type = ARGV[i]
    sub(/.*\//, "", type)
    sub(/\.lcm$/, "", type)
    channel = type
    sub(/_t$/, "", channel)
    types = types ", " type
    channels = channels (i > 1 ? ", " : "") channel
    names = names (i > 1 ? ", " : "") "\"" toupper(channel) "\""
    print "#include \"mixloop_lcm/" type ".hpp\""
  }
  print "\nnamespace mixloop {\n"
  split(substr(types, 3), all, ", ")
  for (i = 1; i in all; ++i) print "using mixloop_lcm::" all[i] ";"
  print "\n/// Any of our messages, or none.\nusing AnyMessage = std::variant<std::monostate" types ">;"
  print "\n/// The channels of the bus, one a type, in AnyMessage's order."
  print "enum class Channel : std::uint8_t { " channels " };"
  print "/// Their names without the prefix."
  print "inline constexpr std::array kChannelNames = {" names "};"
  print "\nvoid visit_fields(const std::monostate&, const auto&) {}"
}

$1 == "struct" {
  print "\n/// Calls visit(name, what its file says of it, value) for each field."
  print "template <class Message, class Visitor>\n  requires std::is_same_v<std::remove_const_t<Message>, " $2 ">"
  print "void visit_fields(Message& m, Visitor&& visit) {"
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
