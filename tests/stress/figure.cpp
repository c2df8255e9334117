// SPDX-License-Identifier: MIT
#include "tests/stress/figure.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>

namespace mixloop::stress {

bool full_length() {
  static const bool full = [] {
    const char* said = std::getenv("MIXLOOP_STRESS");
    return said != nullptr && std::string_view(said) == "full";
  }();
  return full;
}

std::string text_of(const char* name, std::span<const double> values) {
  std::string text = fmt::format("{} =", name);
  for (const double value : values)
    text += fmt::format("{} {:.17g}", &value == values.data() ? "" : ",", value);
  return text;
}

Figure::Figure(std::string name, std::string unit, double bound, std::int64_t planned)
    : name_(std::move(name)),
      unit_(std::move(unit)),
      bound_(bound),
      planned_(planned),
      on_terminal_(::isatty(STDERR_FILENO) == 1),
      said_(std::chrono::steady_clock::now()) {}

void Figure::tick() {
  ++samples_;
  if (!on_terminal_) return;
  const auto now = std::chrono::steady_clock::now();
  if (now - said_ < std::chrono::milliseconds(200)) return;
  said_ = now;
  fmt::print(stderr, "\r{}: {} of {}, worst {:.3g}\033[K", name_, samples_, planned_, worst_);
}

Figure::~Figure() {
  if (on_terminal_) fmt::print(stderr, "\r\033[K");
  const bool held = worst_ <= bound_ && samples_ > 0;
  const std::string figure = fmt::format("{:.3g}", worst_);
  fmt::print("stress\t{}\t{}\t{}\t{:.3g}\t{}\t{}\t{}\t{}\n", name_, samples_, figure, bound_,
             held ? "held" : "missed", unit_, note_, where_);
  std::fflush(stdout);
  ::testing::Test::RecordProperty(name_, figure);
  EXPECT_TRUE(held) << name_ << ": " << figure << " " << unit_ << " over a bound of " << bound_ << "; "
                    << samples_ << " samples; worst at " << where_;
}

}  // namespace mixloop::stress
