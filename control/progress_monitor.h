#pragma once
// Notices a drive that gets nowhere.

namespace rovigo::control {

/// What counts as getting on: reference time, way along the path, heading error.
struct Progress {
  double reference_time_s = 0.0;
  double arc_m = 0.0;
  double heading_error_rad = 0.0;  ///< absolute
};

class ProgressMonitor {
 public:
  explicit ProgressMonitor(double patience_s) : patience_s_(patience_s) {}

  /// True once there was no progress for longer than the patience.
  bool stagnated(double now_s, const Progress& progress);
  /// Starts the count anew (after a halt that is nobody's fault).
  void restart() { started_ = false; }

 private:
  double patience_s_;
  bool started_ = false;
  double marked_s_ = 0.0;
  Progress mark_;
};

}  // namespace rovigo::control
