// SPDX-License-Identifier: MIT
#include "loop/result.hpp"

#include <fmt/format.h>
#include <gnu/libc-version.h>
#include <sys/utsname.h>

#include <fstream>
#include <thread>

#include "notation/sha256.hpp"

namespace mixloop {
namespace {

std::string processor() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);)
    if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
  return "unknown";
}

/// What a run's times depend on.
nlohmann::json machine() {
  utsname system{};
  uname(&system);
  return {{"processor", processor()},
          {"cores", std::thread::hardware_concurrency()},
          {"kernel", std::string(system.sysname) + " " + system.release}};
}

/// Each bound beside what was measured.
nlohmann::json bounds_json(const Expectation& expect, const Measures& measures) {
  auto list = nlohmann::json::array();
  for (const auto& bound : expect.bounds) {
    const double value = bound.value_in(measures);
    list.push_back({{"name", bound.name},
                    {"least", bound.least},
                    {"most", bound.most},
                    {"value", value},
                    {"held", value >= bound.least && value <= bound.most}});
    if (bound.motor >= 0) list.back()["motor"] = bound.motor;
  }
  return list;
}

nlohmann::json integrator_json(const Experiment& experiment) {
  const PlantSettings& plant = experiment.plant;
  nlohmann::json json = {{"name", facts(plant.integrator).name}, {"substeps", plant.substeps}};
  if (plant.local_error > 0)
    json = {{"name", facts(plant.integrator).name}, {"local_error", plant.local_error}};
  if (const auto& choice = experiment.integrator_choice)
    json["chosen"] = {{"local_error", choice->asked}, {"estimate", choice->estimate}, {"why", choice->why}};
  return json;
}

}  // namespace

Verdict judge(const Experiment& experiment, const Measures& measures) {
  Verdict verdict;
  if (measures.interrupted_at) return {"interrupted", {}, kInterrupted};
  verdict.missed = missed(experiment.expect, measures);
  if (measures.diverged_at) {
    verdict.word = verdict.missed.empty() ? "held" : "diverged";
    verdict.exit_status = kRunFault;
    return verdict;
  }
  if (measures.safe_at) {
    verdict.word = verdict.missed.empty() ? "held" : "safe_state";
    verdict.exit_status = kRunFault;
    return verdict;
  }
  verdict.word = verdict.missed.empty() ? "held" : "missed";
  verdict.exit_status = verdict.missed.empty() ? kHeld : kMissed;
  return verdict;
}

nlohmann::json result_json(const Experiment& experiment, const Measures& measures, const std::string& route,
                           double wall_time) {
  const Verdict verdict = judge(experiment, measures);
  nlohmann::json json = {
      {"experiment", experiment.name},
      {"max_position_error", measures.max_position_error},
      {"time_of_max_position_error", measures.time_of_max_position_error},
      {"final_position_error", measures.final_position_error},
      {"rms_position_error", measures.rms_position_error},
      {"max_torque", std::vector<double>(measures.max_torque.begin(), measures.max_torque.end())},
      {"ticks", measures.ticks},
      {"trajectory_sha256", measures.trajectory_sha256},
      {"wall_time", wall_time},
      {"verdict", verdict.word},
      {"missed", verdict.missed},
      {"exit_status", verdict.exit_status},
      {"route", route},
      {"evaluation", name_of(experiment.evaluation)},
      {"rate", experiment.rate_hz},
      {"scene", experiment.scene->name},
      {"scene_sha256", sha256_hex(experiment.scene->canonical)},
      {"parameters", nlohmann::json::object()},
      {"versions",
       {{"mixloop", MIXLOOP_VERSION},
        {"compiler", __VERSION__},
        {"c_library", gnu_get_libc_version()},
        {"eigen", fmt::format("{}.{}.{}", EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION)},
        {"processor", processor()}}},
      {"machine", machine()},
      {"bounds", bounds_json(experiment.expect, measures)},
      {"expects_divergence", experiment.expect.diverges},
  };
  json["integrator"] = integrator_json(experiment);
  if (experiment.plant.random()) json["seed"] = experiment.plant.seed;
  for (std::size_t i = 0; i < experiment.scene->parameters.size(); ++i)
    json["parameters"][experiment.scene->parameters[i].name] = experiment.plant_parameters[i];
  if (measures.diverged_at) json["diverged_at"] = *measures.diverged_at;
  if (measures.safe_at) json["safe_at"] = *measures.safe_at;
  if (measures.interrupted_at) json["interrupted_at"] = *measures.interrupted_at;
  return json;
}

std::string summary(const Experiment& experiment, const nlohmann::json& result) {
  std::string text = fmt::format("{}: {}\n", experiment.name, result.at("verdict").get<std::string>());
  if (result.contains("diverged_at"))
    text += fmt::format(
        "  diverged at {:.6g} s: the position error passed {:.6g} mm or a value was not finite; nothing of "
        "that tick was published\n",
        result.at("diverged_at").get<double>(), experiment.position_error_limit * 1e3);
  if (result.contains("safe_at"))
    text += fmt::format("  safe state from {:.6g} s on{}; what follows is judged up to there\n",
                        result.at("safe_at").get<double>(),
                        result.contains("safe_cause") ? ": " + result["safe_cause"].get<std::string>() : "");
  if (result.contains("interrupted_at"))
    text += fmt::format("  interrupted at {:.6g} s; what follows is up to there\n",
                        result.at("interrupted_at").get<double>());
  text += fmt::format("  position error   max {:.7f} mm at {:.6g} s, final {:.7f} mm, rms {:.7f} mm\n",
                      result.at("max_position_error").get<double>() * 1e3,
                      result.at("time_of_max_position_error").get<double>(),
                      result.at("final_position_error").get<double>() * 1e3,
                      result.at("rms_position_error").get<double>() * 1e3);
  text += "  max torque      ";
  for (const auto& value : result.at("max_torque")) text += fmt::format(" {:.5f}", value.get<double>());
  text += " N m\n";
  text +=
      fmt::format("  {} ticks at {:g} Hz by {} in {:.3f} s ({})\n", result.at("ticks").get<std::int64_t>(),
                  experiment.rate_hz, result.at("route").get<std::string>(),
                  result.at("wall_time").get<double>(), result.at("evaluation").get<std::string>());
  if (const auto& integrator = result.at("integrator"); integrator.contains("chosen"))
    text += "  integrator       " + integrator.at("chosen").at("why").get<std::string>() + "\n";
  text += "  trajectory       " + result.at("trajectory_sha256").get<std::string>() + "\n";
  for (const auto& line : result.at("missed")) text += "  missed: " + line.get<std::string>() + "\n";
  return text;
}

}  // namespace mixloop
