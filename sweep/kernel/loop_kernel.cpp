// SPDX-License-Identifier: MIT
#include "sweep/kernel/loop_kernel.hpp"

#include "notation/errors.hpp"

namespace mixloop {

using mixloop_loop::Common, mixloop_loop::Each, mixloop_loop::Told;

LoopKernel::LoopKernel(const Symbol& symbol, int lanes) : lanes_(lanes) {
  if (lanes > 0)
    run_ = reinterpret_cast<Run>(symbol("closed_loops_" + std::to_string(lanes)));
  else
    run_all_ = reinterpret_cast<RunAll>(symbol("closed_loops_on_device"));
  for (std::size_t i = 0; i < kPrograms.size(); ++i) {
    set_up_[i] = reinterpret_cast<SetUp>(symbol(std::string(kPrograms[i]) + "_set_up"));
    const auto* count = static_cast<const int*>(symbol(std::string(kPrograms[i]) + "_constants"));
    constants_[i] = count ? static_cast<std::size_t>(*count) : 0;
  }
}

void LoopKernel::run(const Common& common, const Each& each, const Told& told) const {
  if (lanes_ > 0) {
    for (int first = 0; first < common.runs; first += lanes_) run_(&common, &each, &told, first);
    return;
  }
  if (const char* failure = run_all_(&common, &each, &told))
    throw RunFault("no_device", std::string("the graphics processor can't go through the runs: ") + failure +
                                    "; expected one of CUDA's with its driver, or --device cpu");
}

}  // namespace mixloop
