// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "notation/formula.hpp"

namespace mixloop {

/// A mechanism as its file describes it, checked, in SI and radians, constants folded.
///
/// Formulas refer to numbered symbols (see Symbols). Numbers that depend on no parameter are constant
/// formulas; constraints and loads may depend on time.
struct Scene {
  /// An independent coordinate psi_i: an angle, or a displacement where `linear`.
  struct Independent {
    std::string name;
    bool linear = false;
    bool driven = true;  ///< by a motor
  };

  /// A dependent coordinate q_j and the constraint equation that gives it, (1); one without is solved from
  /// the closures, and its formula has a dimension alone.
  struct Coordinate {
    std::string name;
    Formula constraint;
    double home = 0;  ///< of a solved one the guess where psi is home; once closures are assembled, its value
    Place place = {};

    bool is_solved() const { return constraint.nodes.empty(); }
  };

  /// What holds where a chain closes; each row is an equation that is zero.
  struct Closure {
    enum class Kind { coincide, distance, parallel, align, zero };
    static constexpr std::array kKinds = {"coincide", "distance", "parallel", "align", "zero"};

    std::string name;
    Kind kind = Kind::zero;
    std::array<int, 2> frames = {};
    std::array<std::array<Formula, 3>, 2> vectors;  ///< points (m), or axes, in the frames' axes
    std::vector<int> axes = {};                     ///< of coincide: which of x, y, z
    int in = -1;                                    ///< of coincide: the frame whose axes they are
    Formula value;                                  ///< a distance's length (m); what is zero
    double home_length = 1;                         ///< a distance's, assembled
    int least_axis = 0;                             ///< of parallel: where the first axis points least
    Place place = {};

    bool has_points() const { return kind == Kind::coincide || kind == Kind::distance; }
    int rows() const;
  };
  struct ClosureRow {
    int closure = 0, row = 0;
  };

  /// Coordinates that rows, as many, are solved for together.
  struct Block {
    std::vector<int> unknowns;
    std::vector<ClosureRow> rows;
    std::vector<int> within;  ///< coordinates with a formula of these that the rows need, in order
    bool by_newton = true;    ///< solved by corrections from a start, else in closed form
    std::vector<int> cut;     ///< the unknowns that are corrected, where the others follow; none: all are

    /// What is corrected from a start.
    std::span<const int> corrected() const {
      if (!by_newton) return {};
      return cut.empty() ? unknowns : cut;
    }
  };

  /// How the dependent coordinates follow one after the other: by a formula, or a block of them.
  struct Step {
    int coordinate = -1;
    int block = -1;
  };

  /// A number that stays variable at run time, with its default.
  struct Parameter {
    std::string name;
    Dimension dimension;
    double value = 0;
    Place place;
  };

  /// A Denavit-Hartenberg transform, from frame `parent` to the frame that it makes. A pose or joint of
  /// the file may take several, by frames without a name.
  /// At most one of theta and s contains a coordinate, and is affine in it.
  struct Transform {
    int parent = 0;                 ///< a frame's index; frame i + 1 is made by transform i
    Formula theta, s, a, alpha;     ///< rad, m, m, rad
    std::optional<int> coordinate;  ///< index of the varying coordinate
    bool prismatic = false;         ///< it varies s, not theta
    Place place;
  };

  /// A rigid body (5): its frame, mass, centre of mass and inertia about it in the frame's axes.
  struct Body {
    std::string name;
    int frame = 0;
    Formula mass;
    std::array<Formula, 3> center_of_mass;
    std::array<Formula, 6> inertia;  ///< xx, yy, zz, xy, xz, yz (tensor elements: I_xy = -integral x y dm)
    Place place;
  };

  /// An external force (inertial axes) at a point of a frame, and a moment (frame axes), (21).
  struct Load {
    int frame = 0;
    std::array<Formula, 3> point, force, moment;
  };

  /// A spring and viscous friction at a coordinate: the force (or moment) -stiffness (q - rest) - damping q'.
  struct CoordinateLoad {
    int coordinate = 0;
    Formula stiffness, rest, damping;  ///< N m/rad, rad, N m s/rad; of a displacement N/m, m, N s/m
  };

  /// What acts along a quantity f, an angle or a length: the moment (or force) -stiffness (f - rest) -
  /// damping f', f' its total rate. Units as of a CoordinateLoad.
  struct SpringDamper {
    Formula stiffness, rest, damping;
  };

  /// Such a load along a formula of coordinates, which may depend on time.
  struct AlongLoad {
    Formula along;
    SpringDamper law;
  };

  /// Such a load along the distance of two points. A rest of 0 is a spring that ends meet by, regular there;
  /// else a distance of 0 has no direction, and what depends on it is not finite.
  struct BetweenLoad {
    struct End {
      int frame = 0;
      std::array<Formula, 3> point;  ///< m, in the frame's axes
    };
    std::array<End, 2> ends;
    SpringDamper law;
  };

  /// What a viewer draws along with a frame: no part of the mechanism. m, in the frame's axes.
  struct Solid {
    enum class Shape { box, sphere, cylinder, capsule };
    static constexpr std::array kShapes = {"box", "sphere", "cylinder", "capsule"};

