// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

namespace mixloop {

/// Whether a peer was started with the same things. One message can be damaged or a stranger's, so only
/// three in a row with the same other config tell a difference; once the peer has agreed, who waits for it
/// says when that counts.
class ConfigAgreement {
 public:
  /// Takes the `config` of a message of the peer's; true where it is `mine`.
  bool hears(std::int64_t mine, std::int64_t theirs) {
    if (theirs == mine) {
      in_a_row_ = 0;
      return agreed_ = true;
    }
    in_a_row_ = theirs == theirs_ ? in_a_row_ + 1 : 1;
    theirs_ = theirs;
    return false;
  }

  bool refuted() const { return !agreed_ && contradicted(); }
  /// Another config was the last to be heard, as often as is needed, whether or not the peer had agreed.
  bool contradicted() const { return in_a_row_ >= kEnough; }
  /// The config last heard that wasn't mine.
  std::int64_t theirs() const { return theirs_; }

 private:
  static constexpr int kEnough = 3;

  std::int64_t theirs_ = 0;
  int in_a_row_ = 0;
  bool agreed_ = false;
};

}  // namespace mixloop
