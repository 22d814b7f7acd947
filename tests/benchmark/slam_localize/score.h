#pragma once
// What a localizer said, judged by the truth.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "mapped_world.h"
#include "slam/localizer_evidence.h"
#include "slam/pose_estimate.h"

namespace rovigo::slam_localize {

inline constexpr double kWrongBeyondM = 0.20;
inline constexpr double kWrongBeyondRad = 10.0 * 3.14159265358979323846 / 180.0;

/// One answer of the localizer: after every observation, camera frame or not.
struct Answer {
  double time_s = 0.0;  ///< since the recording's first observation
  bool is_frame = false;
  slam::Health health = slam::Health::kLost;
  double confidence = 0.0;
  double sigma_position_m = 0.0;
  double error_m = 0.0;
  double error_rad = 0.0;
  std::optional<slam::LocalizerEvidence> evidence;
  bool right() const { return error_m <= kWrongBeyondM && error_rad <= kWrongBeyondRad; }
  bool ok() const { return health == slam::Health::kOk; }
  bool confidently_wrong() const { return ok() && !right(); }
};

struct Run {
  std::vector<Answer> answers;
  double cpu_ms_per_frame = 0.0;  ///< reading and decoding included

  /// First OK pose that is right at or after `from_s`.
  std::optional<double> first_right_s(double from_s = 0.0) const;
  /// First answer with this health at or after `from_s`.
  std::optional<double> first_s(slam::Health health, double from_s) const;
  int confidently_wrong_frames() const;
  int confidently_wrong_poses() const;
  /// Those before `from_s` and those from the first frame after it on: between the two no sensor of
  /// a rover that was put down elsewhere at once can tell.
  int confidently_wrong_poses_but_until_the_frame_after(double from_s) const;
};

/// Feeds a recording to a fresh localizer that knows nothing of where it starts.
Run localize(const MappedWorld& world, const app::RovigoConfig& config,
             const std::filesystem::path& recording);

/// Said confidence against the share of right poses among camera frames.
struct CalibrationBin {
  double from = 0.0, to = 1.0;
  int frames = 0;
  double mean_confidence = 0.0;
  double share_right = 0.0;
};
std::vector<CalibrationBin> calibration_curve(const std::vector<Run>& runs);

/// Mean distance between said and true share, weighted by frames (expected calibration error).
double calibration_error(const std::vector<CalibrationBin>& bins);

}  // namespace rovigo::slam_localize
