// SPDX-License-Identifier: MIT
#include "import/experiment_text.hpp"

#include <fmt/format.h>

#include <optional>

#include "import/yaml_text.hpp"

namespace mixloop {
namespace {

constexpr const char* kNoLimit = "1e9";  ///< of a motor beside others that have one

/// Lists with an entry a motor, in the units of one that turns or slides.
class PerMotor {
 public:
  PerMotor(const Robot& robot, const Roles& roles) : robot_(robot), roles_(roles) {}

  bool slides(std::size_t motor) const {
    return robot_.joints[static_cast<std::size_t>(roles_.motors[motor])].slides();
  }
  std::string position(std::size_t motor, double value) const {
    return slides(motor) ? quantity(value, "m") : angle_text(value);
  }
  std::string positions(const std::vector<double>& values) const {
    return list([&](std::size_t i) { return position(i, values[i]); });
  }
  std::string rounded(const std::vector<double>& values, const char* rotary, const char* linear) const {
    return list(
        [&](std::size_t i) { return fmt::format("{:.3g} {}", values[i], slides(i) ? linear : rotary); });
  }
  /// `text(motor)` of each.
  template <class Text>
  std::string list(const Text& text) const {
    std::string all;
    for (std::size_t i = 0; i < roles_.motors.size(); ++i) all += (i == 0 ? "" : ", ") + std::string(text(i));
    return "[" + all + "]";
  }

 private:
  const Robot& robot_;
  const Roles& roles_;
};

/// There and back.
std::string path_text(const PerMotor& per, const std::vector<double>& home, const Motion& motion) {
  const std::string start = per.positions(home), duration = fmt::format("{} s", motion.duration);
  return "path:\n  motors:\n    - {at: " + start + "}\n    - {at: " + per.positions(motion.target) +
         ", duration: " + duration + ", dwell: 0.2 s}\n    - {at: " + start + ", duration: " + duration +
         "}\n";
}

/// A row a motor, with its name.
std::string positions_text(const PerMotor& per, const SceneNames& names, const Roles& roles,
                           const std::vector<MotorLimits>& limits) {
  std::string text = "  position:\n";
  for (std::size_t i = 0; i < limits.size(); ++i) {
    const std::string unit = per.slides(i) ? "m" : "rad",
                      none = fmt::format("-{0} {1}, {0} {1}", kNoLimit, unit);
    const auto& position = limits[i].position;
    const std::string range =
        position ? per.position(i, position->first) + ", " + per.position(i, position->second) : none;
    text += fmt::format("    - [{}]   # {}{}\n", range,
                        names.joints[static_cast<std::size_t>(roles.motors[i])], position ? "" : ": none");
  }
  return text;
}

/// What isn't said of any motor is left out; 1e9 stands for none beside others.
std::string limits_text(const PerMotor& per, const SceneNames& names, const Roles& roles,
                        const Motion& motion, const std::vector<MotorLimits>& limits) {
  std::string text;
  bool position = false, velocity = false, torque = false;
  const auto held = [&](std::size_t i) { return limits[i].torque && !motion.overloads(i); };
  for (std::size_t i = 0; i < limits.size(); ++i) {
    position = position || limits[i].position;
    velocity = velocity || limits[i].velocity;
    torque = torque || held(i);
  }
  const auto or_none = [](const std::optional<double>& value, const char* unit) {
    return value ? quantity(*value, unit) : fmt::format("{} {}", kNoLimit, unit);
  };
  if (position) text += positions_text(per, names, roles, limits);
  if (velocity)
    text += "  velocity: " + per.list([&](std::size_t i) {
      return or_none(limits[i].velocity, per.slides(i) ? "m/s" : "rad/s");
    }) + "\n";
  if (torque)
    text += "  torque: " + per.list([&](std::size_t i) {
      return or_none(held(i) ? limits[i].torque : std::nullopt, per.slides(i) ? "N" : "N m");
    }) + "\n";
  if (!roles.free.empty())
    text += "  position_error: 1 km   # what moves freely takes the end effector along\n";
  return text.empty() ? "" : "limits:\n" + text;
}

}  // namespace

std::string experiment_text(const std::string& scene_file, const Robot& robot, const SceneNames& names,
                            const Roles& roles, const std::vector<double>& home, const Motion& motion,
                            const Tuning& tuning, const std::vector<MotorLimits>& limits) {
  const PerMotor per(robot, roles);
  std::string text = "scene: " + yaml_text(scene_file) + "\nrate: 1000 Hz\n" + path_text(per, home, motion);
  text += "controller:\n  law: computed_torque\n";
  text += "  kp: " + per.rounded(tuning.kp, "N m/rad", "N/m") + "\n";
  text += "  kv: " + per.rounded(tuning.kv, "N m s/rad", "N s/m") + "\n";
  if (tuning.lags) text += "  feedforward_at: desired   # the joints' damping is faster than a tick\n";
  text += "plant: {integrator: rk4, control: held" +
          (tuning.substeps > 1 ? fmt::format(", substeps: {}", tuning.substeps) : "") + "}\n" +
          limits_text(per, names, roles, motion, limits);
  if (roles.free.empty())  // else what moves freely pushes the motors off
    text += "expect:\n  max_motor_error: " + per.list([&](std::size_t i) {
      return per.slides(i) ? "1 mm" : "0.01 rad";
    }) + "\n";
  return broken_lines(text);
}

}  // namespace mixloop
