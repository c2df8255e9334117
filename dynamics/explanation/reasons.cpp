// SPDX-License-Identifier: MIT
// Why a scene's programs are as small as they are, in words of mechanics. What has no influence is found by
// varying it: on numbers, at seeded poses, so that no rule of the tracers has to be believed.
#include <fmt/format.h>

#include <cmath>
#include <random>

#include "dynamics/explanation/explanation.hpp"
#include "dynamics/procedure/procedure.hpp"
#include "dynamics/symbolic/closed_chains.hpp"
#include "dynamics/symbolic/evaluation_angles.hpp"
#include "dynamics/symbolic/harmonic_form.hpp"
#include "dynamics/symbolic/tracer.hpp"
#include "notation/long_work.hpp"
#include "notation/words.hpp"

namespace mixloop {
namespace {

using Sentences = std::vector<std::string>;

/// The procedure with its coordinates q set freely, as if there were no constraints.
class FreeTree {
 public:
  explicit FreeTree(const std::shared_ptr<const Scene>& scene)
      : scene_(scene),
        values_(scene->default_parameters()),
        model_(make_model<double>(scene, std::span<const double>(values_))),
        workspace_(model_) {
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    for (int j = 0; j < scene->m(); ++j) q_.push_back(unit(random));
  }

  Model<double>& model() { return model_; }
  std::vector<double>& q() { return q_; }

  Matrix mass_matrix() {
    place();
    dynamic_matrix(model_, workspace_);
    return workspace_.S;
  }
  double potential() {
    place();
    double sum = 0.0;
    for (const auto& body : model_.bodies)
      sum -= body.mass * model_.gravity.dot(at_point<double>(frame(body.frame), body.center_of_mass));
    return sum;
  }
  /// That the bodies add to the mass matrix.
  double elements() const {
    double sum = 0;
    for (const auto& body : model_.bodies) sum += std::pow(model_.path(body.frame).size(), 2);
    return sum;
  }
  /// The norm of what a moment of inertia of 1 about each of a body's axes adds to the mass matrix that was
  /// last worked out: (25), O^T I O.
  Vec3<double> added_by_inertia(const Model<double>::Body& body) {
    angular_variations<double>(workspace_.frames[static_cast<std::size_t>(body.frame)], workspace_.O);
    const auto joints = static_cast<Eigen::Index>(model_.path(body.frame).size());
    return workspace_.O.leftCols(joints).rowwise().squaredNorm();
  }
  Vec3<double> hand() {
    place();
    return at_point<double>(frame(scene_->end_effector.frame), model_.end_effector_point);
  }

 private:
  const Mat34<double>& frame(int index) const {
    return workspace_.frames[static_cast<std::size_t>(index)].T_0;
  }
  void place() {
    for (int j = 0; j < scene_->m(); ++j) workspace_.q[j] = q_[static_cast<std::size_t>(j)];
    frame_variations(model_, workspace_);
  }

