// SPDX-License-Identifier: MIT
#include "import/xml_file.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "notation/text_file.hpp"
#include "notation/utf8.hpp"

namespace mixloop {
namespace {

constexpr std::size_t kLargestXml = 4 << 20;
constexpr int kDeepestXml = 64;

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

/// The offset behind the next `end` from `at` on; the text's end where there is none.
std::size_t behind(std::string_view text, std::string_view end, std::size_t at) {
  const auto found = text.find(end, at);
  return found == std::string_view::npos ? text.size() : found + end.size();
}

struct Attribute {
  std::string_view name;
  std::size_t offset = 0;
};

/// The attributes of the element whose `<` stands at `offset`; `end`: behind its `>`.
std::vector<Attribute> attributes_at(std::string_view text, std::size_t offset, std::size_t& end) {
  std::vector<Attribute> all;
  std::size_t at = offset + 1;
  while (at < text.size() && text[at] != '>') {
    if (text[at] == '"' || text[at] == '\'') {
      at = behind(text, text.substr(at, 1), at + 1);
      continue;
    }
    const std::size_t begin = at;
    while (at < text.size() && !is_blank(text[at]) &&
           std::string_view("=>\"'/").find(text[at]) == std::string_view::npos)
      ++at;
    if (at > begin) all.push_back({text.substr(begin, at - begin), begin});
    if (at == begin) ++at;
  }
  end = std::min(at + 1, text.size());
  if (!all.empty()) all.erase(all.begin());  // the element's own name
  return all;
}

/// Where the elements of a well-formed document begin, in the file's order.
std::vector<std::size_t> element_offsets(std::string_view text) {
  std::vector<std::size_t> offsets;
  std::size_t at = text.find('<');
  for (; at < text.size(); at = text.find('<', at)) {
    const std::string_view rest = text.substr(at);
    if (rest.starts_with("<!--")) {
      at = behind(text, "-->", at);
    } else if (rest.starts_with("<![CDATA[")) {
      at = behind(text, "]]>", at);
    } else if (rest.starts_with("<?") || rest.starts_with("<!") || rest.starts_with("</")) {
      at = behind(text, ">", at);
    } else {
      offsets.push_back(at);
      attributes_at(text, at, at);
    }
  }
  return offsets;
}

std::string reason_of(const tinyxml2::XMLDocument& document) {
  switch (document.ErrorID()) {
    case tinyxml2::XML_ERROR_MISMATCHED_ELEMENT:
      return "an element is not closed by an end tag of its own name";
    case tinyxml2::XML_ERROR_PARSING_ATTRIBUTE:
      return "an attribute is not name=\"value\"";
    case tinyxml2::XML_ERROR_PARSING_COMMENT:
      return "a comment without its end, -->";
    case tinyxml2::XML_ERROR_PARSING_CDATA:
      return "a CDATA section without its end, ]]>";
    default:
      return "a tag begins here that is none, or has no end";
  }
}

void refuse_invalid(const tinyxml2::XMLDocument& document, const std::string& file) {
  if (document.ErrorID() == tinyxml2::XML_ERROR_EMPTY_DOCUMENT)
    throw InputError("empty_file", {file}, "found nothing; expected XML");
  const Place place{file, document.ErrorLineNum()};
  if (document.ErrorID() == tinyxml2::XML_ELEMENT_DEPTH_EXCEEDED)
    throw InputError("too_deep", place,
                     fmt::format("elements in elements past {} levels; expected fewer", kDeepestXml));
  if (document.Error())
    throw InputError("invalid_xml", place, "no valid XML: " + reason_of(document) + "; expected XML");
  if (document.RootElement() == nullptr)
    throw InputError("invalid_xml", {file}, "no element in it; expected XML");
}

int depth_of(const XmlFile::Element& element) {
  int depth = 0;
  for (const auto* at = element.Parent(); at != nullptr; at = at->Parent()) ++depth;
  return depth;
}

void print_plain(const XmlFile::Element& element,
                 const std::function<bool(const XmlFile::Element&)>& is_left_out, tinyxml2::XMLPrinter& out) {
  if (is_left_out(element)) return;
  out.OpenElement(element.Name());
  for (const auto* one = element.FirstAttribute(); one != nullptr; one = one->Next()) {
    std::string value = one->Value();
    std::replace_if(value.begin(), value.end(), is_blank, ' ');
    out.PushAttribute(one->Name(), value.c_str());
  }
  for (const auto* child : children_of(element)) print_plain(*child, is_left_out, out);
  out.CloseElement();
}

}  // namespace

XmlFile::XmlFile(std::string text, const std::string& file) : text_(std::move(text)), file_(file) {
  require_text(text_, kLargestXml, "a robot, XML", file_);
  for (std::size_t at = 0; at < text_.size(); at = behind(text_, "\n", at)) line_starts_.push_back(at);
  document_.Parse(text_.data(), text_.size());
  refuse_invalid(document_, file_);
  const std::vector<std::size_t> offsets = element_offsets(text_);
  std::size_t count = 0;
  // Without a place where the two readings of the text disagree, which they never should.
  for (const auto* top = document_.FirstChildElement(); top != nullptr; top = top->NextSiblingElement())
    for_each_element(*top, [&](const Element& element) {
      if (count < offsets.size()) offsets_[&element] = offsets[count];
      ++count;
      if (depth_of(element) > kDeepestXml)
        throw InputError("too_deep", place(element),
                         fmt::format("elements in elements past {} levels; expected fewer", kDeepestXml));
    });
}

Place XmlFile::place_at(std::size_t offset) const {
  const auto next = std::upper_bound(line_starts_.begin(), line_starts_.end(), offset);
  return {file_, static_cast<int>(next - line_starts_.begin()),
          static_cast<int>(offset - *std::prev(next)) + 1};
}

Place XmlFile::place(const Element& element) const {
  const auto found = offsets_.find(&element);
  return found == offsets_.end() ? Place{file_, element.GetLineNum()} : place_at(found->second);
}

Place XmlFile::place(const Element& element, std::string_view attribute) const {
  const auto found = offsets_.find(&element);
  if (found == offsets_.end()) return place(element);
  std::size_t end = 0;
  for (const Attribute& one : attributes_at(text_, found->second, end))
    if (one.name == attribute) return place_at(one.offset);
  return place(element);
}

std::string XmlFile::plain_text(const std::function<bool(const Element&)>& is_left_out) const {
  tinyxml2::XMLPrinter out;
  print_plain(root(), is_left_out, out);
  return out.CStr();
}

std::optional<std::string> attribute_of(const XmlFile::Element& element, const char* name) {
  const char* value = element.Attribute(name);
  return value == nullptr ? std::nullopt : std::optional<std::string>(value);
}

std::vector<const XmlFile::Element*> children_of(const XmlFile::Element& element, const char* name) {
  std::vector<const XmlFile::Element*> children;
  for (const auto* child = element.FirstChildElement(name); child != nullptr;
       child = child->NextSiblingElement(name))
    children.push_back(child);
  return children;
}

void for_each_element(const XmlFile::Element& element,
                      const std::function<void(const XmlFile::Element&)>& call) {
  call(element);
  for (const auto* child : children_of(element)) for_each_element(*child, call);
}

}  // namespace mixloop
