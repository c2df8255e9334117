// SPDX-License-Identifier: MIT
#include "processes/result_json.hpp"

#include <cmath>

namespace mixloop {
namespace {

/// Goes over the keys of a struct, which stand once, in `fields`: writes them into JSON or, where that is
/// constant, reads them from it.
template <class Json>
class Keys {
 public:
  explicit Keys(Json& at) : json_(at) {}

  template <class T>
  void operator()(const std::string& key, T& value) const {
    pass(at(key), value);
  }
  template <class T>
  void operator()(const std::string& key, std::optional<T>& value) const {
    if (has(key, value)) pass(at(key), *value);
  }
  template <class T>
  void operator()(const std::string& key, const std::optional<T>& value) const {
    if (value) pass(at(key), *value);
  }
  /// The keys of an optional struct stand among these; `key` is one that it always has.
  template <class T, class Fields>
  void among(const std::string& key, T& value, const Fields& fields) const {
    if (has(key, value)) fields(*this, *value);
  }
  /// The keys that stand among these where `flag` says so; `key` is one of them.
  template <class Flag, class Fields>
  void where(const std::string& key, Flag& flag, const Fields& fields) const {
    if constexpr (kReads) flag = json_.contains(key);
    if (flag) fields(*this);
  }
  template <class Fields>
  void group(const std::string& key, const Fields& fields) const {
    fields(Keys(at(key)));
  }

 private:
  static constexpr bool kReads = std::is_const_v<Json>;

  Json& at(const std::string& key) const {
    if constexpr (kReads)
      return json_.at(key);
    else
      return json_[key];
  }
  template <class T>
  bool has(const std::string& key, T& value) const {
    if constexpr (kReads)
      if (json_.contains(key)) value.emplace();
    return value.has_value();
  }

  template <class T>
  static void pass(Json& json, T& value) {
    if constexpr (requires(const Keys& keys) { fields(keys, value); })
      fields(Keys(json), value);
    else if constexpr (kReads)
      read(json, value);
    else
      write(json, value);
  }
  template <class T>
  static void read(Json& json, T& value) {
    json.get_to(value);
  }
  static void read(Json& json, double& value) { value = json.is_null() ? NAN : json.template get<double>(); }
  static void read(Json& json, Verdict& value) {
    value = Verdict::held;
    while (json != name_of(value) && value != Verdict::fault)
      value = static_cast<Verdict>(static_cast<int>(value) + 1);
  }
  static void read(Json& json, Vector& values) {
    values.resize(static_cast<Eigen::Index>(json.size()));
    for (std::size_t i = 0; i < json.size(); ++i) read(json[i], values[static_cast<Eigen::Index>(i)]);
  }
  template <class T>
  static void read(Json& json, std::vector<T>& values) {
    values.resize(json.size());
    for (std::size_t i = 0; i < json.size(); ++i) pass(json[i], values[i]);
  }
  template <class T>
  static void write(Json& json, const T& value) {
    json = value;
  }
  static void write(Json& json, const Verdict& value) { json = name_of(value); }
  static void write(Json& json, const Vector& values) {
    json = std::vector<double>(values.begin(), values.end());
  }
  template <class T>
  static void write(Json& json, const std::vector<T>& values) {
    json = nlohmann::json::array();
    for (const T& value : values) pass(json.emplace_back(), value);
  }

