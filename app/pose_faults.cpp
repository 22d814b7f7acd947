#include "app/pose_faults.h"

#include <limits>

namespace rovigo::app {

control::PoseInput PoseFaults::pass(const sim::Simulator& simulator, double now_s,
                                    const control::PoseInput& newest) {
  while (!late_.empty() && late_.front().arrives_s <= now_s) {
    deliver(late_.front().pose);
    late_.pop_front();
  }
  if (newest.time_s <= sent_s_) return delivered_;  // nothing new
  sent_s_ = newest.time_s;
  if (simulator.fault(sim::FaultKind::kPosesStall)) return delivered_;
  if (const sim::Fault* late = simulator.fault(sim::FaultKind::kPosesLate)) {
    late_.push_back({now_s + late->delay_s, newest});
    return delivered_;
  }
  deliver(newest);
  if (simulator.fault(sim::FaultKind::kPosesNotFinite)) {
    delivered_.map_from_base.x = std::numeric_limits<double>::quiet_NaN();
  }
  return delivered_;
}

void PoseFaults::deliver(const control::PoseInput& pose) {
  if (pose.time_s > delivered_.time_s) delivered_ = pose;
}

}  // namespace rovigo::app
