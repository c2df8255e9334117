// SPDX-License-Identifier: MIT
#include "tests/oracles/chains.hpp"

namespace mixloop::oracle {
namespace {

std::string number(int i) { return std::to_string(i); }

/// Slightly different from one to the next, so that nothing cancels by chance.
std::string body(int i, const std::string& frame) {
  const std::string mass = "1." + number(10 + i % 7);
  return "  - {frame: " + frame + ", mass: " + mass + ", center_of_mass: [-0.1" + number(1 + i % 5) +
         ", 0.02, 0.03], inertia: {xx: 0.02, yy: 0.03" + number(i % 3) +
         ", zz: 0.025, xy: 0.001, xz: 0.002, yz: -0.001}}\n";
}

std::string scene(const std::string& motors, const std::string& coordinates, const std::string& constraints,
                  const std::string& transforms, const std::string& bodies, const std::string& last) {
  return "motors: [" + motors + "]\ncoordinates: [" + coordinates + "]\nconstraints:\n" + constraints +
         "transforms:\n" + transforms + "bodies:\n" + bodies +
         "gravity: [0, 0, -9.81]\nend_effector: {frame: " + last + ", point: [0, 0, 0]}\n";
}

}  // namespace

std::string serial_chain(int n) {
  std::string motors, coordinates, constraints, transforms, bodies;
  for (int i = 1; i <= n; ++i) {
    const std::string k = number(i), comma = i > 1 ? ", " : "";
    motors += comma + "psi" + k;
    coordinates += comma + "q" + k;
    constraints += "  q" + k + ": psi" + k + "\n";
    transforms += "  - {from: " + number(i - 1) + ", to: " + k + ", theta: q" + k +
                  ", s: 0.1, a: 0.3, alpha: " + (i % 2 == 0 ? "-90 deg" : "90 deg") + "}\n";
    bodies += body(i, k);
  }
  return scene(motors, coordinates, constraints, transforms, bodies, number(n));
}

std::string coiled_chain(int n, int motors) {
  std::string names, coordinates, constraints, transforms, bodies;
  for (int i = 1; i <= motors; ++i) {
    names += (i > 1 ? ", psi" : "psi") + number(i);
    coordinates += (i > 1 ? ", q" : "q") + number(i);
    constraints += "  q" + number(i) + ": psi" + number(i) + "\n";
  }
  for (int i = 1; i <= n; ++i) {
    transforms += "  - {from: " + number(i - 1) + ", to: " + number(i) + ", theta: q" +
                  number((i - 1) % motors + 1) +
                  ", s: 0.001, a: 0.003, alpha: " + (i % 2 == 0 ? "-90 deg" : "30 deg") + "}\n";
    bodies += body(i, number(i));
  }
  return scene(names, coordinates, constraints, transforms, bodies, number(n));
}

std::string parallelogram_chain(int n) {
  std::string motors, coordinates, constraints, transforms, bodies, base = "0";
  for (int i = 1; i <= n; ++i) {
    const std::string k = number(i), comma = i > 1 ? ", " : "";
    motors += comma + "psi" + k;
    coordinates += comma + "crank" + k + ", coupler" + k + ", follower" + k;
    constraints += "  crank" + k + ": psi" + k + "\n  coupler" + k + ": -psi" + k + "\n  follower" + k +
                   ": psi" + k + "\n";
    const std::string from = "  - {from: " + base + ", to: ";
    transforms += from + "a" + k + ", theta: crank" + k + ", s: 0, a: 0.3, alpha: 0}\n";
    transforms +=
        "  - {from: a" + k + ", to: b" + k + ", theta: coupler" + k + ", s: 0, a: 0.2, alpha: 90 deg}\n";
    transforms += from + "d" + k + ", theta: 0, s: 0, a: 0.2, alpha: 0}\n";
    transforms +=
        "  - {from: d" + k + ", to: c" + k + ", theta: follower" + k + ", s: 0, a: 0.3, alpha: 0}\n";
    bodies += body(3 * i, "a" + k) + body(3 * i + 1, "b" + k) + body(3 * i + 2, "c" + k);
    base = "b" + k;
  }
  return scene(motors, coordinates, constraints, transforms, bodies, base);
}

std::string four_bar_chain_of(int n) {
  std::string coordinates, constraints = "  crank1: drive\n", transforms, closures, bodies, home;
  double guess = 60;
  const auto bar = [](const std::string& frame, const std::string& length, const std::string& mass) {
    const std::string across = mass + " * " + length + "^2 / 12";
    return "  - {frame: " + frame + ", mass: " + mass + ", center_of_mass: [-" + length +
           "/2, 0, 0], inertia: {xx: 0, yy: " + across + ", zz: " + across + "}}\n";
  };
  for (int i = 1; i <= n; ++i) {
    const std::string k = number(i), comma = i > 1 ? ", " : "";
    coordinates += comma + "crank" + k + ", coupler" + k + ", rocker" + k;
    if (i > 1) constraints += "  crank" + k + ": rocker" + number(i - 1) + "\n";
    const std::string from = "  - {from: " + (i > 1 ? "pivot" + number(i - 1) : std::string("0")) + ", to: ";
    transforms += from + "A" + k + ", theta: crank" + k + ", a: crank}\n";
    transforms += "  - {from: A" + k + ", to: B" + k + ", theta: coupler" + k + ", a: coupler}\n";
    transforms += from + "pivot" + k + ", a: ground}\n";
    transforms += "  - {from: pivot" + k + ", to: C" + k + ", theta: rocker" + k + ", a: rocker}\n";
    closures += "  - {coincide: [{frame: B" + k + "}, {frame: C" + k + "}], axes: [x, y]}\n";
    bodies +=
        bar("A" + k, "crank", "0.5 kg") + bar("B" + k, "coupler", "1 kg") + bar("C" + k, "rocker", "0.5 kg");
    guess *= 0.95;  // so are the angles of these loops, about
    home += ", coupler" + k + ": -" + std::to_string(guess) + " deg, rocker" + k + ": " +
            std::to_string(guess) + " deg";
  }
  return "constants: {ground: 1 m, crank: 0.5 m, coupler: 1.05 m, rocker: 0.55 m}\nmotors: "
         "[drive]\ncoordinates: [" +
         coordinates + "]\nconstraints:\n" + constraints + "transforms:\n" + transforms + "closures:\n" +
         closures + "bodies:\n" + bodies + "gravity: [0, -9.81, 0]\nend_effector: {frame: C" + number(n) +
         ", axes: [x]}\nhome: {drive: 60 deg" + home + "}\n";
}

}  // namespace mixloop::oracle
