// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstring>
#include <stdexcept>
#include <string>
#include <string_view>

#include "sweep/runs.hpp"

namespace mixloop {

/// The first byte of a message between the processes of a sweep says what it is.
enum class PeerWord : char {
  hello = 'h',    ///< to who leads: the sweep's hash, then its name; it takes runs, one message each
  ready = 'r',    ///< ... it takes one more
  brought = 'b',  ///< ... Runs, then their outcomes' bytes
  alive = 'a',    ///< ... once a second; also from who leads
  failed = 'f',   ///< ... it can't go on, and why
  done = 'd',     ///< ... it has brought all that it had begun
  work = 'w',     ///< from who leads: Runs
  stop = 's',     ///< ... it is to bring what is begun, and no more
  end = 'e',      ///< ... it is to leave, all together ('1') or not ('0')
};

/// How often each says that it is still there.
inline constexpr std::chrono::seconds kBeat(1);

inline std::string message_of(PeerWord word, std::string_view rest = {}) {
  return std::string(1, static_cast<char>(word)) + std::string(rest);
}

inline std::string bytes_of(const Runs& runs) { return {reinterpret_cast<const char*>(&runs), sizeof runs}; }

/// Takes them off the front of a message.
inline Runs runs_in(std::string_view& bytes) {
  if (bytes.size() < sizeof(Runs)) throw std::invalid_argument("a message cut off");
  Runs runs;
  std::memcpy(&runs, bytes.data(), sizeof runs);
  bytes.remove_prefix(sizeof runs);
  return runs;
}

}  // namespace mixloop
