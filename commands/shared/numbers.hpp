// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json.hpp>

#include "dynamics/procedure/matrix.hpp"
#include "dynamics/scene/coordinate_values.hpp"

namespace mixloop {

/// `1,2,3` or `57 deg, 0, 10 cm`, one for each coordinate and in its unit; all zero when nothing was said.
std::vector<double> values_of(const std::string& text, const char* option,
                              std::span<const Scene::Independent> coordinates, const Quantity& quantity);

/// As JSON: nested rows; a list.
nlohmann::json rows(const Matrix& matrix);
nlohmann::json list(const Vector& vector);

/// A JSON object for a person: each name, and below it its numbers.
void print_lines(const nlohmann::json& value, const std::string& name = {});

}  // namespace mixloop
