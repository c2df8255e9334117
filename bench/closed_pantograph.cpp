// SPDX-License-Identifier: MIT
#include "bench/closed_pantograph.hpp"

#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>

#include "dynamics/assembly/assemble.hpp"
#include "dynamics/scene/canonical.hpp"
#include "dynamics/scene/read_scene.hpp"
#include "notation/document.hpp"

namespace mixloop::bench {
namespace {

std::string without_line(const std::string& text, const std::string& beginning) {
  const std::size_t at = text.find(beginning);
  if (at == std::string::npos) throw std::runtime_error("mixed_loop_robot.yaml has no '" + beginning + "'");
  return text.substr(0, at) + text.substr(text.find('\n', at) + 1);
}

std::string behind(std::string text, const std::string& said, const std::string& more) {
  const std::size_t at = text.find(said);
  if (at == std::string::npos) throw std::runtime_error("mixed_loop_robot.yaml has no '" + said + "'");
  return text.insert(at + said.size(), more);
}

std::shared_ptr<const Scene> assembled(const std::string& text, bool from_starts) {
  Scene scene = read_scene(parse_document(text, "mixed_loop_robot.yaml"));
  scene.from_starts = from_starts;
  assemble(scene);
  scene.canonical = canonical_text(scene);
  return std::make_shared<const Scene>(std::move(scene));
}

}  // namespace

Pantographs pantographs() {
  std::ifstream file(MIXLOOP_SCENES "/mixed_loop_robot.yaml");
  std::string text{std::istreambuf_iterator<char>(file), {}};
  text = without_line(without_line(text, "  q4: "), "  q6: ");
  text = behind(text, "psi3: 992 deg", ", q4: 110 deg, q6: -60 deg");
  const auto closed = [&](const std::string& length) {
    return text + "\nclosures:\n  - {coincide: [{frame: 6}, {frame: 2, point: [" + length +
           "*cos(beta) - L2, -L5*sin(beta), 0]}], axes: [x, y]}\n";
  };
  const std::string by_parameter = behind(closed("stretch*L5"), "payload: 5 kg", "\n  stretch: 1");
  return {assembled(closed("L5"), false), assembled(by_parameter, false), assembled(by_parameter, true)};
}

}  // namespace mixloop::bench
