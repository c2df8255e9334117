// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace mixloop {

/// How a plant integrates its equations of motion; each is a file of this folder.
enum class Method : std::uint8_t {
  semi_implicit_euler,
  leapfrog,
  rk4,
  dormand_prince,
  dop853,
  gauss8,
  rodas3,
  rodas4,
};

struct MethodFacts {
  Method method;
  std::string_view name;
  int order;
  int evaluations;     ///< of forward dynamics a step; of gauss8 about, it iterates
  double damper;       ///< largest -h lambda of a damper x'' = lambda x' that stays stable; HUGE_VAL: any
  double oscillation;  ///< largest h omega of an oscillation that does; HUGE_VAL: any
  bool error_control;  ///< has an estimate of its error: may choose its steps
  bool jacobian;       ///< takes the Jacobian of the forward dynamics, once a step
};

/// Of all, in the order of Method.
const std::vector<MethodFacts>& all_methods();
const MethodFacts& facts(Method method);
std::vector<std::string> method_names();

/// c of each stage, in steps.
std::vector<double> stage_times(Method method);

/// Where the stages of a step look up what is tabulated in time: `rows` places a step, `row[i]` the one of
/// stage i
/// (= rows: the next step's first). Uniform places stand at multiples of 1 / rows, others at `at` (ascending,
/// from 0).
struct StageRows {
  int rows = 1;
  std::vector<int> row;
  std::vector<double> at;
  bool uniform = true;
};
StageRows stage_rows(Method method);

}  // namespace mixloop
