// SPDX-License-Identifier: MIT
// The planar 3-RRR and the delta robot in MuJoCo: platforms are held by its own equalities, of two points or
// of a tendon's length, as stiff as it accepts.
#include <mujoco/mujoco.h>

#include <fmt/format.h>

#include <cmath>
#include <cstring>
#include <memory>
#include <numbers>
#include <stdexcept>

#include "bench/closed_engine.hpp"

namespace mixloop::bench {
namespace {

constexpr double kThird = 2 * std::numbers::pi / 3;
constexpr const char* kStiff = "solref='0.001 1' solimp='0.9999 0.9999 0.001 0.5 2'";

class MujocoPlatform {
 public:
  MujocoPlatform(const std::string& bodies, const std::string& equalities, const char* gravity) {
    const std::string xml = fmt::format(
        "<mujoco><compiler angle='radian' autolimits='true' balanceinertia='false'/>"
        "<option gravity='{}' timestep='0.001' solver='Newton' iterations='10' tolerance='1e-12' "
        "jacobian='dense'><flag contact='disable' refsafe='disable'/></option>\n"
        "<worldbody>\n{}</worldbody>\n{}</mujoco>",
        gravity, bodies, equalities);
    const auto files = std::make_unique<mjVFS>();
    mj_defaultVFS(files.get());
    mj_makeEmptyFileVFS(files.get(), "platform.xml", static_cast<int>(xml.size()));
    std::memcpy(files->filedata[mj_findFileVFS(files.get(), "platform.xml")], xml.data(), xml.size());
    char error[1000] = "";
    model_ = mj_loadXML("platform.xml", files.get(), error, sizeof error);
    mj_deleteVFS(files.get());
    if (!model_) throw std::runtime_error(std::string("MuJoCo refuses the platform: ") + error);
    data_ = mj_makeData(model_);
  }
  MujocoPlatform(const MujocoPlatform&) = delete;
  MujocoPlatform& operator=(const MujocoPlatform&) = delete;
  ~MujocoPlatform() {
    mj_deleteData(data_);
    mj_deleteModel(model_);
  }

  int joint(const char* name) const { return model_->jnt_dofadr[mj_name2id(model_, mjOBJ_JOINT, name)]; }
  void put(int joint, double q, double qd) { data_->qpos[joint] = q, data_->qvel[joint] = qd; }
  void drive(int joint, double torque) { data_->qfrc_applied[joint] = torque; }
  void forward() {
    mju_zero(data_->qacc_warmstart, model_->nv);  // states here do not follow one another
    mj_forward(model_, data_);
  }
  double acceleration(int joint) const { return data_->qacc[joint]; }

