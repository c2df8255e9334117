// SPDX-License-Identifier: MIT
#pragma once

#include <tinyxml2.h>

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "notation/errors.hpp"

namespace mixloop {

/// An XML document with the places of its elements and attributes, which the parser forgets.
class XmlFile {
 public:
  using Element = tinyxml2::XMLElement;

  /// Throws InputError: "too_large" past 4 MiB, "not_text", "empty_file", "too_deep" past 64 levels,
  /// "invalid_xml".
  XmlFile(std::string text, const std::string& file);

  const Element& root() const { return *document_.RootElement(); }
  /// Of the element's `<`; of one of its attributes, or the element's where it hasn't that.
  Place place(const Element& element) const;
  Place place(const Element& element, std::string_view attribute) const;
  /// The elements alone but those that are left out, attributes on one line: nothing that another parser
  /// could stumble over.
  std::string plain_text(const std::function<bool(const Element&)>& is_left_out) const;

 private:
  Place place_at(std::size_t offset) const;

  std::string text_, file_;
  tinyxml2::XMLDocument document_;
  std::vector<std::size_t> line_starts_;
  std::unordered_map<const Element*, std::size_t> offsets_;
};

/// The value of an attribute, or nothing.
std::optional<std::string> attribute_of(const XmlFile::Element& element, const char* name);
/// The child elements of this name (of any where it is null), in the file's order.
std::vector<const XmlFile::Element*> children_of(const XmlFile::Element& element, const char* name = nullptr);
/// The elements below and with this one, parents first, in the file's order.
void for_each_element(const XmlFile::Element& element,
                      const std::function<void(const XmlFile::Element&)>& call);

}  // namespace mixloop
