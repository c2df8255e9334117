// SPDX-License-Identifier: MIT
#include "import/experiment_text.hpp"

#include <fmt/format.h>

#include "import/yaml_text.hpp"

namespace mixloop {
namespace {

/// A list with a value of each motor, in the unit of one that turns or slides.
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
  template <class Text>
  std::string list(const Text& text) const {
    std::string all;
    for (std::size_t i = 0; i < roles_.motors.size(); ++i) all += (all.empty() ? "" : ", ") + text(i);
    return "[" + all + "]";
  }

 private:
  const Robot& robot_;
  const Roles& roles_;
};

}  // namespace

std::string experiment_text(const std::string& scene_file, const Robot& robot, const Roles& roles,
                            const Scene& scene, const Motion& motion, const Gains& gains,
                            const std::vector<MotorLimits>& limits) {
  (void)scene;
  (void)limits;
  const PerMotor per(robot, roles);
  std::string text = "scene: " + yaml_text(scene_file) + "\nrate: 1000 Hz\n";
  text += "plant: {integrator: rk4, initial: " + per.positions(motion.target) + "}\n";
  text += fmt::format("duration: {} s\n", motion.duration);
  text += "controller: {law: state_feedback, gain: [";
  const std::size_t n = gains.kp.size();
  for (std::size_t i = 0; i < n; ++i) {
    text += i == 0 ? "[" : ", [";
    for (std::size_t j = 0; j < n; ++j) text += fmt::format("{:.3g}, ", i == j ? gains.kp[i] : 0.0);
    for (std::size_t j = 0; j < n; ++j)
      text += fmt::format("{:.3g}{}", i == j ? gains.kv[i] : 0.0, j + 1 < n ? ", " : "]");
  }
  return text + "]}\n";
}

}  // namespace mixloop
