// SPDX-License-Identifier: MIT
// The planar four-bar linkage in MuJoCo: coupler and rocker are held together by its own equality of two
// points, as stiff as it accepts.
#include <mujoco/mujoco.h>

#include <fmt/format.h>

#include <cstring>
#include <memory>
#include <stdexcept>

#include "bench/closed_engine.hpp"

namespace mixloop::bench {
namespace {

/// A bar along its x axis from a hinge, turned by `angle` where the model is put together; what hangs on it
/// within.
std::string bar_xml(const char* name, double at_x, double angle, double reference, double mass, double length,
                    double inertia, const std::string& child = "") {
  return fmt::format(
      "<body name='{0}' pos='{1:.17g} 0 0' euler='0 0 {2:.17g}'><joint type='hinge' axis='0 0 1' "
      "ref='{3:.17g}'/>"
      "<inertial mass='{4:.17g}' pos='{5:.17g} 0 0' diaginertia='1e-14 {6:.17g} {6:.17g}'/>{7}</body>\n",
      name, at_x, angle, reference, mass, length / 2, inertia, child);
}

std::string four_bar_xml(const FourBarHome& home) {
  const std::string coupler = bar_xml("coupler", 0.3, home.elbow, home.elbow, 2, 0.9, 0.05);
  return "<mujoco><compiler angle='radian' autolimits='true' balanceinertia='false'/>"
         "<option gravity='0 -9.81 0' timestep='0.001' solver='Newton' iterations='10' tolerance='1e-12' "
         "jacobian='dense'><flag contact='disable' refsafe='disable'/></option>\n<worldbody>\n" +
         bar_xml("crank", 0, home.crank, home.crank, 1, 0.3, 0.01, coupler) +
         bar_xml("rocker", 1, home.rocker, home.rocker, 1.5, 0.8, 0.04) +
         "</worldbody>\n<equality><connect body1='coupler' body2='rocker' anchor='0.9 0 0' "
         "solref='0.001 1' solimp='0.9999 0.9999 0.001 0.5 2'/></equality></mujoco>";
}

class MujocoFourBar {
 public:
  explicit MujocoFourBar(const FourBarHome& home) {
    const std::string xml = four_bar_xml(home);
    const auto files = std::make_unique<mjVFS>();
    mj_defaultVFS(files.get());
    mj_makeEmptyFileVFS(files.get(), "four_bar.xml", static_cast<int>(xml.size()));
    std::memcpy(files->filedata[mj_findFileVFS(files.get(), "four_bar.xml")], xml.data(), xml.size());
    char error[1000] = "";
    model_ = mj_loadXML("four_bar.xml", files.get(), error, sizeof error);
    mj_deleteVFS(files.get());
    if (!model_) throw std::runtime_error(std::string("MuJoCo refuses the four-bar linkage: ") + error);
    data_ = mj_makeData(model_);
  }
  MujocoFourBar(const MujocoFourBar&) = delete;
  MujocoFourBar& operator=(const MujocoFourBar&) = delete;
  ~MujocoFourBar() {
    mj_deleteData(data_);
    mj_deleteModel(model_);
  }

  void forward(const ClosedState& state, double* psidd) {
    data_->qpos[0] = state.psi[0], data_->qvel[0] = state.psid[0];
    for (int i = 0; i < 2; ++i) {
      data_->qpos[i + 1] = state.q[static_cast<std::size_t>(i)];
      data_->qvel[i + 1] = state.qd[static_cast<std::size_t>(i)];
    }
    data_->qfrc_applied[0] = state.tau[0];
    mju_zero(data_->qacc_warmstart, 3);  // states here do not follow one another
    mj_forward(model_, data_);
    psidd[0] = data_->qacc[0];
  }

 private:
  mjModel* model_ = nullptr;
  mjData* data_ = nullptr;
};

}  // namespace

void add_mujoco_four_bar(ClosedEngines& engines, const FourBarHome& home) {
  const auto linkage = std::make_shared<MujocoFourBar>(home);
  // Its constraints are soft, which leaves 1e-5 at rest, and it leaves G' q' out of G q'' = -G' q': as large
  // as psi'' itself where the linkage moves.
  engines.push_back({std::string("MuJoCo ") + mj_versionString() + ", its equality of two points", 5,
                     [linkage](const ClosedState& state, double* psidd) { linkage->forward(state, psidd); }});
}

}  // namespace mixloop::bench