  std::shared_ptr<const Scene> scene_;
  std::vector<double> values_;
  Model<double> model_;
  Workspace<double> workspace_;
  std::vector<double> q_;
};

bool differ(const Matrix& x, const Matrix& y) { return (x - y).norm() > 1e-12 * (x.norm() + y.norm()); }

void about_constraints(const std::shared_ptr<const Scene>& scene, Graph& graph, Sentences& say) {
  const ClosedCoordinates closed(scene);
  bool constant = true;
  std::size_t zeros = 0;
  std::vector<NodeId> nodes;
  for (int i = 0; i < scene->m(); ++i) {
    nodes.push_back(closed.q(i).node());
    for (int j = 0; j < scene->n(); ++j) {
      const Expression& c = closed.C()(i, j);
      constant = constant && c.is_number();
      zeros += c.is_number() && c.number() == 0.0;
    }
  }
  say.push_back(constant ? "The constraints are affine with constant coefficients: C is constant, so C-dot "
                           "and all that it multiplies vanish."
                         : "C varies with the pose: C-dot is needed.");
  if (zeros > 0)
    say.push_back(fmt::format("{} of C's {} elements are zero.", zeros, scene->m() * scene->n()));
  const auto is_needed = needed(graph, nodes);
  if (!is_needed[closed.inputs().t.node()])
    say.push_back("No constraint depends on time: no F_t, F_tt or mixed term.");
}

// As many elements of mass matrices as may be worked out to look at each coordinate by itself.
constexpr double kMostElements = 1e9;

void about_coordinates(const std::shared_ptr<const Scene>& scene, Sentences& say) {
  FreeTree tree(scene);
  if (tree.elements() * static_cast<double>(scene->m()) > kMostElements) {
    say.push_back("It is too large to look at what each coordinate moves.");
    return;
  }
  const Matrix S = tree.mass_matrix();
  const double V = tree.potential();
  const Vec3<double> hand = tree.hand();
  const double weight = V + S.norm();
  Sentences no_inertia, no_weight, no_use;
  for (std::size_t j = 0; j < tree.q().size(); ++j) {
    const std::string& name = scene->coordinates[j].name;
    work_goes_on();
    tree.q()[j] += 0.7;
    const bool turns_S = differ(tree.mass_matrix(), S);
    const bool lifts = std::fabs(tree.potential() - V) > 1e-12 * std::fabs(weight);
    const bool moves_hand = (tree.hand() - hand).norm() > 1e-12;
    tree.q()[j] -= 0.7;
    const auto at = static_cast<Eigen::Index>(j);
    if (S.row(at).isZero(0) && !lifts && !moves_hand)
      no_use.push_back(name);
    else if (!turns_S)
      no_inertia.push_back(name);
    if (!lifts && !S.row(at).isZero(0)) no_weight.push_back(name);
  }
  if (!no_inertia.empty())
    say.push_back(fmt::format(
        "No inertia depends on {}: what turns there turns as a whole, so its sine and cosine are not needed.",
        joined(no_inertia)));
  if (!no_weight.empty() &&
      scene->gravity[0].is_zero() + scene->gravity[1].is_zero() + scene->gravity[2].is_zero() < 3)
    say.push_back(fmt::format(
        "The potential does not depend on {}: gravity is parallel to the axis, or nothing is lifted.",
        joined(no_weight)));
  if (!no_use.empty())
    say.push_back(fmt::format("{} move no mass and not the end effector: skipped.", joined(no_use)));
}

// A transform of the file may be several in a row, by frames without a name.
void about_axes(const std::shared_ptr<const Scene>& scene, Sentences& say) {
  std::size_t right = 0, parallel = 0, all = 0;
  bool turns = false, by_right_angles = true;
  for (std::size_t i = 0; i < scene->transforms.size(); ++i) {
    const Formula& alpha = scene->transforms[i].alpha;
    const double quarters = alpha.is_constant() ? alpha.constant() / 1.5707963267948966 : 0.5;
    by_right_angles = by_right_angles && std::fabs(quarters - std::round(quarters)) <= 1e-12;
    turns = turns || std::fabs(std::remainder(quarters, 2.0)) >= 0.5;
    if (scene->frames[i + 1].empty()) continue;
    ++all;
    if (by_right_angles) (turns ? right : parallel) += 1;
    turns = false, by_right_angles = true;
  }
  if (parallel > 0)
    say.push_back(
        fmt::format("{} of {} transforms leave the axis parallel: their angles add, and the sums take the "
                    "place of the products of their sines and cosines.",
                    parallel, all));
  if (right > 0)
    say.push_back(fmt::format("{} turn it by a right angle: zeros and ones, no products.", right));
}

// Bodies: what has no mass, no inertia, or inertia that never acts.
void about_bodies(const std::shared_ptr<const Scene>& scene, Sentences& say) {
  constexpr const char* kAxes[] = {"x", "y", "z"};
  FreeTree tree(scene);
  const double scale = tree.mass_matrix().norm();
  for (std::size_t i = 0; i < tree.model().bodies.size(); ++i) {
    const auto& body = tree.model().bodies[i];
    const std::string name =
        scene->bodies[i].name.empty() ? fmt::format("body {}", i + 1) : scene->bodies[i].name;
    if (scene->bodies[i].mass.is_zero()) say.push_back(fmt::format("{} is massless.", name));
    if (body.inertia.isZero(0)) {
      say.push_back(fmt::format("{} is a point mass: no moment of inertia.", name));
      continue;
    }
    Sentences none, idle;
    const Vec3<double> added = tree.added_by_inertia(body);
    for (Eigen::Index a = 0; a < 3; ++a) {
      if (body.inertia(a, a) == 0.0) none.push_back(kAxes[a]);
      if (added[a] <= 1e-12 * (2 * scale + added[a])) idle.push_back(kAxes[a]);
    }
    if (!none.empty())
      say.push_back(fmt::format("{} has no moment of inertia about {}.", name, joined(none)));
    if (!idle.empty())
      say.push_back(
          fmt::format("{} never turns about its {}: that moment of inertia is skipped.", name, joined(idle)));
  }
}

std::string row_text(const Eigen::RowVectorXd& row, const Scene& scene) {
  std::string text;
  for (Eigen::Index k = 0; k < row.size(); ++k) {
    if (row[k] == 0.0) continue;
    const double size = std::fabs(row[k]);
    const std::string factor = size == 1.0 ? "" : fmt::format("{:.6g} ", size);
    text += (text.empty() ? (row[k] < 0 ? "-" : "") : (row[k] < 0 ? " - " : " + ")) + factor +
            scene.independent[static_cast<std::size_t>(k)].name + "'";
  }
  return text;
}

void about_energy(const std::shared_ptr<const Scene>& scene, Graph& graph, Sentences& say) {
  const auto energy = harmonic_energy(scene, graph);
  if (!energy) {
    say.push_back(
        "Its energy is no small trigonometric polynomial of the independent angles: traced frame by frame "
        "along the tree.");
    return;
  }
  if (const auto angles = evaluation_angles(*energy)) {
    std::size_t joints = 0;
    for (const auto& transform : scene->transforms)
      joints += transform.coordinate.has_value() && !transform.prismatic;
    say.push_back(
        fmt::format("{} joint angles come down to {} sine/cosine pairs.", joints, angles->angles.size()));
  }
  const auto bases = candidate_bases(*energy, 1);
  if (bases.empty()) return;
  const BlockForm form = block_form(*energy, bases[0]);
  if (form.blocks.size() < 2) return;
  Sentences blocks;
  for (const auto& block : form.blocks) {
    Sentences rates;
    for (int i : block) rates.push_back(row_text(form.B.row(i), *scene));
    blocks.push_back("{" + joined(rates) + "}");
  }
  say.push_back(fmt::format("The mass matrix is block diagonal in the rates {}: solved block by block.",
                            joined(blocks, " and ")));
}

}  // namespace

std::vector<std::string> reasons_of(const std::shared_ptr<const Scene>& scene) {
  Sentences say;
  Graph graph;
  const Recording recording(graph);
  const auto if_recordable = [&](auto about) {
    try {
      about(scene, graph, say);
    } catch (const GraphFull& full) {
      say.push_back(fmt::format("Not recorded: {}.", full.what()));
    }
  };
  if_recordable(about_constraints);
  about_coordinates(scene, say);
  about_axes(scene, say);
  about_bodies(scene, say);
  for (auto& sentence : closure_reasons(scene)) say.push_back(std::move(sentence));
  if (!scene->is_closed()) if_recordable(about_energy);
  if (!scene->is_loaded()) say.push_back("No external loads.");
  if (!scene->parameters.empty()) {
    Sentences names;
    for (const auto& parameter : scene->parameters) names.push_back(parameter.name);
    say.push_back(
        fmt::format("Parameters ({}) stay variable: what depends on them alone is computed when they change, "
                    "not in an evaluation.",
                    joined(names)));
  }
  return say;
}

}  // namespace mixloop
