// SPDX-License-Identifier: MIT
#pragma once

#include <list>
#include <memory>

#include "commands/shared/launched.hpp"
#include "commands/shared/progress.hpp"

namespace mixloop {

/// The processes that a stranger provides to a launched run: says on stderr what is waited for and how one of
/// ours would be started, and how long it has been waited for, until each is heard.
class Awaited {
 public:
  /// `session`: the run's; 0 where the plant is the stranger's. What is passed must outlive it.
  Awaited(const Launch& launch, std::int64_t session);
  ~Awaited();
  Awaited(const Awaited&) = delete;
  Awaited& operator=(const Awaited&) = delete;

  /// Hears what there is, and tells how long it takes. True while somebody is still awaited.
  bool look();

 private:
  struct Ear {
    std::string process;
    std::int64_t session;
    bool heard = false;
    void on_message(Bytes bytes);
  };

  void tell();
  std::string names() const;

  const Launch& launch_;
  Bus bus_;
  std::list<Ear> ears_;  ///< the bus points into it
  Instant start_, told_;
  Progress progress_;
};

}  // namespace mixloop
