// SPDX-License-Identifier: MIT
#pragma once

#include <gmock/gmock.h>

#include "tests/support/bad_input.hpp"

namespace mixloop {

/// Holds that `action` throws an InputError of this code, its message having that part.
inline void expect_refused_with(const std::string& code, const std::string& message,
                                const std::function<void()>& action) {
  const auto error = input_error(action);
  if (!error) return;
  EXPECT_EQ(error->code, code) << error->what();
  EXPECT_THAT(std::string(error->what()), testing::HasSubstr(message));
}

}  // namespace mixloop
