// SPDX-License-Identifier: MIT
#include "loop/output_folder.hpp"

#include <array>
#include <fstream>
#include <string>

#include "notation/errors.hpp"

namespace mixloop {
namespace {

// The result first: without it what is left passes for no run.
constexpr std::array kRunFiles = {"result.json", "trajectory.csv", "inputs.json",
                                  "ages.csv",    "run.lcmlog",     "report.html"};

}  // namespace

void prepare_folder(const std::filesystem::path& folder) {
  std::error_code failure;
  std::filesystem::create_directories(folder, failure);
  if (!std::filesystem::is_directory(folder))
    throw RunFault("cannot_write", "the folder " + folder.string() + " can't be made: " +
                                       (failure ? failure.message() : "a file has its name"));
  const auto probe = folder / ".mixloop-probe";
  const bool writable = std::ofstream(probe).put('x').good();
  std::filesystem::remove(probe, failure);
  if (!writable) throw RunFault("cannot_write", "cannot write into the folder " + folder.string());
}

void begin_run_folder(const std::filesystem::path& folder) {
  prepare_folder(folder);
  for (const std::string name : kRunFiles)
    for (const auto& file : {folder / name, folder / (name + ".part")}) {
      std::error_code failure;
      if (!std::filesystem::is_regular_file(std::filesystem::symlink_status(file, failure))) continue;
      std::filesystem::remove(file, failure);
      if (failure)
        throw RunFault("cannot_write",
                       "cannot replace " + file.string() + " of an earlier run: " + failure.message());
    }
}

}  // namespace mixloop
