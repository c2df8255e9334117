// SPDX-License-Identifier: MIT
#include "tests/oracles/random_mechanism.hpp"

#include <cstdio>

namespace mixloop::oracle {

/// Draws whole numbers by the generator alone: the distributions of <random> differ between libraries.
class RandomMechanism::Dice {
 public:
  explicit Dice(std::uint64_t seed) : random_(seed) {}

  int below(int count) { return static_cast<int>(random_() % static_cast<std::uint64_t>(count)); }
  bool once_in(int count) { return below(count) == 0; }
  /// Between the two, in steps of 1/1024.
  Dyadic between(double low, double high) {
    const int first = static_cast<int>(low * 1024), last = static_cast<int>(high * 1024);
    return {first + below(last - first + 1)};
  }

 private:
  std::mt19937_64 random_;
};

namespace {

std::string list(const Dyadic* x, const std::string& factor = "") {
  std::string text = "[";
  for (int i = 0; i < 3; ++i) text += (i ? ", \"" : "\"") + x[i].text() + factor + "\"";
  return text + "]";
}

std::string psi(int i) { return "psi" + std::to_string(i + 1); }

std::string frame_name(int frame) { return frame < 0 ? "0" : "F" + std::to_string(frame + 1); }

}  // namespace

std::string Dyadic::text() const {
  char digits[32];
  std::snprintf(digits, sizeof digits, units < 0 ? "(%.10f)" : "%.10f", units / 1024.0);
  return digits;
}

std::string RandomMechanism::Coordinate::text(int index) const {
  std::string sum = offset.text();
  const auto add = [&](const Dyadic& factor, const std::string& term) {
    if (factor.units != 0) sum += " + " + factor.text() + " * " + term;
  };
  const std::string time = "(t / (1 s))";
  for (std::size_t i = 0; i < linear.size(); ++i) add(linear[i], psi(static_cast<int>(i)));
  add(wave, "sin(" + frequency.text() + " * " + psi(a) + " + " + phase.text() +
                (tempo.units ? " + " + tempo.text() + " * " + time : "") + ")");
  add(product, psi(b) + " * " + psi(c));
  add(drift, time + "^2");
  add(sweep, time + " * " + psi(d));
  sum = linear_motion ? "(" + sum + ") * (1 m)" : sum;
  if (index > 0 && chain.units != 0) sum += " + " + chain.text() + " * q" + std::to_string(index);
  return sum;
}

RandomMechanism::Coordinate RandomMechanism::random_coordinate(int j, MechanismKind kind, Dice& dice) const {
  Coordinate f;
  f.linear_motion = dice.once_in(3);
  f.offset = dice.between(-2, 2);
  for (int i = 0; i < n_; ++i) f.linear.push_back(dice.between(-0.125, 0.125));
  // The first n follow a motor each, which keeps C of full rank; the others are free.
  f.linear[static_cast<std::size_t>(j < n_ ? j : dice.below(n_))] = dice.between(1.5, 3);
  // A coordinate may lean on the one before if both are of a kind.
  if (j >= n_ && f.linear_motion == coordinates_.back().linear_motion) f.chain = dice.between(-1, 1);
  f.a = dice.below(n_), f.b = dice.below(n_), f.c = dice.below(n_), f.d = dice.below(n_);
  f.frequency = dice.between(0.5, 2);
  f.phase = dice.between(-3, 3);
  if (kind.nonlinear || kind.timed) f.wave = dice.between(-0.25, 0.25);
  if (kind.nonlinear) f.product = dice.between(-0.125, 0.125);
  if (kind.timed) {
    f.tempo = dice.between(-2, 2);
    f.drift = dice.between(-0.5, 0.5);
    f.sweep = dice.between(-0.25, 0.25);
  }
  return f;
}

RandomMechanism::Frame RandomMechanism::random_frame(int i, Dice& dice) const {
  Frame frame;
  frame.parent = i == 0 ? -1 : dice.below(i + 1) - 1;
  // Each coordinate moves a frame; then come fixed ones and some that share a coordinate.
  frame.coordinate = i < m() ? i : dice.once_in(2) ? dice.below(m()) : -1;
  frame.scale = dice.once_in(2) ? Dyadic{1024} : dice.between(0.5, 2);
  frame.theta = dice.between(-3, 3);
  frame.s = dice.between(-1, 1);
  frame.a = dice.between(-1, 1);
  frame.alpha = dice.between(-3, 3);
  return frame;
}

RandomMechanism::Body RandomMechanism::random_body(Dice& dice) {
  Body body;
  body.mass = dice.between(0.5, 3);
  for (Dyadic& x : body.centre) x = dice.between(-0.5, 0.5);
  for (int k = 0; k < 6; ++k) body.inertia[k] = k < 3 ? dice.between(0.5, 1) : dice.between(-0.125, 0.125);
  return body;
}

RandomMechanism::Load RandomMechanism::random_load(MechanismKind kind, Dice& dice) const {
  Load load;
  load.frame = dice.below(static_cast<int>(frames_.size()));
  for (int k = 0; k < 3; ++k) {
    load.point[k] = dice.between(-1, 1);
    load.force[k] = dice.between(-8, 8);
    load.moment[k] = dice.between(-8, 8);
  }
  if (kind.timed) load.tempo = dice.between(-2, 2);
  return load;
}

RandomMechanism::Spring RandomMechanism::random_spring(MechanismKind kind, Dice& dice) const {
  Spring spring;
  spring.coordinate = dice.below(m());
  if (kind.springs) spring.stiffness = dice.between(0, 20), spring.rest = dice.between(-1, 1);
  if (kind.friction) spring.damping = dice.between(0, 5);
  return spring;
}

RandomMechanism::RandomMechanism(std::uint64_t seed, MechanismKind kind) {
  Dice dice(seed);
  n_ = 1 + dice.below(4);
  const int m_wanted = n_ + dice.below(4);
  for (int j = 0; j < m_wanted; ++j) coordinates_.push_back(random_coordinate(j, kind, dice));
  const int count = m() + dice.below(3);
  for (int i = 0; i < count; ++i) {
    frames_.push_back(random_frame(i, dice));
    bodies_.push_back(random_body(dice));
  }
  for (int i = kind.loads ? 1 + dice.below(2) : 0; i > 0; --i) loads_.push_back(random_load(kind, dice));
  for (Dyadic& g : gravity_) g = dice.between(-10, 10);
  for (int i = kind.springs || kind.friction ? 1 + dice.below(2) : 0; i > 0; --i)
    springs_.push_back(random_spring(kind, dice));
}

std::string RandomMechanism::scene_text() const {
  std::string text = "name: random\nmotors: [";
  for (int i = 0; i < n_; ++i) text += (i ? ", " : "") + psi(i);
  text += "]\ncoordinates: [";
  for (int j = 0; j < m(); ++j) text += (j ? ", q" : "q") + std::to_string(j + 1);
  text += "]\nconstraints:\n";
  for (int j = 0; j < m(); ++j)
    text +=
        "  q" + std::to_string(j + 1) + ": \"" + coordinates_[static_cast<std::size_t>(j)].text(j) + "\"\n";
  text += transforms_text() + bodies_text() + loads_text();
  text += "gravity: " + list(gravity_) +
          "\nend_effector: {frame: " + frame_name(static_cast<int>(frames_.size()) - 1) +
          ", point: [0.25, -0.5, 0.125]}\n";
  return text;
}

std::string RandomMechanism::transforms_text() const {
  std::string text = "transforms:\n";
  for (std::size_t i = 0; i < frames_.size(); ++i) {
    const Frame& frame = frames_[i];
    std::string theta = frame.theta.text(), s = frame.s.text();
    if (frame.coordinate >= 0) {
      const bool slides = coordinates_[static_cast<std::size_t>(frame.coordinate)].linear_motion;
      (slides ? s : theta) += " + " + frame.scale.text() + " * q" + std::to_string(frame.coordinate + 1);
    }
    text += "  - {from: " + frame_name(frame.parent) + ", to: " + frame_name(static_cast<int>(i)) +
            ", theta: \"" + theta + "\", s: \"" + s + "\", a: \"" + frame.a.text() + "\", alpha: \"" +
            frame.alpha.text() + "\"}\n";
  }
  return text;
}

std::string RandomMechanism::bodies_text() const {
  static const char* kElement[] = {"xx", "yy", "zz", "xy", "xz", "yz"};
  std::string text = "bodies:\n";
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    const Body& body = bodies_[i];
    text += "  - {frame: " + frame_name(static_cast<int>(i)) + ", mass: " + body.mass.text() +
            ", center_of_mass: " + list(body.centre) + ", inertia: {";
    for (int k = 0; k < 6; ++k)
      text += std::string(k ? ", " : "") + kElement[k] + ": \"" + body.inertia[k].text() + "\"";
    text += "}}\n";
  }
  return text;
}

std::string RandomMechanism::loads_text() const {
  std::string text = loads_.empty() && springs_.empty() ? "" : "loads:\n";
  for (const Load& load : loads_) {
    const std::string strength = " * cos(" + load.tempo.text() + " * t / (1 s))";
    text += "  - {frame: " + frame_name(load.frame) + ", point: " + list(load.point) +
            ", force: " + list(load.force, " * (1 N)" + strength) +
            ", moment: " + list(load.moment, " * (1 N m)" + strength) + "}\n";
  }
  for (const Spring& spring : springs_)
    text += "  - {coordinate: q" + std::to_string(spring.coordinate + 1) + ", stiffness: \"" +
            spring.stiffness.text() + "\", rest: \"" + spring.rest.text() + "\", damping: \"" +
            spring.damping.text() + "\"}\n";
  return text;
}

}  // namespace mixloop::oracle
