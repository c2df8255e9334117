// SPDX-License-Identifier: MIT
#include "commands/shared/overheard.hpp"

#include "commands/shared/attached.hpp"
#include "notation/errors.hpp"

namespace mixloop {

Overheard::Overheard(const Experiment& experiment, const BusOptions& bus, nanoseconds first_wait,
                     nanoseconds patience)
    : result_(std::async(std::launch::async, [this, &experiment, bus, first_wait, patience] {
        return attached(experiment, bus, first_wait, patience, over_);
      })) {}

Result Overheard::finish() {
  over_.turn();
  Result result = result_.get();
  if (result.session.value_or(0) == 0)
    throw RunFault("lost_peer", "nothing was measured: no plant of this experiment was heard");
  return result;
}

}  // namespace mixloop
