// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "dynamics/program/emitted_functions.hpp"
#include "dynamics/program/program.hpp"
#include "dynamics/program/routine.hpp"

namespace mixloop {

/// Programs of more operations are interpreted: a compiler takes about 0.3 s for a thousand, and machine code
/// gains least on long ones (docs/compiler.md).
constexpr std::size_t kMostCompiledOperations = 20000;

/// Whether there is a program, and it is short enough to compile.
bool is_compiled(const Program& program);

/// A program built by the system's compiler and loaded.
class MachineCode final : public Routine {
 public:
  /// The code kept under `key` (a text that says which program it is), else built from what `trace`
  /// returns; `trace` is not called otherwise. nullptr when it can't be had: no compiler, no private
  /// directory, a full disk, and `complaint` says which; or, with no complaint, a program too long.
  /// `steps_of`: as SourceStyle says.
  static std::unique_ptr<MachineCode> load(const std::string& key, const std::function<Program()>& trace,
                                           std::string& complaint, std::optional<int> steps_of = {});

  /// Why no machine code can be had here (no compiler, no private directory); empty where it can.
  static std::string hindrance();

  Memory make_memory() const override { return {std::vector<double>(emitted_.constants()), {}}; }
  void set_up(std::span<const double> parameters, Memory& memory) const noexcept override {
    emitted_.set_up(parameters, memory.numbers);
  }

 private:
  EmittedFunctions<double> emitted_;
};

}  // namespace mixloop
