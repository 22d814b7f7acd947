#include "control/progress_monitor.h"

namespace rovigo::control {

bool ProgressMonitor::stagnated(double now_s, const Progress& p) {
  constexpr double kTimeStepS = 0.1, kLengthStepM = 0.01, kHeadingStepRad = 0.05;
  const bool moved = p.reference_time_s > mark_.reference_time_s + kTimeStepS ||
                     p.arc_m > mark_.arc_m + kLengthStepM ||
                     p.heading_error_rad < mark_.heading_error_rad - kHeadingStepRad;
  if (!started_ || moved) {
    started_ = true;
    marked_s_ = now_s;
    mark_ = p;
  }
  return now_s - marked_s_ > patience_s_;
}

}  // namespace rovigo::control
