#include "sim/fault_script.h"

#include <cassert>
#include <string_view>

#include "sim/random.h"

namespace rovigo::sim {
namespace {

FaultKind kind_of(std::string_view name) {
  if (name == "poses_stall") return FaultKind::kPosesStall;
  if (name == "poses_late") return FaultKind::kPosesLate;
  if (name == "poses_not_finite") return FaultKind::kPosesNotFinite;
  if (name == "sensors_stall") return FaultKind::kSensorsStall;
  if (name == "sensors_late") return FaultKind::kSensorsLate;
  if (name == "camera_late") return FaultKind::kCameraLate;
  if (name == "set_points_stop") return FaultKind::kSetPointsStop;
  if (name == "battery_low") return FaultKind::kBatteryLow;
  assert(name == "manual_takeover");
  return FaultKind::kManualTakeover;
}

}  // namespace

FaultScript::FaultScript(const std::vector<Fault>& faults, std::uint64_t seed) {
  RandomStream random(seed);
  for (const Fault& f : faults) {
    const double begin = f.start_s + random.uniform(0.0, 1.0) * f.within_s;
    const double end =
        f.duration_s < Fault::kForGood ? begin + f.duration_s : 2.0 * Fault::kForGood;
    entries_.push_back({kind_of(f.kind), begin, end, f});
  }
}

const Fault* FaultScript::active(FaultKind kind, double time_s) const {
  for (const Entry& e : entries_) {
    if (e.kind == kind && time_s >= e.begin_s && time_s < e.end_s) return &e.fault;
  }
  return nullptr;
}

}  // namespace rovigo::sim
