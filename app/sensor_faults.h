#pragma once
// A scenario's faults on the way from the sensors to whoever makes poses of what they tell.

#include <mrpt/obs/CObservation.h>

#include <vector>

#include "sim/simulator.h"

namespace rovigo::app {

class SensorFaults {
 public:
  /// What arrives at `now_s` when the sensors tell `fresh` (in time order): all of it, less, or
  /// what they told earlier.
  std::vector<mrpt::obs::CObservation::Ptr> pass(
      const sim::Simulator& simulator, double now_s,
      const std::vector<mrpt::obs::CObservation::Ptr>& fresh);

 private:
  struct UnderWay {
    double arrives_s;
    mrpt::obs::CObservation::Ptr observation;
  };
  std::vector<UnderWay> late_;  ///< in the order in which it was told
};

}  // namespace rovigo::app
