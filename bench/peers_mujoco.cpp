// SPDX-License-Identifier: MIT
// The paper's robot in MuJoCo: with its couplings as MuJoCo's own constraints, and as an open tree whose
// mass matrix and bias the user projects with C.
#include <mujoco/mujoco.h>

#include <cstring>
#include <memory>
#include <stdexcept>
#include <string>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "bench/engine.hpp"
#include "bench/robot_tree.hpp"

namespace mixloop::bench {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Vector6 = Eigen::Matrix<double, kJoints, 1>;
using Matrix6 = Eigen::Matrix<double, kJoints, kJoints, Eigen::RowMajor>;
using Matrix63 = Eigen::Matrix<double, kJoints, 3>;

std::string number(double x) {
  char text[40];
  std::snprintf(text, sizeof text, "%.17g ", x);
  return text;
}

/// Body i is joint i's frame; its link frame lies Tz(s) Tx(a) Rx(alpha) further on.
std::string body_xml(int i, double payload) {
  const TreeJoint& joint = kTree[i];
  std::string xml = "<body";
  if (joint.parent >= 0) {
    const TreeJoint& parent = kTree[joint.parent];
    xml +=
        " pos='" + number(parent.a) + "0 " + number(parent.s) + "' euler='" + number(parent.alpha) + "0 0'";
  }
  const double c = std::cos(joint.alpha), s = std::sin(joint.alpha);
  const auto& r = joint.centre;
  xml += ">\n<joint name='j" + std::to_string(i) + "' type='hinge' axis='0 0 1'/>\n<inertial mass='" +
         number(joint.mass) + "' pos='" + number(joint.a + r[0]) + number(c * r[1] - s * r[2]) +
         number(joint.s + s * r[1] + c * r[2]) + "' euler='" + number(joint.alpha) + "0 0' diaginertia='";
  // MuJoCo wants every inertia positive; link 5 has none about its own axis.
  for (const double inertia : joint.inertia) xml += number(std::max(inertia, 1e-14));
  xml += "'/>\n";
  // The payload as a body of its own, welded on (a point mass, 1e-14 kg m^2 again).
  if (i == kEndEffectorJoint)
    xml += "<body pos='" + number(joint.a) + "0 " + number(joint.s) + "'><inertial mass='" + number(payload) +
           "' pos='0 0 0' diaginertia='1e-14 1e-14 1e-14'/></body>\n";
  for (int child = i + 1; child < kJoints; ++child)
    if (kTree[child].parent == i) xml += body_xml(child, payload);
  return xml + "</body>\n";
}

/// With constraints: q5, q6 and q4 (joints 2, 4, 5) each as a linear function of q2 and q3 (joints 1, 3),
/// which takes a tendon; its length is held by the stiffest equality that MuJoCo accepts.
std::string model_xml(bool constrained) {
  std::string xml =
      "<mujoco><compiler angle='radian' autolimits='true' balanceinertia='false'/>"
      "<option gravity='0 0 " +
      number(-kGravity) +
      "' timestep='0.001' solver='Newton' iterations='10' "
      "tolerance='1e-12' jacobian='dense'><flag contact='disable' "
      "refsafe='disable'/></option>\n<worldbody>\n" +
      body_xml(0, kPayload) + "</worldbody>\n";
  if (constrained) {
    struct Coupling {
      int joint;
      double by_q2, by_q3, offset;
    };
    // q5 = 2 q2 - 2 q3 + ..., q6 = q2 - q3 - beta, q4 = -q2 + q3 + pi + beta
    const Coupling couplings[] = {
        {2, 2, -2, kCouplingOffset[2]}, {4, 1, -1, kCouplingOffset[4]}, {5, -1, 1, kCouplingOffset[5]}};
    std::string tendons, equalities;
    for (const Coupling& c : couplings) {
      const std::string name = "t" + std::to_string(c.joint);
      tendons += "<fixed name='" + name + "'><joint joint='j" + std::to_string(c.joint) +
                 "' coef='1'/><joint joint='j1' coef='" + number(-c.by_q2) + "'/><joint joint='j3' coef='" +
                 number(-c.by_q3) + "'/></fixed>\n";
      equalities += "<tendon tendon1='" + name + "' polycoef='" + number(c.offset) +
                    "0 0 0 0' solref='0.001 1' solimp='0.9999 0.9999 0.001 0.5 2'/>\n";
    }
    xml += "<tendon>" + tendons + "</tendon><equality>" + equalities + "</equality>\n";
  }
  return xml + "</mujoco>";
}

class MujocoRobot {
 public:
  explicit MujocoRobot(bool constrained) {
    const std::string xml = model_xml(constrained);
    const auto files = std::make_unique<mjVFS>();
    mj_defaultVFS(files.get());
    mj_makeEmptyFileVFS(files.get(), "robot.xml", static_cast<int>(xml.size()));
    std::memcpy(files->filedata[mj_findFileVFS(files.get(), "robot.xml")], xml.data(), xml.size());
    char error[1000] = "";
    model_ = mj_loadXML("robot.xml", files.get(), error, sizeof error);
    mj_deleteVFS(files.get());
    if (!model_) throw std::runtime_error(std::string("MuJoCo refuses the robot: ") + error);
    data_ = mj_makeData(model_);
    for (int i = 0; i < kJoints; ++i)
      for (int j = 0; j < 3; ++j) C_(i, j) = kCoupling[i][j];
    q0_ = Vector6(kCouplingOffset.data());
  }
  MujocoRobot(const MujocoRobot&) = delete;
  MujocoRobot& operator=(const MujocoRobot&) = delete;
  ~MujocoRobot() {
    mj_deleteData(data_);
    mj_deleteModel(model_);
  }

