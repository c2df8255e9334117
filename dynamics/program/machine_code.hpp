// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "dynamics/program/program.hpp"
#include "dynamics/program/routine.hpp"
#include "dynamics/program/shared_object.hpp"

namespace mixloop {

/// A program built by the system's compiler and loaded.
class MachineCode final : public Routine {
 public:
  /// The code kept under `key` (a text that says which program it is), else built from what `trace`
  /// returns; `trace` is not called otherwise. nullptr when it can't be had: no compiler, no private
  /// directory, a full disk; `complaint` says which.
  static std::unique_ptr<MachineCode> load(const std::string& key, const std::function<Program()>& trace,
                                           std::string& complaint);

  void set_up(std::span<const double> parameters) noexcept override;
  void run(const double* psi, const double* psid, const double* input, double t, double* outputs) noexcept override;

 private:
  using SetUp = void (*)(const double*, double*);
  using Evaluate = void (*)(const double*, const double*, const double*, double, const double*, double*);

  SharedObject library_;
  SetUp set_up_ = nullptr;
  Evaluate evaluate_ = nullptr;
  std::vector<double> constants_;
};

}  // namespace mixloop
