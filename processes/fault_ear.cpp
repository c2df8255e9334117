// SPDX-License-Identifier: MIT
#include "processes/fault_ear.hpp"

namespace mixloop {

FaultEar::FaultEar(Bus& bus, int n, PlantReport& report)
    : bus_(bus), channel_(bus.channel("FAULT")), report_(report), inbox_(n) {
  heard_.reserve(Faults::kWaiting);
  bus_.subscribe<&FaultEar::on_fault>(channel_, this);
}

void FaultEar::on_fault(Bytes bytes) {
  const auto reject = [this](Reject cause) { report_.rejects.count(cause); };
  if (const auto cause = inbox_.read(bytes)) return reject(*cause);
  const fault_t& m = inbox_.message;
  if (m.session != report_.session) return reject(Reject::session);
  if (m.seq <= count_) return reject(Reject::stale);
  if (m.target < fault_t::TARGET_MOTOR || m.target > fault_t::TARGET_FRICTION) return;
  if (m.kind < fault_t::KIND_NONE || m.kind > fault_t::KIND_CHANGED) return;
  count_ = m.seq;
  if (heard_.size() == heard_.capacity()) return;
  heard_.push_back({.target = static_cast<Fault::Target>(m.target),
                    .kind = static_cast<Fault::Kind>(m.kind),
                    .index = m.index,
                    .magnitude = m.magnitude,
                    .at = 1e-6 * static_cast<double>(m.utime),
                    .duration = m.duration});
}

}  // namespace mixloop
