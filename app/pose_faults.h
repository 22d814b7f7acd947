#pragma once
// A scenario's faults of the pose stream, whatever the poses come from.

#include <deque>

#include "control/drive_controller.h"
#include "sim/simulator.h"

namespace rovigo::app {

class PoseFaults {
 public:
  /// The newest pose that arrives at `now_s` when `newest` is what the source has: under a fault an
  /// older one, or one that is no number.
  control::PoseInput pass(const sim::Simulator& simulator, double now_s,
                          const control::PoseInput& newest);

 private:
  struct UnderWay {
    double arrives_s;
    control::PoseInput pose;
  };
  void deliver(const control::PoseInput& pose);

  control::PoseInput delivered_;
  double sent_s_ = -1.0;  ///< stamp of the newest pose that the source gave
  std::deque<UnderWay> late_;
};

}  // namespace rovigo::app
