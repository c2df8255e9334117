// SPDX-License-Identifier: MIT
#include "commands/studies/modules.hpp"

#include <dlfcn.h>

#include <cstdlib>
#include <string>

#include "notation/errors.hpp"
#include "processes/called_as.hpp"

namespace mixloop {
namespace {

/// A module's symbol, or null.
template <class Function>
Function loaded(const char* module, const char* symbol) {
  const std::string file = part(std::string(module) + ".so");
  // Its libraries' symbols are there for modules that these load in turn.
  void* const library = ::dlopen(file.c_str(), RTLD_NOW | RTLD_GLOBAL);
  return library == nullptr ? nullptr : reinterpret_cast<Function>(::dlsym(library, symbol));
}

/// As launchers say it to the processes that they start: OpenMPI's own, and those that speak PMI or PMIx.
bool is_started_by_mpi() {
  for (const char* name : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE"})
    if (const char* size = std::getenv(name); size != nullptr) return std::atoi(size) > 1;
  return std::getenv("PMIX_RANK") != nullptr;
}

}  // namespace

WriteColumns hdf5_here() {
  static const auto write = loaded<WriteColumns>("libmixloop_hdf5", kWriteHdf5Symbol);
  return write;
}

Peers* peers_here() {
  if (!is_started_by_mpi()) return nullptr;
  if (const auto make = loaded<MakePeers>("libmixloop_mpi", kPeersSymbol)) return make();
  const char* const why = ::dlerror();
  throw RunFault(
      "missing_part",
      std::string("MPI started this process, and there is no part for it here (") +
          (why == nullptr ? "no such symbol" : why) +
          "); expected mixloop built with libopenmpi-dev and run with openmpi-bin, or --shard I/N");
}

}  // namespace mixloop
