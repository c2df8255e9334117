// SPDX-License-Identifier: MIT
#include "sweep/crew.hpp"

namespace mixloop {

Crew::Crew(const Setup& setup, const Telling& telling, const Engine& engine, int threads, Hands hands)
    : setup_(setup), telling_(telling), engine_(engine), hands_(std::move(hands)), at_work_(threads) {
  for (int i = 0; i < threads; ++i)
    threads_.emplace_back([this] {
      std::exception_ptr failure;
      try {
        work();
      } catch (...) {
        failure = std::current_exception();
        failed_ = true;
      }
      const std::lock_guard lock(state_);
      if (failure && !failure_) failure_ = failure;
      --at_work_;
      changed_.notify_all();
    });
}

Crew::~Crew() { failed_ = true; }

void Crew::work() {
  const auto goes_on = [&] { return !failed_ && hands_.goes_on(); };
  while (goes_on()) {
    const Runs runs = hands_.next();
    if (runs.count == 0) return;
    const auto outcomes = run_batch(setup_, telling_, engine_, runs.first, runs.count, goes_on);
    if (!failed_) hands_.brought(outcomes);
  }
}

bool Crew::ended_within(std::chrono::milliseconds time) {
  std::unique_lock lock(state_);
  // Where one has failed, others may wait for what it had in hand.
  changed_.wait_for(lock, time, [&] { return at_work_ == 0 || failure_; });
  if (failure_) std::rethrow_exception(failure_);
  return at_work_ == 0;
}

}  // namespace mixloop
