// SPDX-License-Identifier: MIT
#pragma once

#include <mixloop/experiment.hpp>

namespace mixloop::v1 {

/// An experiment's control law under its safety settings. One thread at a time uses one; a copy is another's.
class MIXLOOP_API Controller {
 public:
  /// Makes its model ready, as Equations does. Throws Error.
  explicit Controller(const Experiment& experiment);
  Controller(const Controller&);               ///< remembers what the other does
  Controller(Controller&&) noexcept;           ///< the other may only be assigned to or destroyed
  Controller& operator=(Controller) noexcept;  ///< copies or moves
  ~Controller();

  /// tau (n_u, N m or N) for what is measured and desired. Allocates nothing. Throws Error("wrong_size").
  void torque(const State& measured, const Reference& desired, std::span<double> tau);

 private:
  struct Content;
  std::unique_ptr<Content> content_;
};

}  // namespace mixloop::v1
