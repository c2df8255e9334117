// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "dynamics/program/descriptor.hpp"

namespace mixloop {

struct Compiler;

/// A loaded library of emitted code.
class SharedObject {
 public:
  /// The library kept under the SHA-256 of `key`, compiler, flags and processor; built from what `source`
  /// returns (C++ text; an empty one is not built) where the cache has no sound one. On failure empty, and
  /// `complaint` says why.
  static SharedObject cached(const std::string& key, const std::function<std::string()>& source,
                             std::string& complaint);
  /// The same by this compiler.
  static SharedObject cached(const std::string& key, const std::function<std::string()>& source,
                             const Compiler& compiler, std::string& complaint);

  /// Why none can be had here, whatever it is: no compiler, no private cache; empty where it can.
  static std::string hindrance();

  explicit operator bool() const { return library_ != nullptr; }
  /// The address of an exported symbol; nullptr if there is none.
  void* symbol(const std::string& name) const;

 private:
  struct Close {
    void operator()(void* library) const;
  };
  Descriptor file_;  ///< open as long as the library is loaded: its name there is the descriptor's number
  std::unique_ptr<void, Close> library_;
};

}  // namespace mixloop