    int frame = 0;
    Shape shape = Shape::box;
    std::array<double, 3> size = {};           ///< a box's edges
    double radius = 0;                         ///< of the others
    std::array<double, 3> from = {}, to = {};  ///< the axis' ends; of a box and a sphere both are the centre
  };

  /// Of a scene that names none: the origin of the ground, which stands still.
  struct EndEffector {
    bool named = true;
    int frame = 0;
    std::array<Formula, 3> point;
    std::vector<int> axes = {0, 1, 2};  ///< which of x, y, z a path prescribes
    std::vector<int> turns;  ///< and about which of them: all, as roll, pitch and yaw, or one alone
    /// Or where this axis of the frame, of length 1, points.
    std::optional<std::array<double, 3>> direction;
    bool is_oriented() const { return direction || !turns.empty(); }
  };

  /// A quantity that no path may take through zero, e.g. sin(q4) for a parallelogram.
  struct Singularity {
    std::string name;
    Formula measure;
    Place place;
  };

  std::string name;
  std::vector<Independent> independent;  ///< Psi: the motors, then the free ones
  std::vector<Coordinate> coordinates;
  std::vector<int> evaluation_order;  ///< of the constraints: each after those it refers to
  std::vector<Closure> closures;
  std::vector<Block> blocks;
  std::vector<Step> steps;                 ///< of all coordinates, each after those it needs
  std::vector<int> started;                ///< coordinates that are solved, or wound, from a start
  std::vector<int> linear;                 ///< coordinates whose formula was found from the closures
  std::vector<ClosureRow> redundant_rows;  ///< follow from the others, and are not solved
  std::vector<Parameter> parameters;
  std::vector<Transform> transforms;  ///< parents first
  std::vector<std::string> frames;    ///< names, empty of those amid a pose; frame 0 is the ground
  std::vector<Body> bodies;
  std::vector<Load> loads;
  std::vector<CoordinateLoad> coordinate_loads;
  std::vector<AlongLoad> along_loads;
  std::vector<BetweenLoad> between_loads;
  std::array<Formula, 3> gravity;  ///< m/s^2, inertial axes
  EndEffector end_effector;
  double size = 1;           ///< m, of the mechanism whose closures are solved: what is near there
  std::vector<double> home;  ///< psi that picks the branch of the inverse kinematics
  std::vector<Singularity> singularities;
  std::vector<Solid> solids;
  std::vector<std::string> warnings;  ///< `file:line:column: what`, e.g. a triangle inequality
  std::string canonical;              ///< a text equal for equal mechanisms, to hash
  /// Of none read from a file: viscous friction is times a number, the last of the parameters' values.
  bool friction_factor = false;
  /// Of none read from a file: all blocks are solved by corrections from a start, which says the branch.
  bool from_starts = false;
  /// Of none read from a file: the coordinate that each motor acts along, where that isn't its psi; else -1.
  /// Empty: along psi, each.
  std::vector<int> acts_along;

  /// How many numbers say where closures are solved from: of each started coordinate its value and, of an
  /// angle, its cosine and sine.
  int start_size() const;
  /// How many coordinates are solved by corrections from a start.
  int corrections() const;
  /// Of a scene with a torn block, how many numbers say how the started coordinates move: of each its
  /// derivatives by psi and t.
  int started_rates() const;
  bool turns(int coordinate) const;             ///< whether it is an angle
  bool is_length(const ClosureRow& row) const;  ///< or an angle
  /// Whether anything but inertia, gravity and the motors acts.
  bool is_loaded() const {
    return !loads.empty() || !coordinate_loads.empty() || !along_loads.empty() || !between_loads.empty();
  }
  int n() const { return static_cast<int>(independent.size()); }
  /// The independent coordinates that motors drive: motor i drives psi_i, so a force tau_i acts along it
  /// (unless acts_along says along what).
  int n_u() const { return static_cast<int>(motors().size()); }
  std::span<const Independent> motors() const;
  /// Whether there is viscous friction.
  bool has_friction() const;
  int m() const { return static_cast<int>(coordinates.size()); }
  /// Whether coordinates are solved from closures as the mechanism moves.
  bool is_closed() const { return !blocks.empty(); }
  /// Of the parameters, and 1 of the friction's factor where there is one.
  std::vector<double> default_parameters() const;
};

/// The numbers of a scene's symbols in its formulas: time, then parameters, psi and q.
struct Symbols {
  explicit Symbols(const Scene& scene)
      : psi0(1 + static_cast<int>(scene.parameters.size())), q0(psi0 + scene.n()) {}
  Symbols(int parameters, int n) : psi0(1 + parameters), q0(psi0 + n) {}

  static constexpr int kTime = 0;
  static constexpr int kParameter0 = 1;
  int psi0;
  int q0;

  bool is_parameter(int symbol) const { return symbol >= kParameter0 && symbol < psi0; }
  bool is_psi(int symbol) const { return symbol >= psi0 && symbol < q0; }
  bool is_q(int symbol) const { return symbol >= q0; }
};

}  // namespace mixloop