  Json& json_;
};

template <class T, class U>
concept IsA = std::is_same_v<std::remove_const_t<T>, U>;

template <class Way, IsA<Measures> M>
void fields(const Way& f, M& m) {
  f.where("max_position_error", m.follows_path, [&](const Way& g) {
    g("max_position_error", m.max_position_error);
    g("time_of_max_position_error", m.time_of_max_position_error);
    g("final_position_error", m.final_position_error);
    g("rms_position_error", m.rms_position_error);
  });
  f.where("max_orientation_error", m.is_oriented,
          [&](const Way& g) { g("max_orientation_error", m.max_orientation_error); });
  f("max_motor_error", m.max_motor_error);
  f("final_psi", m.final_psi);
  f("energy_drift", m.energy_drift);
  f("max_torque", m.max_torque);
  f("ticks", m.ticks);
  f("trajectory_sha256", m.trajectory_sha256);
  f("diverged_at", m.diverged_at);
  f("no_way_on", m.no_way_on);
  f("closure_residual", m.closure_residual);
  f("closure_condition", m.closure_condition);
  f("switches", m.switches);
  f("safe_at", m.safe_at);
  f("interrupted_at", m.interrupted_at);
}

template <class Way, IsA<RunFigures::Bound> B>
void fields(const Way& f, B& bound) {
  f("name", bound.expected.name);
  f("least", bound.expected.least);
  f("most", bound.expected.most);
  f("value", bound.value);
  f("held", bound.held);
  f("motor", bound.expected.motor);
  f("unit", bound.expected.unit);
}

template <class Way, IsA<RunFigures::Integrator::Chosen> C>
void fields(const Way& f, C& chosen) {
  f("local_error", chosen.local_error);
  f("estimate", chosen.estimate);
  f("why", chosen.why);
}

template <class Way, IsA<RunFigures::Integrator> I>
void fields(const Way& f, I& integrator) {
  f("name", integrator.name);
  f("substeps", integrator.substeps);
  f("local_error", integrator.local_error);
  f("chosen", integrator.chosen);
}

template <class Way, IsA<RunFigures> R>
void fields(const Way& f, R& run) {
  fields(f, run.measures);
  f("torque_units", run.torque_units);
  if (run.measures.final_psi) f("position_units", run.position_units);
  f("bounds", run.bounds);
  f("expects_divergence", run.expects_divergence);
  f("wall_time", run.wall_time);
  f("route", run.route);
  f("evaluation", run.evaluation);
  f("rate", run.rate);
  f("scene", run.scene);
  f("scene_sha256", run.scene_sha256);
  f("parameters", run.parameters);
  f("integrator", run.integrator);
  f("seed", run.seed);
  f.group("versions", [&](const Way& g) {
    g("mixloop", run.origin.mixloop);
    g("compiler", run.origin.compiler);
    g("c_library", run.origin.c_library);
    g("eigen", run.origin.eigen);
    g("processor", run.origin.processor);
  });
  f.group("machine", [&](const Way& g) {
    g("processor", run.origin.processor);
    g("cores", run.origin.cores);
    g("kernel", run.origin.kernel);
  });
}

template <class Way, class Q>
void quantiles(const Way& f, const std::string& of, Q& times) {
  f(of + "_p50", times.p50);
  f(of + "_p99", times.p99);
  f(of + "_p999", times.p999);
  f(of + "_max", times.max);
}

template <class Way, IsA<BusFigures> B>
void fields(const Way& f, B& bus) {
  f("missed_deadlines", bus.missed_deadlines);
  f.among("overruns", bus.deadlines, [](const Way& g, auto& deadlines) {
    g("longest_miss", deadlines.longest_miss);
    g("success_last_100", deadlines.success_last_100);
    g("overruns", deadlines.overruns);
    g("safe_cause", deadlines.safe_cause);
    g("safe_state", deadlines.safe_state);
  });
  f("resent", bus.resent);
  quantiles(f, "round_trip", bus.round_trip);
  f.among("wake_up_p50", bus.wake_up, [](const Way& g, auto& times) { quantiles(g, "wake_up", times); });
  f("slipped", bus.slipped);
  f("rejected", bus.rejected);
  f("rejected_by_cause", bus.rejected_by_cause);
  f("refused_faults", bus.refused_faults);
  f("dropped", bus.dropped);
  f("joined_late", bus.joined_late);
}

template <class Way, IsA<SweepFigures::Figure> F>
void fields(const Way& f, F& figure) {
  f("name", figure.name);
  f("unit", figure.unit);
  f("value", figure.value);
}

template <class Way, IsA<SweepFigures> S>
void fields(const Way& f, S& sweep) {
  f("runs", sweep.runs);
  f("done", sweep.done);
  f("wall_time", sweep.wall_time);
  f("figures", sweep.figures);
}

template <class Way, IsA<Result::Log> L>
void fields(const Way& f, L& log) {
  f("file", log.file);
  f("events", log.events);
  f("missing_ticks", log.missing_ticks);
}

template <class Way, IsA<Result::Error> E>
void fields(const Way& f, E& error) {
  f("code", error.code);
  f("message", error.message);
  f("where", error.where);
}

template <class Way, IsA<Result> R>
void fields(const Way& f, R& result) {
  const auto flat = [](const Way& g, auto& part) { fields(g, part); };
  f("experiment", result.experiment);
  f("verdict", result.judged.verdict);
  f("missed", result.judged.missed);
  f("exit_status", result.judged.exit_status);
  f.among("ticks", result.run, flat);
  f.among("round_trip_p50", result.bus, flat);
  f("session", result.session);
  f("missing_ticks", result.missing_ticks);
  f("log", result.log);
  f("files", result.files);
  f("warnings", result.warnings);
  f("error", result.error);
}

}  // namespace

std::string json_text(const nlohmann::json& json, int indent) {
  return json.dump(indent, ' ', false, nlohmann::json::error_handler_t::replace);
}

nlohmann::json json_of(const Result& result) {
  auto out = nlohmann::json::object();
  const Keys f(out);
  if (result.run) {
    fields(f, result);
  } else if (result.sweep) {
    f("experiment", result.experiment);
    f("verdict", result.judged.verdict);
    f("missed", result.judged.missed);
    f("exit_status", result.judged.exit_status);
    f("sweep", result.sweep);
  } else if (result.error) {
    f("experiment", result.experiment);
    f("error", result.error);
    f("error_status", result.judged.exit_status);
  } else {
    f("verdict", result.judged.verdict);
    f("exit_status", result.judged.exit_status);
    f("log", result.log);
    f("files", result.files);
    f("warnings", result.warnings);
  }
  return out;
}

Result result_in(const nlohmann::json& json) {
  Result result;
  fields(Keys(json), result);
  return result;
}

}  // namespace mixloop
