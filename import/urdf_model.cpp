// SPDX-License-Identifier: MIT
#include "import/urdf_model.hpp"

#include <console_bridge/console.h>
#include <fmt/format.h>
#include <urdf_parser/urdf_parser.h>

#include "notation/utf8.hpp"

namespace mixloop {
namespace {

/// Keeps what urdfdom says while it lives; one at a time.
class Overheard : public console_bridge::OutputHandler {
 public:
  Overheard() { console_bridge::useOutputHandler(this); }
  ~Overheard() override { console_bridge::restorePreviousOutputHandler(); }
  Overheard(const Overheard&) = delete;
  Overheard& operator=(const Overheard&) = delete;

  void log(const std::string& text, console_bridge::LogLevel level, const char*, int) override {
    if (level >= console_bridge::CONSOLE_BRIDGE_LOG_ERROR && errors_.size() < 4) errors_.push_back(text);
  }
  /// The first is what went wrong, the others where.
  std::string text() const {
    std::string all;
    for (const std::string& one : errors_) all += (all.empty() ? "" : "; ") + in_quotes(one, 200);
    return all.empty() ? "without saying why" : all;
  }

 private:
  std::vector<std::string> errors_;
};

}  // namespace

bool is_left_out(const XmlFile::Element& element) {
  const std::string_view name = element.Name();
  if (name != "visual" && name != "collision") return name == "material";
  const auto* geometry = element.FirstChildElement("geometry");
  const auto* shape = geometry == nullptr ? nullptr : geometry->FirstChildElement();
  if (shape == nullptr) return true;
  const std::string_view kind = shape->Name();
  return kind != "box" && kind != "cylinder" && kind != "sphere" &&
         (kind != "mesh" || shape->Attribute("filename") == nullptr);
}

urdf::ModelInterfaceSharedPtr model_of(const XmlFile& file) {
  const Overheard heard;
  std::string reason;
  try {
    if (auto model = urdf::parseURDF(file.plain_text(is_left_out))) return model;
    reason = heard.text();
  } catch (const std::exception& error) {
    reason = in_quotes(error.what(), 200);
  }
  throw InputError("invalid_urdf", file.place(file.root()), "urdfdom refuses the file: " + reason);
}

}  // namespace mixloop
