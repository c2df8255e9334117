// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <stdexcept>
#include <unordered_map>
#include <utility>
#include <vector>

namespace mixloop {

/// A node's place in its graph. Operands come before the node that uses them.
using NodeId = std::uint32_t;

/// What a node computes. `constant` and `input` are leaves; the rest take one operand (a), two (a, b) or
/// three.
enum class Op : std::uint8_t {
  constant,
  input,
  neg,
  sqrt,
  sin,
  cos,
  exp,
  log,
  hold,  ///< its operand, which nothing is simplified through; in no program
  add,
  sub,
  mul,
  div,
  atan2,
  fma,   ///< a b + c, rounded once
  fms,   ///< a b - c
  fnma,  ///< c - a b
};

constexpr std::size_t kOps = 17;

/// What else is known of an operation is a row in operations.hpp.
constexpr bool is_leaf(Op op) { return op <= Op::input; }
constexpr int arity(Op op) { return is_leaf(op) ? 0 : op < Op::add ? 1 : op < Op::fma ? 2 : 3; }

/// Where an input comes from. Whatever depends on parameters alone is computed before the run.
enum class Block : std::uint8_t {
  psi,
  psid,
  input,
  time,
  parameter,
  start,  ///< where closures are solved from; in programs behind what a purpose's input takes
};
constexpr std::size_t kBlocks = 6;

/// One operation. For `constant` the number is `value`; for `input`, a is the Block and b the index in it.
struct ExpressionNode {
  Op op = Op::constant;
  NodeId a = 0;
  NodeId b = 0;
  NodeId c = 0;
  double value = 0.0;
};

/// The nodes that an operation takes, in their order; none of a leaf.
class Operands {
 public:
  explicit constexpr Operands(const ExpressionNode& node)
      : ids_{node.a, node.b, node.c}, size_(arity(node.op)) {}
  constexpr const NodeId* begin() const { return ids_.data(); }
  constexpr const NodeId* end() const { return ids_.data() + size_; }

 private:
  std::array<NodeId, 3> ids_;
  int size_;
};

/// A scene's equations that take more operations than a graph may hold: no tracer records them.
struct GraphFull : std::length_error {
  GraphFull() : std::length_error("the equations of motion take more operations than can be recorded") {}
};

/// An angle as an affine sum of nodes: constant + sum of factor * node, nodes ascending.
struct AffineSum {
  double constant = 0.0;
  std::vector<std::pair<NodeId, double>> terms;
};

/// A graph of expressions in which equal expressions are one node.
///
/// Every operation folds constants and propagates zeros and ones; sums and products are put in one order;
/// keys are exact (the bits of a constant, never a tolerance). Sines and cosines see their angle as an
/// affine sum: angles that differ by a constant share one pair, and so do sums and differences of angles
/// that already have theirs.
class Graph {
 public:
  /// Of so many nodes at most; one more throws GraphFull. A program of a million operations gains nothing
  /// over the procedure itself, and takes 0.1 GB while it is traced.
  static constexpr std::size_t kMostNodes = 1 << 20;

  explicit Graph(std::size_t most_nodes = kMostNodes);

  NodeId constant(double value);
  NodeId input(Block block, std::size_t index);
  NodeId unary(Op op, NodeId a);
  NodeId binary(Op op, NodeId a, NodeId b);
  /// a b + c and its like (Op::fma, fms, fnma), which nothing is simplified through.
  NodeId fused(Op op, NodeId a, NodeId b, NodeId c);
  /// Any operation; of an operand that it doesn't take: anything.
  NodeId operation(Op op, NodeId a, NodeId b, NodeId c);

  const ExpressionNode& operator[](NodeId id) const { return nodes_[id]; }
  std::size_t size() const { return nodes_.size(); }

  /// The node's number, if it is a constant.
  std::optional<double> number(NodeId id) const;
  bool is_zero(NodeId id) const { return id == zero_; }
  NodeId zero() const { return zero_; }
  NodeId one() const { return one_; }

  /// The node as an affine sum of others (of itself, where nothing can be taken apart).
  const AffineSum& affine(NodeId id);

  /// A node that stands for another: of equal value, but with no past that anything is simplified by. Equal
  /// ones with equal tags are one.
  NodeId held(NodeId of, unsigned tag);
  /// Says what the cosine and sine of an angle are that has been held; they are held, too.
  void set_pair(NodeId angle, NodeId cosine, NodeId sine);

  /// Forgets the pairs that have been worked out through these nodes: what stood for an unknown is no part of
  /// other angles' sines later, though it would cancel.
  void forget_pairs_through(std::span<const NodeId> places);

  /// Sine and cosine of a node, from a shared pair where there is one.
  std::pair<NodeId, NodeId> sine_cosine(NodeId angle);

  /// How often the pair of an angle was met, and where it came from; for `explain`.
  struct AngleStatistics {
    std::size_t asked = 0, own = 0, offset = 0, combined = 0;
  };
  const AngleStatistics& angle_statistics() const { return angles_seen_; }

 private:
  struct Angle {
    AffineSum sum;
    NodeId sine, cosine;
  };

  NodeId intern(const ExpressionNode& node);
  std::size_t place_of(const ExpressionNode& node) const;
  void widen();
  std::optional<NodeId> known(const ExpressionNode& node) const;
  NodeId add(NodeId a, NodeId b);
  NodeId sub(NodeId a, NodeId b);
  NodeId mul(NodeId a, NodeId b);
  NodeId div(NodeId a, NodeId b);
  NodeId neg(NodeId a);
  std::optional<NodeId> pythagoras(NodeId a, NodeId b);
  bool is_affine(const ExpressionNode& node) const;
  AffineSum affine_of_known_parts(NodeId id) const;
  std::pair<NodeId, NodeId> rotated(NodeId sine, NodeId cosine, double by);
  std::optional<std::pair<NodeId, NodeId>> from_known(const AffineSum& sum);
  bool is(NodeId id, Op op) const { return nodes_[id].op == op; }

  static constexpr NodeId kNone = ~NodeId{0};

  std::size_t most_nodes_;
  std::vector<ExpressionNode> nodes_;
  std::vector<NodeId> ids_;  ///< by the nodes' hashes, a power of two of places, half of them taken at most
  std::unordered_map<NodeId, AffineSum> affine_;
  std::unordered_map<NodeId, std::pair<NodeId, NodeId>> pairs_;
  std::vector<Angle> angles_;
  std::unordered_map<NodeId, NodeId> partners_;  ///< of a held sine its cosine, and the other way round
  AngleStatistics angles_seen_;
  NodeId zero_ = 0, one_ = 0;
};

/// The operation on numbers, as every evaluator computes it.
double apply(Op op, double a, double b = 0.0, double c = 0.0);

/// For each of the first `count` nodes, whether one of the roots, which stand among them, needs it.
std::vector<bool> needed(const Graph& graph, std::span<const NodeId> roots, std::size_t count);
/// For each node, whether one of the roots needs it.
inline std::vector<bool> needed(const Graph& graph, std::span<const NodeId> roots) {
  return needed(graph, roots, graph.size());
}

}  // namespace mixloop
