// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "import/left_behind.hpp"

namespace mixloop {

struct ImportOptions {
  std::string name;  ///< of the files; the robot's own unless given
  std::string tip;   ///< the link that is the end effector; empty: the leaf that most joints move
  std::vector<std::string> free;  ///< joints without a motor
  bool any_inertia = false;       ///< takes inertias whose largest moment exceeds the sum of the others
};

/// A scene and an experiment with it.
struct Imported {
  std::string name;                                  ///< NAME of NAME.scene.yaml and NAME.experiment.yaml
  std::string scene, experiment;                     ///< their texts
  std::string root, tip;                             ///< links
  std::vector<std::string> leaves;                   ///< links that could be the tip as well
  std::vector<std::string> motors, free, following;  ///< as the scene calls them
  std::vector<std::pair<std::string, std::string>> renamed;
  LeftBehind left;
};

/// Makes a scene and an experiment of a URDF. Throws InputError, with line and column, for what is none.
Imported import_urdf(const std::string& text, const std::string& file, const ImportOptions& options);
/// Of a file.
Imported import_urdf_file(const std::string& file, const ImportOptions& options);

}  // namespace mixloop