  /// MuJoCo's own constrained forward dynamics.
  void constrained(const State& state, Triple& psidd) {
    place(state);
    const auto torque = basis_torque(state.tau);
    data_->qfrc_applied[0] = torque[0];
    data_->qfrc_applied[1] = torque[1];
    data_->qfrc_applied[3] = torque[2];
    mju_zero(data_->qacc_warmstart, kJoints);  // states here do not follow one another
    mj_forward(model_, data_);
    psidd = motor_acceleration(data_->qacc[0], data_->qacc[1], data_->qacc[3]);
  }

  /// MuJoCo's own Runge-Kutta steps, the state carried in its six joints.
  void own_steps(State& state, double length, int steps) {
    place(state);
    const auto torque = basis_torque(state.tau);
    data_->qfrc_applied[0] = torque[0];
    data_->qfrc_applied[1] = torque[1];
    data_->qfrc_applied[3] = torque[2];
    model_->opt.integrator = mjINT_RK4;
    model_->opt.timestep = length / steps;
    for (int step = 0; step < steps; ++step) mj_step(model_, data_);
    state.psi =
        motor_acceleration(data_->qpos[0], data_->qpos[1], data_->qpos[3]);  // linear: serves positions too
    state.psid = motor_acceleration(data_->qvel[0], data_->qvel[1], data_->qvel[3]);
  }

  void projected(const State& state, Triple& psidd) {
    place(state);
    const Matrix3d M = mass();
    Vector6 h;
    mj_comVel(model_, data_);
    mj_rne(model_, data_, 0, h.data());
    Eigen::Map<Vector3d>(psidd.data()) = M.llt().solve(Vector3d(state.tau.data()) - C_.transpose() * h);
  }

  void mass_matrix(const State& state, MassMatrix& upper) {
    place(state);
    const Matrix3d M = mass();
    upper = {M(0, 0), M(0, 1), M(0, 2), M(1, 1), M(1, 2), M(2, 2)};
  }

 private:
  void place(const State& state) {
    Eigen::Map<Vector6>(data_->qpos) = C_ * Eigen::Map<const Vector3d>(state.psi.data()) + q0_;
    Eigen::Map<Vector6>(data_->qvel) = C_ * Eigen::Map<const Vector3d>(state.psid.data());
  }

  Matrix3d mass() {
    mj_kinematics(model_, data_);
    mj_comPos(model_, data_);
    mj_crb(model_, data_);
    Matrix6 M;
    mj_fullM(model_, M.data(), data_->qM);
    return C_.transpose() * M * C_;
  }

  mjModel* model_ = nullptr;
  mjData* data_ = nullptr;
  Matrix63 C_;
  Vector6 q0_;
};

}  // namespace

void add_mujoco(Engines& engines) {
  const auto tree = std::make_shared<MujocoRobot>(false), coupled = std::make_shared<MujocoRobot>(true);
  const std::string version = std::string("MuJoCo ") + mj_versionString();
  Engine open;
  open.name = version + ", open tree, projected by the user";
  open.tolerance = 1e-9;
  open.forward = [tree](const State& state, Triple& psidd) { tree->projected(state, psidd); };
  open.mass = [tree](const State& state, MassMatrix& M) { tree->mass_matrix(state, M); };
  engines.push_back(std::move(open));
  Engine own;
  own.name = version + ", couplings as its equality constraints";
  own.tolerance = 5e-2;  // its constraints are soft: what its stiffest settings leave (median 1e-3)
  own.forward = [coupled](const State& state, Triple& psidd) { coupled->constrained(state, psidd); };
  own.own_tick = [coupled](State& state, double length, int steps) {
    coupled->own_steps(state, length, steps);
  };
  engines.push_back(std::move(own));
}

}  // namespace mixloop::bench
