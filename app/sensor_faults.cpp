#include "app/sensor_faults.h"

#include <mrpt/obs/CObservation3DRangeScan.h>

namespace rovigo::app {

std::vector<mrpt::obs::CObservation::Ptr> SensorFaults::pass(
    const sim::Simulator& simulator, double now_s,
    const std::vector<mrpt::obs::CObservation::Ptr>& fresh) {
  std::vector<mrpt::obs::CObservation::Ptr> arrives;
  std::erase_if(late_, [&](const UnderWay& u) {
    if (u.arrives_s > now_s) return false;
    arrives.push_back(u.observation);
    return true;
  });
  for (const auto& observation : fresh) {
    const bool is_frame = IS_CLASS(*observation, mrpt::obs::CObservation3DRangeScan);
    if (simulator.fault(sim::FaultKind::kSensorsStall)) continue;
    const sim::Fault* late = simulator.fault(sim::FaultKind::kSensorsLate);
    if (!late && is_frame) late = simulator.fault(sim::FaultKind::kCameraLate);
    if (late) {
      late_.push_back({now_s + late->delay_s, observation});
    } else {
      arrives.push_back(observation);
    }
  }
  return arrives;
}

}  // namespace rovigo::app
