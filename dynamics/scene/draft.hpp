// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "dynamics/scene/scene.hpp"
#include "notation/document.hpp"

namespace mixloop {

/// A scene while it is read: what its sections share.
struct SceneDraft {
  Scene scene;
  Scope fixed;   ///< parameters and constants
  Scope moving;  ///< and time, motors and coordinates
  std::map<std::string, int> coordinate_index;
  std::map<std::string, int> frame_index;
  std::set<int> bare_parameters;  ///< those whose default has no unit
  std::size_t terms = 0;          ///< of all formulas: constants are copied into each formula that names them

  /// The formula at `node`; throws InputError unless it is of dimension `wanted`, or when all formulas
  /// together have too many terms.
  Formula formula(const Node& node, const Dimension& wanted, const std::string& what, const Scope& scope);
  /// A parameter whose default has no unit is of the dimension that is expected where it stands alone; of
  /// none where two of those differ.
  void settle_parameter(const Formula& formula, const Dimension& wanted);
  /// Three of them, or zeros where the node is null.
  std::array<Formula, 3> vector(const NodePtr& node, const Dimension& wanted, const std::string& what,
                                const Scope& scope);
  /// An axis, as x, y or z or as constant numbers, not all of them zero; of any length.
  std::array<double, 3> axis(const NodePtr& node, const std::string& what);
  /// The frame that the entry names under `frame`.
  int frame(const Mapping& entry) const;
  /// The frame of this name; `what` sits on it.
  int frame_named(const Node& name, const std::string& what) const;
  /// The coordinate that is equal to an independent one and has its name; made where there is none yet.
  int as_coordinate(int independent);
  /// The coordinate that the entry names under `coordinate`.
  int coordinate(const Mapping& entry) const;
};

/// The mapping at `key` of a scene, or null where it is absent or empty; throws InputError for anything else.
const Node* section(const Mapping& root, const char* key);
/// Whether chains close, so that coordinates may go without a formula.
bool has_closures(const Mapping& root);
/// A list's items; throws InputError unless there are from `least` to `most`.
std::vector<NodePtr> items_within(const NodePtr& node, std::size_t least, std::size_t most,
                                  const std::string& what);
/// As check_name, and it may not be `t`, the time.
void check_symbol_name(const std::string& name, const Place& place);

// The sections, in the order in which their names depend on each other.
void read_parameters(const Mapping& root, SceneDraft& draft);
void read_constants(const Mapping& root, SceneDraft& draft);
void read_independent(const Mapping& root, SceneDraft& draft);
void read_constraints(const Mapping& root, SceneDraft& draft);
void read_transforms(const Mapping& root, SceneDraft& draft);
void read_bodies(const Mapping& root, SceneDraft& draft);
void read_loads(const Mapping& root, SceneDraft& draft);
void read_closures(const Mapping& root, SceneDraft& draft);
void read_solids(const Mapping& root, SceneDraft& draft);

}  // namespace mixloop
