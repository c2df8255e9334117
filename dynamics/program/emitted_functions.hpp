// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string>
#include <utility>
#include <vector>

#include "dynamics/program/shared_object.hpp"

namespace mixloop {

/// The functions of an emitted program in its loaded library (source.hpp), and what its set-up part leaves
/// for evaluations. Time is a double, or a pointer to one a lane.
template <class Time>
class EmittedFunctions {
 public:
  /// False for an empty library, or with a complaint when a function is missing. `name` is the evaluation's.
  bool load(SharedObject library, const std::string& prefix, const std::string& name,
            std::string& complaint) {
    if (!library) return false;
    library_ = std::move(library);
    set_up_ = reinterpret_cast<SetUp>(library_.symbol(prefix + "_set_up"));
    evaluate_ = reinterpret_cast<Evaluate>(library_.symbol(name));
    const auto* count = static_cast<const int*>(library_.symbol(prefix + "_constants"));
    if (set_up_ == nullptr || evaluate_ == nullptr || count == nullptr) {
      complaint = "the built program lacks its functions";
      return false;
    }
    constants_.resize(static_cast<std::size_t>(*count));
    return true;
  }

  void set_up(std::span<const double> parameters) noexcept { set_up_(parameters.data(), constants_.data()); }
  void evaluate(const double* psi, const double* psid, const double* input, Time t,
                double* outputs) noexcept {
    evaluate_(psi, psid, input, t, constants_.data(), outputs);
  }

 private:
  using SetUp = void (*)(const double*, double*);
  using Evaluate = void (*)(const double*, const double*, const double*, Time, const double*, double*);

  SharedObject library_;
  SetUp set_up_ = nullptr;
  Evaluate evaluate_ = nullptr;
  std::vector<double> constants_;
};

}  // namespace mixloop
