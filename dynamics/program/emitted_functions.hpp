// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string>
#include <utility>

#include "dynamics/program/routine.hpp"
#include "dynamics/program/shared_object.hpp"

namespace mixloop {

/// The functions of an emitted program in its loaded library (source.hpp). Time is a double, or a pointer to
/// one a lane.
template <class Time>
class EmittedFunctions {
 public:
  using Evaluate = void (*)(const double*, const double*, const double*, Time, const double*, double*);

  /// False for an empty library, or with a complaint when a function is missing. `name` is the evaluation's.
  bool load(SharedObject library, const std::string& prefix, const std::string& name,
            std::string& complaint) {
    if (!library) return false;
    library_ = std::move(library);
    set_up_ = reinterpret_cast<SetUp>(library_.symbol(prefix + "_set_up"));
    evaluate_ = reinterpret_cast<Evaluate>(library_.symbol(name));
    for (StepsBy method : kStepsBy)
      steps_[static_cast<std::size_t>(method)] =
          reinterpret_cast<Steps>(library_.symbol(prefix + "_" + name_of(method)));
    const auto* count = static_cast<const int*>(library_.symbol(prefix + "_constants"));
    if (set_up_ == nullptr || evaluate_ == nullptr || count == nullptr) {
      complaint = "the built program lacks its functions";
      return false;
    }
    constants_ = static_cast<std::size_t>(*count);
    return true;
  }

  /// How many numbers the set-up leaves for evaluations.
  std::size_t constants() const { return constants_; }
  void set_up(std::span<const double> parameters, std::span<double> constants) const noexcept {
    set_up_(parameters.data(), constants.data());
  }
  Evaluate evaluate() const { return evaluate_; }
  /// By StepsBy; null where there is none.
  const StepsOfEach& steps() const { return steps_; }

 private:
  using SetUp = void (*)(const double*, double*);

  SharedObject library_;
  SetUp set_up_ = nullptr;
  Evaluate evaluate_ = nullptr;
  StepsOfEach steps_{};
  std::size_t constants_ = 0;
};

}  // namespace mixloop
