// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstdint>
#include <limits>
#include <span>
#include <string>

namespace mixloop::stress {

/// Round-off, relative.
inline constexpr double kEps = std::numeric_limits<double>::epsilon();

/// Whether the cases run at full length: tools/stress sets MIXLOOP_STRESS=full. As tests they are samples.
bool full_length();
inline std::int64_t length(std::int64_t sample, std::int64_t full) { return full_length() ? full : sample; }

/// "psi = 1, 2, 3", with all digits, to try it again.
std::string text_of(const char* name, std::span<const double> values);

/// What a case measures: the worst of a figure beside its bound, and where that was. At the end it prints a
/// line (tools/stress makes its table of them), keeps it as a property of the test, and fails the test where
/// the bound is missed.
class Figure {
 public:
  /// `planned`: how many values will come, for the progress on a terminal.
  Figure(std::string name, std::string unit, double bound, std::int64_t planned);
  ~Figure();
  Figure(const Figure&) = delete;
  Figure& operator=(const Figure&) = delete;

  /// Takes a value; `where()` says seed and state, and is asked only of the worst so far. NaN is infinite.
  template <class Where>
  void look(double value, const Where& where) {
    tick();
    if (value <= worst_) return;
    worst_ = value == value ? value : 1.0 / 0.0;
    where_ = where();
  }
  double worst() const { return worst_; }
  /// What is said beside the figure, e.g. what it cost.
  void note(std::string text) { note_ = std::move(text); }

 private:
  void tick();

  std::string name_, unit_, where_, note_;
  double bound_, worst_ = 0;
  std::int64_t planned_, samples_ = 0;
  bool on_terminal_;
  std::chrono::steady_clock::time_point said_;
};

}  // namespace mixloop::stress
