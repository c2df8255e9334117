// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <mixloop/error.hpp>

namespace mixloop::v1 {

/// A mechanism, checked (docs/scenes.md describes its file). Constant: copies share it, threads too. SI,
/// radians.
class MIXLOOP_API Scene {
 public:
  /// A number that stays variable, with its default in SI.
  struct Parameter {
    std::string name;  ///< as the file has it
    double value = 0;  ///< the default
  };

  /// Reads a scene file. `sets`: `key=value` as `--set` takes them, e.g. "parameters.payload=3 kg". Throws
  /// Error with file, line and column.
  static Scene load(const std::string& file, const std::vector<std::string>& sets = {});
  /// The same of a text; `name` stands for its file in errors.
  static Scene parse(std::string_view text, const std::string& name = "scene",
                     const std::vector<std::string>& sets = {});

  const std::string& name() const;  ///< the file's, unless it says another
  int n() const;                    ///< independent coordinates psi: the motors', then the free ones
  int n_u() const;                  ///< motors
  int m() const;                    ///< dependent coordinates q
  std::vector<std::string> independent() const;  ///< names, n
  std::vector<std::string> dependent() const;    ///< names, m
  std::vector<Parameter> parameters() const;     ///< in the file's order
  std::vector<double> home() const;              ///< psi, n, rad or m
  std::vector<std::string> warnings() const;     ///< `FILE:LINE:COLUMN: what`
  /// Of a text that is equal for equal mechanisms, 64 hexadecimal digits.
  std::string sha256() const;

 private:
  friend struct Inside;
  struct Content;
  explicit Scene(std::shared_ptr<const Content> content);
  std::shared_ptr<const Content> content_;
};

}  // namespace mixloop::v1
