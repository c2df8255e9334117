// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <unistd.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <set>

#include "commands/commands.hpp"
#include "commands/shared/progress.hpp"
#include "commands/studies/linear.hpp"
#include "loop/result.hpp"
#include "loop/review.hpp"
#include "notation/long_work.hpp"
#include "notation/number_text.hpp"
#include "notation/words.hpp"
#include "plant/hardware.hpp"
#include "processes/command_line.hpp"
#include "stability/confirmation.hpp"
#include "stability/map.hpp"
#include "sweep/written_value.hpp"

namespace mixloop {
namespace {

struct StabilityLine : CommonOptions {
  std::string experiment, picture;
  std::vector<std::string> vary;
  int poses = 21;
  bool no_confirmation = false;
  LinearLine linear;
};

/// One variant of the experiment: what it sets beside `--set`.
using Variant = std::vector<Override>;

std::string name_of(const Variant& variant) {
  std::string text;
  for (const auto& [key, value] : variant)
    text += fmt::format("{}{} = {}", text.empty() ? "" : ", ", key, value);
  return text.empty() ? "as it stands" : text;
}

/// Every combination of the varied values, the experiment as it stands first.
std::vector<Variant> combinations(const std::vector<std::string>& vary) {
  std::vector<Variant> all{{}};
  for (const auto& text : vary) {
    const auto [key, list] = parse_override(text);
    std::vector<Variant> longer;
    for (const auto& variant : all)
      for (const auto& value : parts_of(list)) {
        longer.push_back(variant);
        longer.back().push_back({key, value});
      }
    all = std::move(longer);
  }
  if (!vary.empty()) all.insert(all.begin(), Variant{});
  return all;
}

/// Without --vary: as it stands, and without each mass that is a parameter.
std::vector<Variant> unloaded(const Experiment& experiment) {
  std::vector<Variant> all{{}};
  const auto& parameters = experiment.scene->parameters;
  for (std::size_t i = 0; i < parameters.size(); ++i)
    if (parameters[i].dimension.same_powers(kMass) && experiment.plant_parameters[i] != 0)
      all.push_back({{"parameters." + parameters[i].name, "0 kg"}});
  return all;
}

nlohmann::json number(const std::optional<double>& value) {
  return value ? nlohmann::json(*value) : nlohmann::json(nullptr);
}

nlohmann::json numbers(const std::vector<std::optional<double>>& values) {
  nlohmann::json list = nlohmann::json::array();
  for (const auto& value : values) list.push_back(number(value));
  return list;
}

nlohmann::json as_json(const Limits& limits) {
  return {{"spectral_radius", limits.radius},
          {"fastest_pole", limits.fastest_pole},
          {"longest_tick", number(limits.longest_tick)},
          {"longest_tick_without_delay", number(limits.longest_tick_undelayed)},
          {"longest_delay", number(limits.longest_delay)},
          {"longest_rk4_step", number(limits.longest_rk4_step)},
          {"gain_margin", {{"most", number(limits.most_gain)}, {"least", number(limits.least_gain)}}},
          {"gain_margin_of_motor", numbers(limits.most_gain_of_motor)}};
}

nlohmann::json as_json(const PathLimits& limits) {
  return {{"spectral_radius", limits.radius},
          {"time_of_spectral_radius", limits.time_of_radius},
          {"longest_tick", number(limits.tick.value)},
          {"time_of_longest_tick", limits.tick.time},
          {"longest_delay", number(limits.delay.value)},
          {"time_of_longest_delay", limits.delay.time}};
}

/// What simulation makes of a limit: one hundredth below it, and one above.
nlohmann::json confirmation(const Experiment& experiment, const Plan& plan, const Limits& limits,
                            const Sampling& sampling) {
  nlohmann::json json;
  const auto around = [&](const std::optional<double>& limit, auto at) {
    if (!limit || *limit <= 0) return nlohmann::json(nullptr);
    return nlohmann::json{{"below", name_of(fate_of_disturbance(experiment, plan, at(0.99 * *limit)))},
                          {"above", name_of(fate_of_disturbance(experiment, plan, at(1.01 * *limit)))}};
  };
  json["longest_tick_without_delay"] = around(limits.longest_tick_undelayed, [](double tick) {
    return Sampling{tick, 0};
  });
  json["longest_delay"] = around(limits.longest_delay, [&](double delay) {
    return Sampling{sampling.tick, delay};
  });
  return json;
}

std::string milliseconds(const nlohmann::json& limit) {
  if (limit.is_null()) return "no limit";
  return limit == 0.0 ? "none works" : fixed(limit.get<double>() * 1e3, 3) + " ms";
}

std::string factor(const nlohmann::json& limit) {
  return limit.is_null() ? "no limit" : fmt::format("{:.3g}", limit.get<double>());
}

/// `on_path`: its instants are of one; else it is the state that is fed back about, and there is one column.
void print(const nlohmann::json& one, bool on_path) {
  if (one.contains("error")) {
    fmt::print("\n{}: impossible: {}\n", one.at("name").get<std::string>(),
               one["error"]["message"].get<std::string>());
    return;
  }
  fmt::print("\n{}: {}\n", one.at("name").get<std::string>(), one.at("verdict").get<std::string>());
  for (const auto& warning : one.at("warnings")) fmt::print("  warning: {}\n", warning.get<std::string>());
  const auto& start = one.at("at_start");
  const auto& path = one.at("along_path");
  const auto row = [&](const char* what, const std::string& at_start, const std::string& along,
                       const char* when) {
    if (on_path)
      fmt::print("  {:<44}{:>14}{:>14}  {:.3f} s\n", what, at_start, along, path[when].get<double>());
    else
      fmt::print("  {:<44}{:>14}\n", what, at_start);
  };
  if (on_path)
    fmt::print("  {:<44}{:>14}{:>14}  at\n", "", "at the start", "on the path");
  else
    fmt::print("  about the state that is fed back about\n");
  row("spectral radius a tick (stable below 1)", fixed(start["spectral_radius"].get<double>(), 6),
      fixed(path["spectral_radius"].get<double>(), 6), "time_of_spectral_radius");
  row("longest command delay at this tick", milliseconds(start["longest_delay"]),
      milliseconds(path["longest_delay"]), "time_of_longest_delay");
  row("longest tick at this delay", milliseconds(start["longest_tick"]), milliseconds(path["longest_tick"]),
      "time_of_longest_tick");
  fmt::print("  {:<44}{:>14}\n", "longest tick without delay",
             milliseconds(start["longest_tick_without_delay"]));
  fmt::print("  {:<44}{:>14}\n", "longest RK4 step, control continuous",
             milliseconds(start["longest_rk4_step"]));
  fmt::print("  {:<44}{:>10} 1/s\n", "fastest pole, control continuous",
             fixed(start["fastest_pole"].get<double>(), 1));
  fmt::print("  {:<44}{:>14}\n", "largest factor on all gains", factor(start["gain_margin"]["most"]));
  fmt::print("  {:<44}{:>14}\n", "least factor on all gains",
             start["gain_margin"]["least"].is_null() ? "none needed" : factor(start["gain_margin"]["least"]));
  for (std::size_t i = 0; i < start["gain_margin_of_motor"].size(); ++i)
    fmt::print("  {:<44}{:>14}\n", fmt::format("largest factor on the gains of motor {}", i + 1),
               factor(start["gain_margin_of_motor"][i]));
  for (const auto& [what, fate] : one.at("confirmed").items())
    if (!fate.is_null())
      fmt::print("  simulated around {:<28} 1 % below: {}, 1 % above: {}\n", what,
                 fate["below"].get<std::string>(), fate["above"].get<std::string>());
}

/// Of the sampled loop, and of what the plant's steps make of it.
std::string verdict_of(const PathLimits& path, const std::optional<StepDoubt>& doubt) {
  return grows(path.radius) || (doubt && doubt->grows) ? "unstable"
         : path.radius >= 1 - kRadiusRounding          ? "marginal"
                                                       : "stable";
}

/// Where simulation and linearisation disagree, it is the plant's steps that do.
bool contradicts(const nlohmann::json& confirmed) {
  return std::any_of(confirmed.begin(), confirmed.end(), [](const nlohmann::json& fate) {
    return !fate.is_null() &&
           (fate.at("below") == name_of(Fate::grows) || fate.at("above") == name_of(Fate::decays));
  });
}

/// Of a motion without a path: that the state which is fed back about is none to stay in.
std::string not_at_rest(const Experiment& experiment, const Plan& plan) {
  const ControllerSettings& settings = experiment.controller;
  const PsiMotion at = wanted_state(settings, *experiment.scene, plan.at(0));
  Vector needed(experiment.scene->n());
  Equations::Workspace dynamics(
      equations_of(experiment.scene, experiment.evaluation, {Purpose::inverse_dynamics}),
      experiment.plant_parameters);
  dynamics.evaluate(Purpose::inverse_dynamics, {span_of(at.psi), span_of(at.psid), span_of(at.psidd), 0},
                    span_of(needed));
  const Vector given = settings.about_torque, of_motors = needed.head(given.size());
  const Vector of_free = needed.tail(needed.size() - given.size());
  const double size = 1e-9 + needed.cwiseAbs().maxCoeff();
  if (of_free.size() > 0 && of_free.cwiseAbs().maxCoeff() > 1e-6 * size)
    return fmt::format(
        "the state that is fed back about is no rest: it takes [{}] at the free coordinates, where no "
        "motor acts; the loop comes to rest elsewhere, if it does, and was looked at here",
        joined("{:.6g}", span_of(of_free)));
  if (at.psid.isZero(0) && (given - of_motors).cwiseAbs().maxCoeff() <= 1e-3 * size) return {};
  return fmt::format(
      "the state that is fed back about is no rest: it takes a torque of [{}] and has "
      "[{}] in about.torque; the loop comes to rest elsewhere, if it does, and was looked at "
      "here",
      joined("{:.6g}", span_of(of_motors)), joined("{:.6g}", span_of(given)));
}

class Study {
 public:
  explicit Study(const StabilityLine& options) : options_(options) {}

