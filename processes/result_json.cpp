// SPDX-License-Identifier: MIT
#include "processes/result_json.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace mixloop {
namespace {

using nlohmann::json;

// The keys of each struct stand once, in `fields`, for both ways: a Writer or a Reader goes over them.

class Writer {
 public:
  explicit Writer(json& to) : to_(to) {}

  template <class T>
  void operator()(const std::string& key, const T& value) const {
    put(to_[key], value);
  }
  template <class T>
  void operator()(const std::string& key, const std::optional<T>& value) const {
    if (value) put(to_[key], *value);
  }
  /// The struct's own keys among these, where there is one; `key` is one that it always has.
  template <class T, class Fields>
  void among(const std::string&, const std::optional<T>& value, const Fields& fields) const {
    if (value) fields(*this, *value);
  }
  template <class Fields>
  void group(const std::string& key, const Fields& fields) const {
    fields(Writer(to_[key]));
  }

 private:
  template <class T>
  static void put(json& to, const T& value) {
    if constexpr (requires(const Writer& w) { fields(w, value); })
      fields(Writer(to), value);
    else
      to = value;
  }
  static void put(json& to, const Verdict& value) { to = name_of(value); }
  static void put(json& to, const Vector& value) { to = std::vector<double>(value.begin(), value.end()); }
  template <class T>
  static void put(json& to, const std::vector<T>& values) {
    to = json::array();
    for (const T& value : values) put(to.emplace_back(), value);
  }

  json& to_;
};

class Reader {
 public:
  explicit Reader(const json& from) : from_(from) {}

  template <class T>
  void operator()(const std::string& key, T& value) const {
    get(from_.at(key), value);
  }
  template <class T>
  void operator()(const std::string& key, std::optional<T>& value) const {
    if (from_.contains(key)) get(from_.at(key), value.emplace());
  }
  template <class T, class Fields>
  void among(const std::string& key, std::optional<T>& value, const Fields& fields) const {
    if (from_.contains(key)) fields(*this, value.emplace());
  }
  template <class Fields>
  void group(const std::string& key, const Fields& fields) const {
    fields(Reader(from_.at(key)));
  }

 private:
  template <class T>
  static void get(const json& from, T& value) {
    if constexpr (requires(const Reader& r) { fields(r, value); })
      fields(Reader(from), value);
    else
      from.get_to(value);
  }
  static void get(const json& from, double& value) { value = from.is_null() ? NAN : from.get<double>(); }
  static void get(const json& from, Verdict& value) {
    const auto word = from.get<std::string>();
    value = Verdict::held;
    while (name_of(value) != word && value != Verdict::fault)
      value = static_cast<Verdict>(static_cast<int>(value) + 1);
  }
  static void get(const json& from, Vector& value) {
    value.resize(static_cast<Eigen::Index>(from.size()));
    for (std::size_t i = 0; i < from.size(); ++i) get(from[i], value[static_cast<Eigen::Index>(i)]);
  }
  template <class T>
  static void get(const json& from, std::vector<T>& values) {
    for (const json& item : from) get(item, values.emplace_back());
  }

  const json& from_;
};

template <class T, class U>
concept IsA = std::is_same_v<std::remove_const_t<T>, U>;

template <class Way, IsA<Measures> M>
void fields(const Way& f, M& m) {
  f("max_position_error", m.max_position_error);
  f("time_of_max_position_error", m.time_of_max_position_error);
  f("final_position_error", m.final_position_error);
  f("rms_position_error", m.rms_position_error);
  f("max_torque", m.max_torque);
  f("ticks", m.ticks);
  f("trajectory_sha256", m.trajectory_sha256);
  f("diverged_at", m.diverged_at);
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
  f("joined_late", bus.joined_late);
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
  f.among("max_position_error", result.run, flat);
  f.among("round_trip_p50", result.bus, flat);
  f("session", result.session);
  f("missing_ticks", result.missing_ticks);
  f("log", result.log);
  f("warnings", result.warnings);
  f("error", result.error);
}

}  // namespace

json json_of(const Result& result) {
  json out = json::object();
  const Writer f(out);
  if (result.run) {
    fields(f, result);
  } else if (result.error) {
    f("experiment", result.experiment);
    f("error", result.error);
    f("error_status", result.judged.exit_status);
  } else {
    f("verdict", result.judged.verdict);
    f("exit_status", result.judged.exit_status);
    f("log", result.log);
    f("warnings", result.warnings);
  }
  return out;
}

Result result_in(const json& json) {
  Result result;
  fields(Reader(json), result);
  return result;
}

}  // namespace mixloop
