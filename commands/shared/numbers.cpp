// SPDX-License-Identifier: MIT
#include "commands/shared/numbers.hpp"

#include <fmt/format.h>

#include "notation/words.hpp"

namespace mixloop {

std::vector<double> values_of(const std::string& text, const char* option,
                              std::span<const Scene::Independent> coordinates, const Quantity& quantity) {
  if (text.empty()) return std::vector<double>(coordinates.size(), 0.0);
  return read_values(parse_document("[" + text + "]", option), coordinates, quantity, option);
}

nlohmann::json rows(const Matrix& matrix) {
  auto json = nlohmann::json::array();
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    auto row = nlohmann::json::array();
    for (Eigen::Index j = 0; j < matrix.cols(); ++j) row.push_back(matrix(i, j));
    json.push_back(std::move(row));
  }
  return json;
}

nlohmann::json list(const Vector& vector) { return std::vector<double>(vector.begin(), vector.end()); }

void print_lines(const nlohmann::json& value, const std::string& name) {
  const bool matrix = value.is_array() && !value.empty() && value[0].is_array();
  if (value.is_object()) {
    for (const auto& [key, inner] : value.items()) print_lines(inner, name.empty() ? key : name + "." + key);
  } else if (value.is_string()) {
    fmt::print("{}\n  {}\n", name, value.get<std::string>());
  } else if (value.is_number()) {
    fmt::print("{}\n  {:.15g}\n", name, value.get<double>());
  } else if (matrix) {
    fmt::print("{}\n", name);
    for (const auto& row : value)
      fmt::print("  {}\n", joined("{: .15e}", row.get<std::vector<double>>(), "  "));
  } else if (!value.empty() && value[0].is_string()) {
    fmt::print("{}\n  {}\n", name, joined(value.get<std::vector<std::string>>(), "  "));
  } else {
    fmt::print("{}\n  {}\n", name, joined("{: .15e}", value.get<std::vector<double>>(), "  "));
  }
}

}  // namespace mixloop
