// SPDX-License-Identifier: MIT
#include "import/xml_numbers.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

#include "notation/look_alikes.hpp"
#include "notation/utf8.hpp"

namespace mixloop {
namespace {

constexpr bool kNeeded = true;

/// An attribute that holds numbers.
struct Numeric {
  const char* element;
  const char* attribute;
  std::size_t count;
  bool needed;
};
constexpr std::array kNumeric = {
    Numeric{"origin", "xyz", 3, false},        Numeric{"origin", "rpy", 3, false},
    Numeric{"axis", "xyz", 3, kNeeded},        Numeric{"limit", "lower", 1, false},
    Numeric{"limit", "upper", 1, false},       Numeric{"limit", "effort", 1, kNeeded},
    Numeric{"limit", "velocity", 1, kNeeded},  Numeric{"dynamics", "damping", 1, false},
    Numeric{"dynamics", "friction", 1, false}, Numeric{"mimic", "multiplier", 1, false},
    Numeric{"mimic", "offset", 1, false},      Numeric{"mass", "value", 1, kNeeded},
    Numeric{"inertia", "ixx", 1, kNeeded},     Numeric{"inertia", "iyy", 1, kNeeded},
    Numeric{"inertia", "izz", 1, kNeeded},     Numeric{"inertia", "ixy", 1, kNeeded},
    Numeric{"inertia", "ixz", 1, kNeeded},     Numeric{"inertia", "iyz", 1, kNeeded},
    Numeric{"box", "size", 3, kNeeded},        Numeric{"cylinder", "radius", 1, kNeeded},
    Numeric{"cylinder", "length", 1, kNeeded}, Numeric{"sphere", "radius", 1, kNeeded}};

std::vector<std::string> words_in(const std::string& text) {
  std::vector<std::string> words;
  std::istringstream in(text);
  for (std::string word; in >> word;) words.push_back(word);
  return words;
}

double number_of(const std::string& word, const Place& place, const char* attribute) {
  std::string_view digits = word;
  if (digits.starts_with('+')) digits.remove_prefix(1);
  double value = 0;
  const auto [end, failure] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (failure != std::errc() || end != digits.data() + digits.size() || !std::isfinite(value))
    throw InputError("wrong_kind", place,
                     fmt::format("'{}' has {}; expected a finite number, 0.5 or 5e-1, in kg, m, s and rad{}",
                                 attribute, in_quotes(word), look_alike_in(word)));
  return value;
}

std::vector<double> numbers_in(const XmlFile& file, const XmlFile::Element& element, const char* attribute,
                               std::size_t count) {
  const Place place = file.place(element, attribute);
  const std::vector<std::string> words = words_in(element.Attribute(attribute));
  if (words.size() != count)
    throw InputError(
        "wrong_size", place,
        fmt::format("'{}' has {} numbers; expected {}, parted by blanks", attribute, words.size(), count));
  std::vector<double> values;
  for (const std::string& word : words) values.push_back(number_of(word, place, attribute));
  return values;
}

void check_numbers_of(const XmlFile& file, const XmlFile::Element& element) {
  for (const Numeric& numeric : kNumeric) {
    if (element.Name() != std::string_view(numeric.element)) continue;
    if (element.Attribute(numeric.attribute) != nullptr)
      numbers_in(file, element, numeric.attribute, numeric.count);
    else if (numeric.needed)
      throw InputError("missing_key", file.place(element),
                       fmt::format("<{}> lacks '{}'", numeric.element, numeric.attribute));
  }
}

/// An <inertial> says all or nothing.
void check_inertial(const XmlFile& file, const XmlFile::Element& element) {
  if (element.Name() != std::string_view("inertial")) return;
  for (const char* part : {"mass", "inertia"})
    if (element.FirstChildElement(part) == nullptr)
      throw InputError("missing_key", file.place(element), fmt::format("<inertial> lacks <{}>", part));
}

}  // namespace

double number_in(const XmlFile& file, const XmlFile::Element* element, const char* attribute, double unless) {
  if (element == nullptr || element->Attribute(attribute) == nullptr) return unless;
  return numbers_in(file, *element, attribute, 1).front();
}

std::array<double, 3> triple_in(const XmlFile& file, const XmlFile::Element* element, const char* attribute,
                                std::array<double, 3> unless) {
  if (element == nullptr || element->Attribute(attribute) == nullptr) return unless;
  const auto values = numbers_in(file, *element, attribute, 3);
  return {values[0], values[1], values[2]};
}

void check_numbers(const XmlFile& file) {
  for (const auto* part : children_of(file.root()))
    if (part->Name() == std::string_view("link") || part->Name() == std::string_view("joint"))
      for_each_element(*part, [&](const XmlFile::Element& element) {
        check_numbers_of(file, element);
        check_inertial(file, element);
      });
}

}  // namespace mixloop
