#include "score.h"

#include <mrpt/obs/CObservation3DRangeScan.h>

#include <algorithm>
#include <cmath>
#include <ctime>

#include "recordings.h"
#include "slam/localizer.h"
#include "slam/recording/recording.h"
#include "slam/trajectory_file.h"

namespace rovigo::slam_localize {

namespace {

double cpu_seconds() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

/// The true pose at a time that the recorder stamped.
const mrpt::poses::CPose3D& at(const std::vector<slam::StampedPose>& truth, double time_s) {
  const auto after =
      std::lower_bound(truth.begin(), truth.end(), time_s - 1e-4,
                       [](const slam::StampedPose& p, double t) { return p.time_s < t; });
  return after == truth.end() ? truth.back().pose : after->pose;
}

void judge(Answer& answer, const mrpt::poses::CPose3D& estimate, const TPose2D& truth) {
  const TPose2D pose(estimate.asTPose());
  answer.error_m = maps::distance(maps::position_of(pose), maps::position_of(truth));
  answer.error_rad = std::abs(maps::wrap_angle(pose.phi - truth.phi));
}

}  // namespace

std::optional<double> Run::first_right_s(double from_s) const {
  for (const Answer& a : answers) {
    if (a.time_s >= from_s && a.ok() && a.right()) return a.time_s;
  }
  return std::nullopt;
}

std::optional<double> Run::first_s(slam::Health health, double from_s) const {
  for (const Answer& a : answers) {
    if (a.time_s >= from_s && a.health == health) return a.time_s;
  }
  return std::nullopt;
}

int Run::confidently_wrong_frames() const {
  return static_cast<int>(std::count_if(answers.begin(), answers.end(), [](const Answer& a) {
    return a.is_frame && a.confidently_wrong();
  }));
}

int Run::confidently_wrong_poses() const {
  return static_cast<int>(std::count_if(answers.begin(), answers.end(),
                                        [](const Answer& a) { return a.confidently_wrong(); }));
}

int Run::confidently_wrong_poses_but_until_the_frame_after(double from_s) const {
  // In the order of arrival: readings of the frame's own time may come before it.
  const auto frame = std::find_if(answers.begin(), answers.end(), [&](const Answer& a) {
    return a.is_frame && a.time_s >= from_s;
  });
  int wrong = 0;
  for (auto a = answers.begin(); a != answers.end(); ++a) {
    wrong += a->confidently_wrong() && (a->time_s < from_s || a >= frame);
  }
  return wrong;
}

Run localize(const MappedWorld& world, const app::RovigoConfig& config,
             const std::filesystem::path& recording) {
  const auto truth = slam::read_tum_trajectory(truth_of(recording));
  const TPose2D map_from_world = maps::inverse(world.world_from_map());
  const auto reader = slam::open_recording(recording);
  slam::Localizer localizer(config.slam, reader->info().rig, world.map, std::nullopt);
  Run run;
  int frames = 0;
  std::optional<double> begin_s;
  const double cpu_before = cpu_seconds();
  while (const auto observation = reader->next()) {
    const double time_s = mrpt::Clock::toDouble(observation->timestamp);
    if (!begin_s) begin_s = time_s;
    const slam::PoseEstimate estimate = localizer.process(*observation);
    Answer a;
    a.time_s = time_s - *begin_s;
    a.is_frame = IS_CLASS(*observation, mrpt::obs::CObservation3DRangeScan);
    a.health = estimate.health;
    a.confidence = estimate.confidence;
    a.sigma_position_m = estimate.sigma_position_m;
    a.evidence = localizer.evidence();
    judge(a, estimate.map_from_base,
          maps::compose(map_from_world, TPose2D(at(truth, time_s).asTPose())));
    run.answers.push_back(a);
    frames += a.is_frame;
  }
  run.cpu_ms_per_frame = 1e3 * (cpu_seconds() - cpu_before) / std::max(1, frames);
  return run;
}

std::vector<CalibrationBin> calibration_curve(const std::vector<Run>& runs) {
  constexpr double kEdges[] = {0.0, 0.05, 0.2, 0.4, 0.6, 0.8, 0.9, 0.95, 0.98, 0.99, 0.995, 1.0};
  std::vector<CalibrationBin> bins;
  for (std::size_t i = 0; i + 1 < std::size(kEdges); ++i) {
    bins.push_back({kEdges[i], kEdges[i + 1], 0, 0.0, 0.0});
  }
  for (const Run& run : runs) {
    for (const Answer& a : run.answers) {
      if (!a.is_frame) continue;
      const auto bin = std::find_if(bins.begin(), bins.end(),
                                    [&](const auto& b) { return a.confidence < b.to; });
      CalibrationBin& b = bin == bins.end() ? bins.back() : *bin;
      ++b.frames;
      b.mean_confidence += a.confidence;
      b.share_right += a.right();
    }
  }
  for (CalibrationBin& b : bins) {
    if (b.frames == 0) continue;
    b.mean_confidence /= b.frames;
    b.share_right /= b.frames;
  }
  return bins;
}

double calibration_error(const std::vector<CalibrationBin>& bins) {
  double sum = 0.0;
  int frames = 0;
  for (const CalibrationBin& b : bins) {
    sum += b.frames * std::abs(b.mean_confidence - b.share_right);
    frames += b.frames;
  }
  return frames > 0 ? sum / frames : 0.0;
}

}  // namespace rovigo::slam_localize