  nlohmann::json run() {
    const Experiment nominal = load({});
    const auto variants = options_.vary.empty() ? unloaded(nominal) : combinations(options_.vary);
    nlohmann::json json = {{"experiment", nominal.name},
                           {"tick", 1 / nominal.rate_hz},
                           {"command_delay", nominal.plant.command_delay},
                           {"control", nominal.plant.continuous ? "continuous" : "held"},
                           {"along", nominal.has_path() ? "path" : "state"},
                           {"warnings", nlohmann::json::array()},
                           {"cases", nlohmann::json::array()}};
    if (Hardware::needed(nominal.plant)) {
      json["warnings"].push_back(
          "sensors, actuators and faults are left out: the limits are those of ideal hardware");
      if (!options_.json) fmt::print(stderr, "warning: {}\n", json["warnings"][0].get<std::string>());
    }
    try {
      for (std::size_t i = 0; i < variants.size(); ++i) {
        say(fmt::format("case {} of {}: {}", i + 1, variants.size(), name_of(variants[i])));
        json["cases"].push_back(i == 0 ? study(variants[i]) : study_if_possible(variants[i]));
      }
    } catch (const Interrupted& interrupted) {
      json["interrupted"] = interrupted.what();
    }
    say("");
    if (!options_.picture.empty() && !json.contains("interrupted"))
      draw(maps_, {1 / nominal.rate_hz, nominal.plant.command_delay}, "Stability of " + nominal.name,
           options_.picture);
    return json;
  }

