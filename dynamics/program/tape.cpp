// SPDX-License-Identifier: MIT
#include "dynamics/program/tape.hpp"

#include <algorithm>
#include <array>

namespace mixloop {
namespace {

// An instruction before it has its place: which nodes it takes and which it gives.
struct Instruction {
  TapeOp op;
  Program::Stage stage;
  std::vector<NodeId> takes, gives;
};

TapeOp plain(Op op) { return op == Op::cos ? TapeOp::sincos : static_cast<TapeOp>(op); }

class TapeMaker {
 public:
  explicit TapeMaker(const Program& program) : program_(program), slot_(program.nodes.size(), 0) {}

  Tape make() {
    place_leaves();
    gather();
    tape_.set_up = place(Program::Stage::set_up);
    tape_.run = place(Program::Stage::run);
    for (NodeId output : program_.outputs) tape_.outputs.push_back(slot_[output]);
    return std::move(tape_);
  }

 private:
  Tape::Slot fresh_slot(double value = 0.0) {
    tape_.values.push_back(value);
    return static_cast<Tape::Slot>(tape_.values.size() - 1);
  }

  void place_leaves() {
    for (NodeId id = 0; id < program_.nodes.size(); ++id) {
      const ExpressionNode& n = program_.nodes[id];
      if (!is_leaf(n.op)) continue;
      slot_[id] = fresh_slot(n.value);
      if (n.op == Op::constant) continue;
      const Tape::Load load{static_cast<Block>(n.a), n.b, slot_[id]};
      (load.block == Block::parameter ? tape_.parameters : tape_.inputs).push_back(load);
    }
  }

  // How many operations (and outputs) take each node's value.
  std::vector<std::uint32_t> uses() const {
    std::vector<std::uint32_t> count(program_.nodes.size(), 0);
    for (NodeId output : program_.outputs) count[output] += 2;  // its slot is needed
    for (const ExpressionNode& n : program_.nodes) {
      if (is_leaf(n.op)) continue;
      ++count[n.a];
      if (is_binary(n.op)) ++count[n.b];
    }
    return count;
  }

  bool can_merge(NodeId product, NodeId into, const std::vector<std::uint32_t>& use) const {
    return program_.nodes[product].op == Op::mul && use[product] == 1 &&
           program_.stages[product] == program_.stages[into];
  }

  void gather() {
    const std::vector<NodeId> partner = program_.partners();
    const std::vector<std::uint32_t> use = uses();
    std::vector<bool> merged(program_.nodes.size(), false);
    for (NodeId id = static_cast<NodeId>(program_.nodes.size()); id-- > 0;) {
      const ExpressionNode& n = program_.nodes[id];
      if (is_leaf(n.op) || merged[id]) continue;
      Instruction made{plain(n.op), program_.stages[id], {n.a}, {id}};
      if (is_binary(n.op)) made.takes.push_back(n.b);
      if (made.op == TapeOp::sincos) {
        const NodeId other = partner[id];
        if (other < program_.nodes.size()) merged[other] = true;
        made.gives = n.op == Op::sin ? std::vector{id, other} : std::vector{other, id};
      } else if (n.op == Op::add || n.op == Op::sub) {
        merge_product(n, id, use, merged, made);
      }
      instructions_.push_back(std::move(made));
    }
    std::reverse(instructions_.begin(), instructions_.end());
  }

  void merge_product(const ExpressionNode& n, NodeId id, const std::vector<std::uint32_t>& use,
                     std::vector<bool>& merged, Instruction& made) const {
    const bool left = can_merge(n.a, id, use);
    if (!left && !can_merge(n.b, id, use)) return;
    const NodeId product = left ? n.a : n.b;
    merged[product] = true;
    made.op = n.op == Op::add ? TapeOp::times_plus : left ? TapeOp::times_minus : TapeOp::minus_times;
    made.takes = {program_.nodes[product].a, program_.nodes[product].b, left ? n.b : n.a};
  }

  // Greedy: a run goes on as long as an instruction of its kind is ready; then comes the kind that most
  // wait for.
  std::vector<Tape::Run> place(Program::Stage stage) {
    std::vector<std::vector<std::size_t>> takers(program_.nodes.size());
    std::vector<std::uint32_t> missing(instructions_.size(), 0);
    std::vector<std::size_t> maker(program_.nodes.size(), instructions_.size());
    for (std::size_t i = 0; i < instructions_.size(); ++i)
      for (NodeId id : instructions_[i].gives)
        if (id < maker.size()) maker[id] = i;
    std::array<std::vector<std::size_t>, kTapeOps> ready;
    for (std::size_t i = 0; i < instructions_.size(); ++i) {
      if (instructions_[i].stage != stage) continue;
      for (NodeId id : instructions_[i].takes) {
        if (maker[id] == instructions_.size() || instructions_[maker[id]].stage != stage) continue;
        takers[id].push_back(i);
        ++missing[i];
      }
      if (missing[i] == 0) ready[static_cast<std::size_t>(instructions_[i].op)].push_back(i);
    }
    std::vector<Tape::Run> runs;
    for (;;) {
      auto most = std::max_element(ready.begin(), ready.end(),
                                   [](const auto& x, const auto& y) { return x.size() < y.size(); });
      if (most->empty()) return runs;
      runs.push_back({static_cast<TapeOp>(most - ready.begin()), 0,
                      static_cast<Tape::Slot>(tape_.values.size()),
                      static_cast<std::uint32_t>(tape_.operands.size())});
      for (std::size_t next = 0; next < most->size(); ++next) {
        const Instruction& done = instructions_[(*most)[next]];
        emit(done, runs.back());
        for (NodeId id : done.gives) {
          if (id >= takers.size()) continue;
          for (std::size_t taker : takers[id])
            if (--missing[taker] == 0)
              ready[static_cast<std::size_t>(instructions_[taker].op)].push_back(taker);
        }
      }
      most->clear();
    }
  }

  void emit(const Instruction& instruction, Tape::Run& run) {
    ++run.count;
    for (NodeId id : instruction.takes) tape_.operands.push_back(slot_[id]);
    for (NodeId id : instruction.gives) {
      const Tape::Slot slot = fresh_slot();
      if (id < slot_.size()) slot_[id] = slot;
    }
  }

  const Program& program_;
  std::vector<Tape::Slot> slot_;
  std::vector<Instruction> instructions_;
  Tape tape_;
};

}  // namespace

Tape make_tape(const Program& program) { return TapeMaker(program).make(); }

}  // namespace mixloop
