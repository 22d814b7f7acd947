#include "control/drive_controller.h"

namespace rovigo::control {

const char* to_string(TrackStatus status) {
  switch (status) {
    case TrackStatus::kRunning:
      return "running";
    case TrackStatus::kReached:
      return "reached";
    case TrackStatus::kPoseLost:
      return "pose_lost";
    case TrackStatus::kNoProgress:
      return "no_progress";
    case TrackStatus::kTimedOut:
      return "timed_out";
    case TrackStatus::kStopped:
      return "stopped";
  }
  return "unknown";
}

}  // namespace rovigo::control