 private:
  Experiment load(const Variant& variant) const {
    auto overrides = options_.overrides();
    overrides.insert(overrides.end(), variant.begin(), variant.end());
    return load_experiment(std::filesystem::path(options_.experiment), overrides);
  }

  /// A variant may leave nothing to move, or nowhere to go: that is no mistake in the experiment.
  nlohmann::json study_if_possible(const Variant& variant) {
    const auto impossible = [&](const std::string& code, const char* what) {
      nlohmann::json json = {{"name", name_of(variant)},
                             {"set", nlohmann::json::object()},
                             {"verdict", "impossible"},
                             {"error", {{"code", code}, {"message", what}}}};
      for (const auto& [key, value] : variant) json["set"][key] = value;
      return json;
    };
    try {
      return study(variant);
    } catch (const InputError& error) {
      static const std::set<std::string> kOfTheValue = {"singular_mass",  "unreachable", "singular_path",
                                                        "crosses_branch", "over_limit",  "angle_jumps"};
      if (!kOfTheValue.contains(error.code)) throw;
      return impossible(error.code, error.what());
    } catch (const RunFault& fault) {
      if (fault.code != "singular") throw;
      return impossible(fault.code, fault.what());
    }
  }

  nlohmann::json study(const Variant& variant) {
    const Experiment experiment = load(variant);
    const Plan plan = make_plan(experiment);
    const Survey instants = survey(experiment, plan, options_.poses);
    say_complaint(instants.complaint);
    const Limits start = limits_of(instants.loops.front(), instants.sampling);
    const PathLimits path = path_limits(instants);
    const auto doubt = step_doubt(experiment, plan);
    maps_.push_back(stability_map(instants, name_of(variant)));
    const StabilityMap& map = maps_.back();
    nlohmann::json json = {
        {"name", name_of(variant)},
        {"set", nlohmann::json::object()},
        {"verdict", verdict_of(path, doubt)},
        {"warnings", nlohmann::json::array()},
        {"at_start", as_json(start)},
        {"along_path", as_json(path)},
        {"map", {{"tick", map.ticks}, {"delay", map.delays}, {"spectral_radius", map.radius}}},
        {"confirmed", nlohmann::json::object()}};
    for (const auto& [key, value] : variant) json["set"][key] = value;
    if (doubt) json["warnings"].push_back(doubt->text);
    if (!plan.has_path())
      if (const std::string off = not_at_rest(experiment, plan); !off.empty())
        json["warnings"].push_back(off);
    if (!options_.no_confirmation)
      json["confirmed"] = confirmation(experiment, plan, start, instants.sampling);
    if (contradicts(json["confirmed"])) {
      json["warnings"].push_back(
          "a disturbance grows in the simulation where the linearised loop is stable, or decays where it "
          "isn't: the "
          "plant's steps don't follow the plant");
      if (json["verdict"] != "unstable") json["verdict"] = "undecided";
    }
    return json;
  }

