// SPDX-License-Identifier: MIT
#include "commands/peers.hpp"

#include <dlfcn.h>

#include <cstdlib>
#include <string>

#include "notation/errors.hpp"
#include "processes/called_as.hpp"

namespace mixloop {
namespace {

/// As launchers say it to the processes that they start: OpenMPI's own, and those that speak PMI or PMIx.
bool is_started_by_mpi() {
  for (const char* name : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE"})
    if (const char* size = std::getenv(name); size != nullptr && std::atoi(size) > 1) return true;
  return std::getenv("PMIX_RANK") != nullptr && std::getenv("OMPI_COMM_WORLD_SIZE") == nullptr;
}

}  // namespace

Peers* peers_here() {
  if (!is_started_by_mpi()) return nullptr;
  const std::string module = own_folder() + "/../" MIXLOOP_LIBDIR "/mixloop/libmixloop_mpi.so";
  // Its symbols are there for MPI's own modules, too.
  void* const loaded = ::dlopen(module.c_str(), RTLD_NOW | RTLD_GLOBAL);
  const auto make = loaded == nullptr ? nullptr : reinterpret_cast<MakePeers>(::dlsym(loaded, kPeersSymbol));
  if (make != nullptr) return make();
  const char* const why = ::dlerror();
  throw RunFault(
      "missing_part",
      std::string("MPI started this process, and this build has no part for it (") +
          (why == nullptr ? "no such module" : why) +
          "); expected mixloop built with libopenmpi-dev and run with openmpi-bin, or --shard I/N");
}

}  // namespace mixloop
