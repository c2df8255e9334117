// SPDX-License-Identifier: MIT
#include "dynamics/program/tape.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace mixloop {
namespace {

// An instruction before it has its place: which nodes it takes and which it gives.
struct Instruction {
  Tape::Kind kind;
  Program::Stage stage;
  std::vector<NodeId> takes, gives;
};

class TapeMaker {
 public:
  explicit TapeMaker(const Program& program) : program_(program), slot_(program.nodes.size(), 0) {}

  Tape make() {
    place_leaves();
    gather();
    place(Program::Stage::set_up, tape_.set_up);
    place(Program::Stage::run, tape_.run);
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

  // Products that only the last operand of one fused operation is.
  std::vector<bool> products_within() const {
    std::vector<int> uses(program_.nodes.size(), 0);
    for (const ExpressionNode& n : program_.nodes)
      for (NodeId x : Operands(n)) ++uses[x];
    for (NodeId output : program_.outputs) ++uses[output];
    std::vector<bool> within(program_.nodes.size(), false);
    for (NodeId id = 0; id < program_.nodes.size(); ++id) {
      const ExpressionNode& n = program_.nodes[id];
      if (arity(n.op) == 3 && program_.nodes[n.c].op == Op::mul && uses[n.c] == 1)
        within[n.c] = program_.stages[n.c] == program_.stages[id];
    }
    return within;
  }

  void gather() {
    const std::vector<NodeId> partner = program_.partners();
    const std::vector<bool> within = products_within();
    for (NodeId id = 0; id < program_.nodes.size(); ++id) {
      const ExpressionNode& n = program_.nodes[id];
      if (is_leaf(n.op) || within[id]) continue;
      const Operands operands(n);
      Instruction made{{n.op}, program_.stages[id], {operands.begin(), operands.end()}, {id}};
      if (n.op == Op::sin || n.op == Op::cos) {
        const NodeId other = partner[id];
        if (other < id) continue;  // it has been with its partner
        made.kind.op = Op::sin;
        made.gives = n.op == Op::sin ? std::vector{id, other} : std::vector{other, id};
      } else if (arity(n.op) == 3 && within[n.c]) {
        made.kind.of_product = true;
        made.takes = {n.a, n.b, program_.nodes[n.c].a, program_.nodes[n.c].b};
      }
      instructions_.push_back(std::move(made));
    }
  }

  // Of a stage's instructions those that wait for each one.
  std::vector<std::vector<std::size_t>> takers(Program::Stage stage) const {
    std::vector<std::size_t> maker(program_.nodes.size(), instructions_.size());
    std::vector<std::vector<std::size_t>> takers(instructions_.size());
    for (std::size_t i = 0; i < instructions_.size(); ++i) {
      if (instructions_[i].stage != stage) continue;
      for (NodeId id : instructions_[i].takes)
        if (maker[id] < instructions_.size()) takers[maker[id]].push_back(i);
      for (NodeId id : instructions_[i].gives)
        if (id < maker.size()) maker[id] = i;
    }
    return takers;
  }

  // Instructions of one kind that wait for nothing, and the longest chain that begins with one of them.
  struct Ready {
    std::vector<std::size_t> instructions;
    std::size_t chain = 0;
    bool operator<(const Ready& y) const {
      return std::pair(chain, instructions.size()) < std::pair(y.chain, y.instructions.size());
    }
  };

  // The longest chain first, with all of its kind that is ready or gets so: which makes few runs, and leaves
  // the processor what to do while it waits.
  void place(Program::Stage stage, Tape::Part& part) {
    const std::vector<std::vector<std::size_t>> takers = this->takers(stage);
    std::vector<std::size_t> missing(instructions_.size(), 0), chain(instructions_.size(), 1);
    for (std::size_t i = instructions_.size(); i-- > 0;)
      for (std::size_t taker : takers[i]) ++missing[taker], chain[i] = std::max(chain[i], 1 + chain[taker]);
    std::array<Ready, kKinds> ready;
    const auto is_ready = [&](std::size_t i) {
      Ready& kind = ready[number_of(instructions_[i].kind)];
      kind.instructions.push_back(i);
      kind.chain = std::max(kind.chain, chain[i]);
    };
    for (std::size_t i = 0; i < instructions_.size(); ++i)
      if (instructions_[i].stage == stage && missing[i] == 0) is_ready(i);
    const auto carry_out = [&](const Ready& kind) {
      for (std::size_t k = 0; k < kind.instructions.size(); ++k) {
        const std::size_t i = kind.instructions[k];
        emit(instructions_[i], part);
        for (std::size_t taker : takers[i])
          if (--missing[taker] == 0) is_ready(taker);
      }
      add_runs(instructions_[kind.instructions[0]].kind, kind.instructions.size(), part);
    };
    part.first = static_cast<Tape::Slot>(tape_.values.size());
    for (;;) {
      Ready& next = *std::max_element(ready.begin(), ready.end());
      if (next.instructions.empty()) return;
      // Angles are taken before a sine is there: not those of sines that it makes ready.
      if (instructions_[next.instructions[0]].kind.op == Op::sin)
        carry_out(std::exchange(next, {}));
      else
        carry_out(next), next = {};
    }
  }

  static void add_runs(Tape::Kind kind, std::size_t count, Tape::Part& part) {
    const std::size_t rest = count % static_cast<std::size_t>(block_of(kind));
    for (const std::size_t n : {count - rest, rest})
      if (n > 0) part.runs.push_back({kind, static_cast<std::uint32_t>(n)});
  }

  void emit(const Instruction& instruction, Tape::Part& part) {
    for (NodeId id : instruction.takes) part.operands.push_back(slot_[id]);
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