  /// What is at work, on a terminal.
  static void say(const std::string& text) {
    if (isatty(STDERR_FILENO) != 1) return;
    fmt::print(stderr, "\r{}\033[K", text);
    std::fflush(stderr);
  }

  const StabilityLine& options_;
  std::vector<StabilityMap> maps_;
};

int run(const StabilityLine& options) {
  StopSwitch stop;
  stop.turn_on_signals();
  const ShownWork work(stop);
  if (options.linear.asked) return tell_linear(options.linear, options.experiment, options);
  const nlohmann::json result = Study(options).run();
  const bool interrupted = result.contains("interrupted");
  if (options.json) {
    print_json(result);
  } else {
    fmt::print("{}: tick {:.3f} ms, command delay {:.3f} ms, control {}\n",
               result["experiment"].get<std::string>(), result["tick"].get<double>() * 1e3,
               result["command_delay"].get<double>() * 1e3, result["control"].get<std::string>());
    for (const auto& one : result["cases"]) print(one, result["along"] == "path");
    if (!options.picture.empty() && !interrupted) fmt::print("\ndrawn in {}\n", options.picture);
  }
  if (interrupted) {
    if (!options.json)
      fmt::print(stderr, "mixloop: interrupted; the cases that are not told were not looked at\n");
    return kInterrupted;
  }
  const auto& verdict = result["cases"][0]["verdict"];
  return verdict == "stable" || verdict == "marginal" ? kHeld : kMissed;
}

}  // namespace

void add_stability_command(CLI::App& command, int& status) {
  auto options = std::make_shared<StabilityLine>();
  add_experiment_option(command, options->experiment);
  add_common_options(command, *options);
  command
      .add_option(
          "--vary", options->vary,
          "an entry and the values that it takes in turn, key=v1,v2,...; may be repeated (unless given, "
          "each mass that is a parameter is taken away once)")
      ->type_name("KEY=VALUES")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  command.add_option("--poses", options->poses, "at how many instants of the path (21)")
      ->check(CLI::Range(2, 10'000))
      ->type_name("N");
  command
      .add_option("--picture", options->picture,
                  "draw where it is stable, delay over tick, in this .svg or .png")
      ->type_name("FILE");
  command.add_flag("--no-confirmation", options->no_confirmation,
                   "don't simulate disturbances on both sides of the limits");
  add_linear_options(command, options->linear);
  command.footer(
      "Plant, hold, delay and control law are linearised exactly at instants of the path; the limits are "
      "where\n"
      "an eigenvalue leaves the unit circle, each confirmed by simulating a disturbance on both sides of "
      "it.\n"
      "Marginal is what neither grows nor decays, to rounding; unstable also what grows by the plant's own "
      "steps.\n"
      "Exit status 0 where the experiment as it stands is stable or marginal all along, 1 where it isn't.\n"
      "Examples:\n"
      "  mixloop stability experiments/paper.yaml --picture stability.svg\n"
      "  mixloop stability experiments/paper.yaml --vary parameters.payload='0 kg,2 kg,5 kg,10 kg'\n"
      "  mixloop stability experiments/cart_pole.yaml --linear --regulator 10,100,1,1 --torque-weights 0.1");
  command.callback([options, &status] { status = run(*options); });
}

}  // namespace mixloop
