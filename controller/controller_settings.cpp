// SPDX-License-Identifier: MIT
#include "controller/controller_settings.hpp"

#include <fmt/format.h>

#include "controller/controller_keys.hpp"
#include "dynamics/scene/coordinate_values.hpp"
#include "notation/value.hpp"

namespace mixloop {
namespace {

/// A gain is torque per `error`.
Vector gains(const Mapping& entry, const char* key, const Scene& scene, const Quantity& error) {
  const auto values = read_values(entry.at(key), scene.motors(), kTorque / error, key);
  return map_of(std::span<const double>(values));
}

/// Keys that another law has.
void refuse_keys(const Mapping& entry, const std::string& law, std::initializer_list<const char*> keys,
                 const char* expected) {
  for (const char* key : keys)
    if (const NodePtr value = entry.find(key))
      throw InputError("unknown_key", value->place,
                       fmt::format("the law {} has no '{}'; expected {}", law, key, expected));
}

void read_gains(const Mapping& entry, const Scene& scene, ControllerSettings& settings) {
  settings.kp = gains(entry, "kp", scene, kPosition);
  settings.kv = gains(entry, "kv", scene, kVelocity);
  if (const NodePtr at = entry.find("feedforward_at"))
    settings.feedforward_at =
        word_of(*at, words_of(controller_keys(), "feedforward_at"), "feedforward_at") == 0
            ? FeedforwardAt::measured
            : FeedforwardAt::desired;
}

void read_course(const Mapping& entry, const Scene& scene, const std::filesystem::path& folder,
                 ControllerSettings& settings) {
  const NodePtr torque = entry.find("torque"), file = entry.find("file");
  if (torque && file)
    throw InputError("doubly_defined", file->place,
                     "the law torque has both 'torque' and 'file'; expected one of them");
  if (!torque && !file)
    throw InputError("missing_key", entry.node().place, "the law torque lacks 'torque' or 'file'");
  settings.course =
      torque ? TorqueCourse::of_formulas(torque, scene) : TorqueCourse::of_file(*file, folder, scene);
}

/// K, row by row, each value in its own unit.
Matrix read_gain(const NodePtr& node, const Scene& scene) {
  const auto n = static_cast<std::size_t>(scene.n()), n_u = scene.motors().size();
  const auto rows = items_of(node, "the gain, a row a motor");
  if (rows.size() != n_u)
    throw InputError("wrong_size", node->place,
                     fmt::format("the gain has {} rows; expected {}, one a motor", rows.size(), n_u));
  Matrix gain(scene.n_u(), 2 * scene.n());
  for (std::size_t i = 0; i < n_u; ++i) {
    const auto values = items_of(rows[i], "a row of the gain");
    if (values.size() != 2 * n)
      throw InputError(
          "wrong_size", rows[i]->place,
          fmt::format("row {} of the gain has {} values; expected {}: one for the position of each "
                      "independent coordinate, then one for its rate",
                      i + 1, values.size(), 2 * n));
    const auto read = [&](std::size_t j, const Quantity& error, const Scene::Independent& coordinate) {
      gain(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) =
          number_of(*values[j], kTorque.of(scene.motors()[i]) / error.of(coordinate), "the gain");
    };
    for (std::size_t j = 0; j < n; ++j) {
      read(j, kPosition, scene.independent[j]);
      read(n + j, kVelocity, scene.independent[j]);
    }
  }
  return gain;
}

void read_state_feedback(const Mapping& entry, const Scene& scene, ControllerSettings& settings) {
  settings.gain = read_gain(entry.at("gain"), scene);
  settings.about_psi = map_of(std::span(scene.home));
  settings.about_psid = Vector::Zero(scene.n());
  settings.about_torque = Vector::Zero(scene.n_u());
  const NodePtr node = entry.find("about");
  if (!node) return;
  const Mapping about = read_mapping(node, about_keys());
  const auto read = [&](const char* key, std::span<const Scene::Independent> coordinates,
                        const Quantity& quantity, const char* what, Vector& to) {
    if (const NodePtr given = about.find(key)) {
      const auto values = read_values(given, coordinates, quantity, what);
      to = map_of(std::span(values));
    }
  };
  read("psi", scene.independent, kPosition, "the position to feed back about", settings.about_psi);
  read("psid", scene.independent, kVelocity, "the rate to feed back about", settings.about_psid);
  read("torque", scene.motors(), kTorque, "the torque to feed back about", settings.about_torque);
}

}  // namespace

const Keys& controller_keys() {
  static const Keys keys{
      "the controller",
      {{"law",
        form::word({"pd", "pd_gravity", "pd_feedforward", "computed_torque", "torque", "state_feedback"}),
        kRequired},
       {"kp", form::numbers()},
       {"kv", form::numbers()},
       {"feedforward_at", form::word({"measured", "desired"})},
       {"torque", form::numbers()},
       {"file", form::text()},
       {"gain", form::list(form::numbers())},
       {"about", form::mapping(about_keys)},
       {"safety", form::mapping(safety_keys)},
       {"parameters", form::named(form::number())},
       {"scene", form::text()}}};
  return keys;
}

const Keys& about_keys() {
  static const Keys keys{"the state to feed back about",
                         {{"psi", form::numbers()}, {"psid", form::numbers()}, {"torque", form::numbers()}}};
  return keys;
}

ControllerSettings read_controller_settings(const NodePtr& node, const Scene& scene,
                                            const std::filesystem::path& folder) {
  const Mapping entry = read_mapping(node, controller_keys());
  ControllerSettings settings;
  static constexpr Law kLaws[] = {Law::pd,     Law::pd_gravity,    Law::pd_feedforward, Law::computed_torque,
                                  Law::torque, Law::state_feedback};
  const auto& words = words_of(controller_keys(), "law");
  const std::size_t law = word_of(*entry.at("law"), words, "the law");
  settings.law = kLaws[law];
  settings.kp = settings.kv = Vector::Zero(scene.n_u());
  if (has_gains(settings.law)) {
    refuse_keys(entry, words[law], {"torque", "file", "gain", "about"}, "kp and kv");
    read_gains(entry, scene, settings);
  } else if (settings.law == Law::torque) {
    refuse_keys(entry, words[law], {"kp", "kv", "feedforward_at", "gain", "about"}, "torque or file");
    read_course(entry, scene, folder, settings);
  } else {
    refuse_keys(entry, words[law], {"kp", "kv", "feedforward_at", "torque", "file"}, "gain and about");
    read_state_feedback(entry, scene, settings);
  }
  if (const NodePtr safety = entry.find("safety")) {
    settings.safety = read_safety_settings(safety, scene);
    if (!has_gains(settings.law) && settings.safety.safe_command == SafeCommand::damp)
      throw InputError("out_of_range", find_entry(*safety, "safe_command")->place,
                       fmt::format("the safe command damp takes kv, which the law {} has not; expected "
                                   "zero_torque",
                                   words[law]));
  }
  return settings;
}

PsiMotion wanted_state(const ControllerSettings& settings, const Scene& scene, const Reference& desired) {
  PsiMotion wanted = whole_motion(scene, desired);
  if (settings.law != Law::state_feedback) return wanted;
  const Eigen::Index free = scene.n() - scene.n_u();
  wanted.psi.tail(free) = settings.about_psi.tail(free);
  wanted.psid.tail(free) = settings.about_psid.tail(free);
  return wanted;
}

}  // namespace mixloop
