// SPDX-License-Identifier: MIT
#include "integrators/method.hpp"

#include <algorithm>
#include <cmath>

#include "integrators/integrator.hpp"

namespace mixloop {
namespace {

template <class Table>
std::vector<double> nodes_of() {
  std::vector<double> nodes;
  for (const char* c : Table::kC) nodes.push_back(coefficient<double>(c));
  return nodes;
}

}  // namespace

template class Integrator<double>;

const std::vector<MethodFacts>& all_methods() {
  // Held against the methods themselves by tests/integrators/stability_test.cpp.
  static const std::vector<MethodFacts> methods = {
      {Method::semi_implicit_euler, "semi_implicit_euler", 1, 1, 2, 2, false, false},
      {Method::leapfrog, "leapfrog", 2, 1, 1, 2, false, false},
      {Method::rk4, "rk4", 4, 4, 2.7853, 2.8284, false, false},
      {Method::dormand_prince, "dormand_prince", 5, 6, 3.3066, 0.9972, true, false},
      {Method::dop853, "dop853", 8, 12, 6.3937, 5.9604, true, false},
      {Method::gauss8, "gauss8", 8, 24, 3.6, 4.8, false, false},
      {Method::rodas3, "rodas3", 3, 3, HUGE_VAL, HUGE_VAL, false, true},
      {Method::rodas4, "rodas4", 4, 6, HUGE_VAL, HUGE_VAL, false, true},
  };
  return methods;
}

const MethodFacts& facts(Method method) { return all_methods()[static_cast<std::size_t>(method)]; }

std::vector<std::string> method_names() {
  std::vector<std::string> names;
  for (const auto& method : all_methods()) names.emplace_back(method.name);
  return names;
}

std::vector<double> stage_times(Method method) {
  switch (method) {
    case Method::semi_implicit_euler:
      return {0};
    case Method::leapfrog:
      return {0.5};
    case Method::rk4:
      return {0, 0.5, 0.5, 1};
    case Method::dormand_prince:
      return nodes_of<DormandPrinceTable>();
    case Method::dop853:
      return nodes_of<Dop853Table>();
    case Method::gauss8: {
      const auto& c = Gauss<double, 4>::table().c;
      return {c.begin(), c.end()};
    }
    case Method::rodas3:
      return {0, 0, 1, 1};
    case Method::rodas4:
      return {0, 0.386, 0.21, 0.63, 1, 1};
  }
  return {};
}

StageRows stage_rows(Method method) {
  const std::vector<double> times = stage_times(method);
  StageRows result;
  result.at = {0};
  for (const double c : times)
    if (c < 1) result.at.push_back(c);
  std::sort(result.at.begin(), result.at.end());
  result.at.erase(std::unique(result.at.begin(), result.at.end()), result.at.end());
  result.rows = static_cast<int>(result.at.size());
  for (int i = 0; i < result.rows; ++i)
    result.uniform &= result.at[static_cast<std::size_t>(i)] * result.rows == i;
  for (const double c : times)
    result.row.push_back(
        static_cast<int>(std::lower_bound(result.at.begin(), result.at.end(), c) - result.at.begin()));
  return result;
}

}  // namespace mixloop
