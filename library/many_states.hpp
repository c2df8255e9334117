// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <vector>

#include "dynamics/equations.hpp"
#include "dynamics/program/lanes.hpp"

namespace mixloop::inside {

/// One purpose's evaluation on any number of states, in lanes. False where its code can't be had.
class ManyStates {
 public:
  ManyStates(const Equations& equations, Purpose purpose, std::span<const double> parameters);

  explicit operator bool() const { return code_ != nullptr; }
  void set_parameters(std::span<const double> parameters);

  /// Of at.t.size() states, their values one state after the other; psid and input may be empty, for zeros.
  Status evaluate(const LaneArguments& at, std::span<double> out);

 private:
  /// A number's lanes stand next to each other, a state's numbers in the caller's rows.
  struct Rows {
    std::size_t numbers = 0;      ///< a state
    std::vector<double> lanes{};  ///< numbers * width
    void take(std::span<const double> all, std::size_t first, std::size_t states, std::size_t width);
    void put(std::span<double> all, std::size_t first, std::size_t states, std::size_t width) const;
  };

  std::shared_ptr<const LaneCode> code_;
  std::vector<double> constants_;
  Rows psi_, psid_, input_, t_, out_;
};

}  // namespace mixloop::inside
