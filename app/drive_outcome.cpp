#include "app/drive_outcome.h"

#include "app/console.h"
#include "app/simulated_drive.h"

namespace rovigo::app {

namespace {

/// A drive that the drive side held for good, or that ended for want of a usable pose.
Outcome held_outcome(control::StopCause cause) {
  switch (cause) {
    case control::StopCause::kNone:
    case control::StopCause::kLostPoses:
      return {"pose_lost", 104,
              "stopped: no usable pose for too long; is the map still true to the place?"};
    case control::StopCause::kNoPoses:
      return {"pose_lost", 104, "stopped: no poses arrive any more; is the localiser running?"};
    case control::StopCause::kOldPoses:
      return {"pose_lost", 104,
              "stopped: poses are too old when they arrive (control.max_pose_age_s)"};
    case control::StopCause::kBadPoses:
      return {"pose_lost", 104, "stopped: the poses that arrive are no finite numbers"};
    case control::StopCause::kNoSetPoints:
      return {"no_set_points", 107, "stopped: no set-points come from the controller any more"};
    case control::StopCause::kLowBattery:
      return {"battery_low", 106, "stopped: the battery is below robot.battery_low_v; charge it"};
    case control::StopCause::kManual:
      return {"manual_takeover", 106, "stopped: taken over by hand and not given back"};
  }
  return {"stopped", 106, "stopped by the drive side"};
}

std::string times_of(int count) { return count == 1 ? "once" : std::to_string(count) + " times"; }

std::string found_again(int times) {
  if (times == 0) return "";
  return "; its pose was lost " + times_of(times) + " on the way and found by looking around";
}

}  // namespace

Outcome outcome_of(const control::DriveLog& log, const control::DriveMetrics& m) {
  if (log.contact_events > 0) {
    return {"collision", 106,
            "touched an obstacle " + times_of(log.contact_events) + " on the way, first \"" +
                log.touched + "\""};
  }
  switch (log.status) {
    case control::TrackStatus::kReached:
      return {"ok", 0,
              "reached the goal, " + with_unit(m.final_position_error_m, 3, "m") + " off, after " +
                  with_unit(m.driven_length_m, 2, "m") + " and " + with_unit(m.duration_s, 1, "s") +
                  found_again(log.looked_around)};
    case control::TrackStatus::kPoseLost:
    case control::TrackStatus::kStopped:
      return held_outcome(log.held);
    case control::TrackStatus::kNoProgress:
      return {"no_progress", 105, "stopped: the rover was commanded to move and did not"};
    case control::TrackStatus::kTimedOut:
      return {"timed_out", 107, "stopped: the drive took far longer than planned"};
    case control::TrackStatus::kRunning:
      break;
  }
  return {"not_finished", 107, "the drive did not finish"};
}

nlohmann::ordered_json drive_json(const Outcome& outcome, const control::DriveLog& log,
                                  const control::DriveMetrics& m) {
  return {{"status", outcome.status},
          {"code", outcome.code},
          {"message", outcome.message},
          {"path_length_m", m.path_length_m},
          {"driven_length_m", m.driven_length_m},
          {"duration_s", m.duration_s},
          {"cross_track_rms_m", m.cross_track_rms_m},
          {"cross_track_max_m", m.cross_track_max_m},
          {"final_position_error_m", m.final_position_error_m},
          {"final_heading_error_rad", m.final_heading_error_rad},
          {"estimate_rms_m", m.estimate_rms_m},
          {"collisions", log.contact_events},
          {"looked_around", log.looked_around},
          {"log_hash", log_hash(log)}};
}

}  // namespace rovigo::app
