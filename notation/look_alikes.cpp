// SPDX-License-Identifier: MIT
#include "notation/look_alikes.hpp"

#include <algorithm>
#include <array>

namespace mixloop {
namespace {

struct LookAlike {
  std::string_view bytes;  ///< UTF-8
  const char* name;
  const char* meant;
};

constexpr std::array kLookAlikes = {
    LookAlike{"\u00a0", "a no-break space (U+00A0)", "an ordinary space"},
    LookAlike{"\u2007", "a figure space (U+2007)", "an ordinary space"},
    LookAlike{"\u2009", "a thin space (U+2009)", "an ordinary space"},
    LookAlike{"\u202f", "a narrow no-break space (U+202F)", "an ordinary space"},
    LookAlike{"\u200b", "a space of no width (U+200B)", "nothing"},
    LookAlike{"\u3000", "a wide space (U+3000)", "an ordinary space"},
    LookAlike{"\u2212", "a minus sign (U+2212)", "'-'"},
    LookAlike{"\u2010", "a hyphen (U+2010)", "'-'"},
    LookAlike{"\u2011", "a no-break hyphen (U+2011)", "'-'"},
    LookAlike{"\u2013", "a dash (U+2013)", "'-'"},
    LookAlike{"\u2014", "a dash (U+2014)", "'-'"},
    LookAlike{"\u00d7", "a multiplication sign (U+00D7)", "'*'"},
    LookAlike{"\u00b7", "a middle dot (U+00B7)", "'*'"},
    LookAlike{"\u22c5", "a dot operator (U+22C5)", "'*'"},
    LookAlike{"\u00f7", "a division sign (U+00F7)", "'/'"},
    LookAlike{"\u00b2", "a superscript two (U+00B2)", "'^2'"},
    LookAlike{"\u00b3", "a superscript three (U+00B3)", "'^3'"},
    LookAlike{"\u00b5", "a micro sign (U+00B5)", "'u'"},
    LookAlike{"\u03bc", "a Greek mu (U+03BC)", "'u'"},
    LookAlike{"\u00b0", "a degree sign (U+00B0)", "'deg'"},
    LookAlike{"\u201c", "a curly quote (U+201C)", "a straight one"},
    LookAlike{"\u201d", "a curly quote (U+201D)", "a straight one"},
    LookAlike{"\u2018", "a curly quote (U+2018)", "a straight one"},
    LookAlike{"\u2019", "a curly quote (U+2019)", "a straight one"},
    LookAlike{"\uff0c", "a wide comma (U+FF0C)", "','"},
    LookAlike{"\uff1a", "a wide colon (U+FF1A)", "':'"},
};

}  // namespace

std::string look_alike_in(std::string_view text) {
  const LookAlike* first = nullptr;
  std::size_t where = std::string_view::npos;
  for (const LookAlike& one : kLookAlikes)
    if (const std::size_t at = text.find(one.bytes); at < where) where = at, first = &one;
  return first ? std::string("; there is ") + first->name + "; expected " + first->meant : "";
}

std::string tab_before(std::string_view line) {
  const std::string_view before = line.substr(0, std::min(line.find_first_not_of(" \t"), line.size()));
  return before.find('\t') == std::string_view::npos ? "" : "; the line begins with a tab; expected spaces";
}

}  // namespace mixloop
