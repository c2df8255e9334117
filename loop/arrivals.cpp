// SPDX-License-Identifier: MIT
#include "loop/arrivals.hpp"

#include <fmt/format.h>

#include <fstream>
#include <sstream>

#include "loop/measured_state.hpp"
#include "loop/simulate.hpp"
#include "notation/errors.hpp"

namespace mixloop {
namespace {

constexpr const char* kHeader = "tick,offset_ns,command";

Arrival arrival_in(const std::string& line, const Place& place) {
  Arrival arrival;
  char comma = 0, other = 0, rest = 0;
  std::istringstream in(line);
  if (!(in >> arrival.tick >> comma >> arrival.offset >> other >> arrival.command) || comma != ',' ||
      other != ',' || in >> rest)
    throw InputError("invalid_arrival", place,
                     fmt::format("found '{}'; expected three whole numbers: {}", line, kHeader));
  return arrival;
}

}  // namespace

void write_arrivals(const std::filesystem::path& file, const std::vector<Arrival>& arrivals) {
  std::ofstream out(file);
  out << kHeader << '\n';
  for (const Arrival& a : arrivals) out << a.tick << ',' << a.offset << ',' << a.command << '\n';
  if (!out.flush()) throw RunFault("cannot_write", "cannot write " + file.string());
}

std::vector<Arrival> read_arrivals(const std::filesystem::path& file) {
  std::ifstream in(file);
  if (!in) throw InputError("no_such_file", {file.string()}, "cannot be read; expected a run's ages.csv");
  std::string line;
  int number = 1;
  if (!std::getline(in, line) || line != kHeader)
    throw InputError("invalid_arrival", {file.string(), number},
                     fmt::format("found '{}'; expected the header {}", line.substr(0, 60), kHeader));
  std::vector<Arrival> arrivals;
  while (std::getline(in, line)) {
    const Place place{file.string(), ++number};
    const Arrival arrival = arrival_in(line, place);
    const bool sound = arrival.command >= 0 && arrival.command <= arrival.tick && arrival.offset >= 0;
    const bool later =
        arrivals.empty() ? arrival.command == 0
                         : arrival.command > arrivals.back().command && arrival.tick >= arrivals.back().tick;
    if (!sound || !later)
      throw InputError("out_of_range", place,
                       "a command cannot arrive before its state, before an older one, or without command 0 "
                       "before it");
    arrivals.push_back(arrival);
  }
  if (arrivals.empty()) throw InputError("missing_entry", {file.string(), number}, "no arrivals");
  return arrivals;
}

void simulate_arrivals(const Experiment& experiment, const Plan& plan, const std::vector<Arrival>& arrivals,
                       Recorder& recorder, const std::function<bool(std::int64_t k)>& go_on) {
  DeadlinePlant hardware = make_deadline_plant(experiment, plan);
  Plant& plant = hardware.plant();
  MeasuredState measured(plant);
  GuardedController controller = make_guarded_controller(experiment);
  require_start(controller, plant.psi(), plan);
  const auto n = static_cast<std::size_t>(experiment.scene->n());
  std::vector<double> commands(static_cast<std::size_t>(plan.ticks() + 1) * n);
  const auto command = [&](std::int64_t k) {
    return std::span(commands).subspan(static_cast<std::size_t>(k) * n, n);
  };
  auto next = arrivals.begin();

  if (!recorder.state(0, plant.psi(), plant.psid(), plant.work())) return;
  for (std::int64_t k = 0; k <= plan.ticks(); ++k) {
    if (!go_on(k)) return recorder.interrupted();
    // Only a state that was answered did anything: where a limit on torque rates remembers, that counts.
    measured.take(plant);
    controller.torque(measured.psi(), measured.psid(), measured.stale(), plan.at(k), plant.time(), command(k));
    recorder.note_changes(k, plant.faults());
    const bool was_safe = hardware.safe().has_value();
    for (; next != arrivals.end() && next->tick == k; ++next)
      hardware.command(next->command, next->offset, command(next->command));
    hardware.finish_tick();
    if (!was_safe && hardware.safe()) recorder.made_safe(k + 1);
    if (!recorder.command(k, hardware.commanded(), plant.applied())) return;
    if (k < plan.ticks() && !recorder.state(k + 1, plant.psi(), plant.psid(), plant.work())) return;
  }
}

}  // namespace mixloop
