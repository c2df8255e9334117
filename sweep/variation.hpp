// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "notation/document.hpp"
#include "sweep/distribution.hpp"

namespace mixloop {

/// An entry that a sweep varies, and the values that it takes: numbers of one unit, listed or drawn, or
/// texts.
struct Variation {
  std::string key;  ///< as --set takes it
  Place place;
  std::string unit;                          ///< behind each number, as it was written; may be empty
  std::vector<double> numbers;               ///< listed
  std::vector<std::string> texts;            ///< listed, of those that aren't all numbers
  std::optional<Distribution> distribution;  ///< drawn

  bool is_number() const { return texts.empty(); }
  std::int64_t size() const;  ///< of what is listed
  /// What is written into the experiment for a number: the shortest text that reads back to it.
  std::string text_of(double number) const;
  /// All that it is, as a person could have written it: `normal(5 kg, 0.5 kg)`, `0 kg, 2 kg`.
  std::string written() const;
};

/// Of `key=from..to:count` (`0..5 kg:11`) or `key=value,value,...`. Throws InputError at `--vary KEY`.
Variation parse_varied(const std::string& text);
/// Of `key=normal(mean, std)` or `key=uniform(from, to)`. Throws InputError at `--sample KEY`.
Variation parse_sampled(const std::string& text);

/// The same of a sweep's file: an entry of `vary`, a text or a list of values, and one of `sample`.
Variation read_varied(const Node::Entry& entry);
Variation read_sampled(const Node::Entry& entry);

}  // namespace mixloop