 private:
  mjModel* model_ = nullptr;
  mjData* data_ = nullptr;
};

std::string hinged(const std::string& name, double x, double y, double angle, const char* axis,
                   const std::string& within) {
  const bool flat = axis[0] == 'z';
  return fmt::format(
      "<body name='{0}' pos='{1:.17g} {2:.17g} 0' euler='{3}'><joint name='{0}' type='hinge' axis='{4}' "
      "ref='{5:.17g}'/>{6}</body>\n",
      name, x, y, flat ? fmt::format("0 0 {:.17g}", angle) : fmt::format("0 {:.17g} 0", angle),
      flat ? "0 0 1" : "0 1 0", angle, within);
}

std::string slender(double mass, double length) {
  const double inertia = mass * length * length / 12;
  return fmt::format("<inertial mass='{:.17g}' pos='{:.17g} 0 0' diaginertia='1e-14 {:.17g} {:.17g}'/>", mass,
                     length / 2, inertia, inertia);
}

/// The scene's q: rod1, rod2, rod3, turn from the ground's x axis.
constexpr double kCrank = 0.25, kRod = 0.35;

std::shared_ptr<MujocoPlatform> planar_3rrr(const ClosedState& home) {
  std::string bodies, equalities = "<equality>";
  for (std::size_t k = 0; k < 3; ++k) {
    const double at = static_cast<double>(k) * kThird - 5 * std::numbers::pi / 6;
    std::string on_rod = slender(2 * kRod, kRod);
    if (k == 0)
      on_rod +=
          hinged("platform", kRod, 0, home.q[3] - home.q[0], "z",
                 fmt::format("<inertial mass='1.2' pos='{:.17g} {:.17g} 0' diaginertia='0.004 0.004 0.008'/>",
                             -0.12 * std::cos(at), -0.12 * std::sin(at)));
    const std::string number = std::to_string(k + 1);
    bodies += hinged("crank" + number, 0.5 * std::cos(at), 0.5 * std::sin(at), home.psi[k], "z",
                     slender(2 * kCrank, kCrank) +
                         hinged("rod" + number, kCrank, 0, home.q[k] - home.psi[k], "z", on_rod));
    if (k > 0)
      equalities += fmt::format("<connect body1='rod{}' body2='platform' anchor='{:.17g} 0 0' {}/>", number,
                                kRod, kStiff);
  }
  return std::make_shared<MujocoPlatform>(bodies, equalities + "</equality>", "0 -9.81 0");
}

/// The scene's q: x, y, z.
std::shared_ptr<MujocoPlatform> delta_robot(const ClosedState& home) {
  constexpr double arm = 0.2, arm_mass = 0.3, half_rods = 0.06, mass = arm_mass + half_rods;
  const double centre = (arm_mass * arm / 2 + half_rods * arm) / mass;
  const double inertia = arm_mass * arm * arm / 12 + arm_mass * std::pow(centre - arm / 2, 2) +
                         half_rods * std::pow(arm - centre, 2);
  std::string bodies, tendons = "<tendon>", equalities = "<equality>", corners;
  for (std::size_t k = 0; k < 3; ++k) {
    const double at = static_cast<double>(k) * kThird;
    const std::string number = std::to_string(k + 1);
    const std::string inside = fmt::format(
        "<inertial mass='{:.17g}' pos='{:.17g} 0 0' diaginertia='1e-14 {:.17g} {:.17g}'/>"
        "<site name='end{}' pos='{:.17g} 0 0'/>",
        mass, centre, inertia, inertia, number, arm);
    bodies += fmt::format("<body euler='0 0 {:.17g}'>{}</body>\n", at,
                          hinged("arm" + number, 0.16, 0, home.psi[k], "y", inside));
    corners += fmt::format("<site name='corner{}' pos='{:.17g} {:.17g} 0'/>", number, 0.04 * std::cos(at),
                           0.04 * std::sin(at));
    tendons += fmt::format("<spatial name='rods{0}'><site site='end{0}'/><site site='corner{0}'/></spatial>",
                           number);
    equalities += fmt::format("<tendon tendon1='rods{}' {}/>", number, kStiff);
  }
  bodies += fmt::format(
      "<body name='platform' pos='{0:.17g} {1:.17g} {2:.17g}'>"
      "<joint name='x' type='slide' axis='1 0 0' ref='{0:.17g}'/><joint name='y' type='slide' axis='0 1 0' "
      "ref='{1:.17g}'/><joint name='z' type='slide' axis='0 0 1' ref='{2:.17g}'/>"
      "<inertial mass='0.88' pos='0 0 0' diaginertia='1e-9 1e-9 1e-9'/>{3}</body>\n",
      home.q[0], home.q[1], home.q[2], corners);
  return std::make_shared<MujocoPlatform>(bodies, tendons + "</tendon>" + equalities + "</equality>",
                                          "0 0 -9.81");
}

std::string name(const char* of) { return std::string("MuJoCo ") + mj_versionString() + of; }

}  // namespace

// Its constraints are soft, and it leaves G' q' out of G q'' = -G' q': errors are as large as psi'' itself
// where mechanisms move.
void add_mujoco_planar_3rrr(ClosedEngines& engines, const ClosedState& home) {
  const auto platform = planar_3rrr(home);
  const std::array cranks{platform->joint("crank1"), platform->joint("crank2"), platform->joint("crank3")};
  const std::array rods{platform->joint("rod1"), platform->joint("rod2"), platform->joint("rod3")};
  const int turn = platform->joint("platform");
  engines.push_back(
      {name(", its equalities of two points"), HUGE_VAL, [=](const ClosedState& state, double* psidd) {
         for (std::size_t k = 0; k < 3; ++k) {
           platform->put(cranks[k], state.psi[k], state.psid[k]);
           platform->put(rods[k], state.q[k] - state.psi[k], state.qd[k] - state.psid[k]);
           platform->drive(cranks[k], state.tau[k]);
         }
         platform->put(turn, state.q[3] - state.q[0], state.qd[3] - state.qd[0]);
         platform->forward();
         for (std::size_t k = 0; k < 3; ++k) psidd[k] = platform->acceleration(cranks[k]);
       }});
}

void add_mujoco_delta_robot(ClosedEngines& engines, const ClosedState& home) {
  const auto robot = delta_robot(home);
  const std::array arms{robot->joint("arm1"), robot->joint("arm2"), robot->joint("arm3")};
  const std::array place{robot->joint("x"), robot->joint("y"), robot->joint("z")};
  engines.push_back(
      {name(", its equalities of a tendon's length"), HUGE_VAL, [=](const ClosedState& state, double* psidd) {
         for (std::size_t k = 0; k < 3; ++k) {
           robot->put(arms[k], state.psi[k], state.psid[k]);
           robot->put(place[k], state.q[k], state.qd[k]);
           robot->drive(arms[k], state.tau[k]);
         }
         robot->forward();
         for (std::size_t k = 0; k < 3; ++k) psidd[k] = robot->acceleration(arms[k]);
       }});
}

}  // namespace mixloop::bench
