// SPDX-License-Identifier: MIT
#include "dynamics/program/tape.hpp"

#include <algorithm>
#include <array>

namespace mixloop {
namespace {

// An instruction before it has its place: which nodes it takes and which it gives.
struct Instruction {
  Op op;
  Program::Stage stage;
  std::vector<NodeId> takes, gives;
};

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

  void gather() {
    const std::vector<NodeId> partner = program_.partners();
    for (NodeId id = 0; id < program_.nodes.size(); ++id) {
      const ExpressionNode& n = program_.nodes[id];
      if (is_leaf(n.op)) continue;
      const Operands operands(n);
      Instruction made{n.op, program_.stages[id], {operands.begin(), operands.end()}, {id}};
      if (n.op == Op::sin || n.op == Op::cos) {
        const NodeId other = partner[id];
        if (other < id) continue;  // it has been with its partner
        made.op = Op::sin;
        made.gives = n.op == Op::sin ? std::vector{id, other} : std::vector{other, id};
      }
      instructions_.push_back(std::move(made));
    }
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
    std::array<std::vector<std::size_t>, kOps> ready;
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
      runs.push_back({static_cast<Op>(most - ready.begin()), 0, static_cast<Tape::Slot>(tape_.values.size()),
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
