// SPDX-License-Identifier: MIT
#include "report/trajectory_reader.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <map>

#include "notation/errors.hpp"
#include "notation/long_work.hpp"

namespace mixloop {
namespace {

std::string_view mapped(const std::filesystem::path& file) {
  std::error_code failed;
  const auto size = std::filesystem::file_size(file, failed);
  const int fd = failed ? -1 : open(file.c_str(), O_RDONLY | O_CLOEXEC);
  void* at = fd >= 0 && size > 0 ? mmap(nullptr, size, PROT_READ, MAP_PRIVATE, fd, 0) : MAP_FAILED;
  if (fd >= 0) close(fd);
  if (at == MAP_FAILED)
    throw InputError("cannot_read", {file.string()},
                     "is empty or can't be read; expected the trajectory.csv that --out keeps");
  madvise(at, size, MADV_SEQUENTIAL);
  return {static_cast<const char*>(at), size};
}

std::vector<std::string_view> split(std::string_view line) {
  std::vector<std::string_view> names;
  for (std::size_t from = 0; from <= line.size();) {
    const std::size_t to = std::min(line.find(',', from), line.size());
    names.push_back(line.substr(from, to - from));
    from = to + 1;
  }
  return names;
}

/// Where in a tick the columns of these names go.
std::map<std::string, double*, std::less<>> places_in(Tick& tick) {
  std::map<std::string, double*, std::less<>> places = {{"t", &tick.t},
                                                        {"kinetic_energy", &tick.kinetic_energy},
                                                        {"potential_energy", &tick.potential_energy},
                                                        {"work", &tick.work}};
  for (const auto& [what, values] : kByCoordinate)
    for (std::size_t i = 0; i < (tick.*values).size(); ++i)
      places[fmt::format("{}_{}", what, i + 1)] = &(tick.*values)[i];
  for (const auto& [kind, motion] : kMotions)
    for (const auto& [what, vector] : kOfAMotion)
      for (int axis = 0; axis < 3; ++axis)
        places[fmt::format("{}_{}_{}", what, "xyz"[axis], kind)] = &(tick.*motion.*vector)[axis];
  return places;
}

}  // namespace

TrajectoryReader::TrajectoryReader(const std::filesystem::path& file) : file_(file), text_(mapped(file)) {
  const std::size_t end = std::min(text_.find('\n'), text_.size());
  names_ = split(text_.substr(0, end));
  at_ = std::min(end + 1, text_.size());
  const auto columns = [&](const char* name) {
    std::size_t count = 0;
    while (std::ranges::find(names_, fmt::format("{}_{}", name, count + 1)) != names_.end()) ++count;
    return count;
  };
  sizes_ = {.n = columns("psi"), .n_u = columns("tau")};
  const bool has_torques =
      std::ranges::any_of(names_, [](const auto& name) { return name.starts_with("tau_"); });
  if (sizes_.n_u == 0 && has_torques) sizes_.n_u = sizes_.n;
  if (names_.front() == "t" && sizes_.n > 0) return;
  const InputError error("not_a_trajectory", {file.string(), 1},
                         "no header that begins with t,psi_1; expected the trajectory.csv that --out keeps");
  munmap(const_cast<char*>(text_.data()), text_.size());
  throw error;
}

TrajectoryReader::~TrajectoryReader() { munmap(const_cast<char*>(text_.data()), text_.size()); }

void TrajectoryReader::read(std::size_t m, const std::function<void(Tick&)>& on_tick) {
  Tick tick({.n = sizes_.n, .n_u = sizes_.n_u, .m = m});
  const auto known = places_in(tick);
  std::vector<double*> places;  // null for a column that a tick has no place for
  for (const auto& name : names_) {
    const auto at = known.find(name);
    places.push_back(at == known.end() ? nullptr : at->second);
  }

  const char *at = text_.data() + at_, *const end = text_.data() + text_.size();
  for (int line = 2; at < end; ++line, ++tick.k) {
    work_goes_on("reading a trajectory", at - text_.data(), static_cast<std::int64_t>(text_.size()));
    tick.actual = {};
    tick.kinetic_energy = tick.command_age = kUnknown;
    for (std::size_t i = 0; i < places.size(); ++i) {
      double value = kUnknown;
      const auto [stop, error] = std::from_chars(at, end, value);
      const char behind = i + 1 < places.size() ? ',' : '\n';
      if (error != std::errc() || (stop == end ? behind != '\n' : *stop != behind))
        throw InputError("not_a_trajectory", {file_.string(), line},
                         fmt::format("no number for {} ({} columns are expected; is the file cut off?)",
                                     names_[i], names_.size()));
      if (places[i]) *places[i] = value;
      at = stop == end ? end : stop + 1;
    }
    on_tick(tick);
  }
}

}  // namespace mixloop
