#include "app/track/recorded_path.h"

#include <cmath>
#include <vector>

#include "app/ground.h"
#include "maps/error.h"
#include "planning/timing.h"
#include "slam/trajectory_file.h"

namespace rovigo::app {

namespace {

constexpr double kSpacingM = 0.1;   // long against a pose's noise
constexpr double kCornerRad = 0.8;  // sharper: the rover had turned in place
constexpr double kShortestM = 0.2;

/// Points at least kSpacingM apart.
std::vector<TPoint2D> thinned(const std::vector<TPose2D>& poses) {
  std::vector<TPoint2D> points;
  for (const TPose2D& pose : poses) {
    const TPoint2D p = maps::position_of(pose);
    if (points.empty() || maps::distance(points.back(), p) >= kSpacingM) points.push_back(p);
  }
  return points;
}

double turn_at(const std::vector<TPoint2D>& points, std::size_t i) {
  const auto heading = [&](std::size_t k) {
    return std::atan2(points[k + 1].y - points[k].y, points[k + 1].x - points[k].x);
  };
  return std::abs(maps::wrap_angle(heading(i) - heading(i - 1)));
}

planning::Trajectory timed(const std::vector<TPoint2D>& points, const RovigoConfig& config) {
  planning::TimingProblem problem;
  std::vector<TPoint2D> piece{points.front()};
  for (std::size_t i = 1; i < points.size(); ++i) {
    piece.push_back(points[i]);
    const bool last = i + 1 == points.size();
    if (!last && turn_at(points, i) < kCornerRad) continue;
    problem.pieces.push_back({.curve = planning::CubicBSpline::uniform(piece)});
    piece = {points[i]};
  }
  const auto& timing = config.planning.timing;
  return planning::time_path(problem, planning::limits_of(config.robot, timing), timing);
}

std::vector<TPose2D> poses_of(const TrackShape& shape, const std::filesystem::path& folder,
                              const maps::SavedMap* map) {
  std::vector<TPose2D> poses;
  if (map) {
    for (const auto& stored : map->trajectory) {
      poses.emplace_back(stored.map_from_base.asTPose());
    }
    return poses;
  }
  for (const auto& stamped : slam::read_tum_trajectory(folder / shape.file)) {
    poses.emplace_back(stamped.pose.asTPose());
  }
  if (poses.empty()) return poses;
  const TPose2D first_from_frame = maps::inverse(poses.front());
  for (TPose2D& pose : poses) pose = maps::compose(first_from_frame, pose);
  return poses;
}

}  // namespace

PlannedTrack plan_recorded(const std::string& name, const TrackShape& shape,
                           const std::filesystem::path& folder,
                           std::shared_ptr<const maps::SavedMap> map, const RovigoConfig& config) {
  if (!map && shape.file.empty()) {
    throw maps::InputError("trajectory \"" + name +
                           "\": a recorded drive needs `map: FILE` or `file: FILE`");
  }
  const std::vector<TPoint2D> points = thinned(poses_of(shape, folder, map.get()));
  if (static_cast<double>(points.size()) * kSpacingM <= kShortestM) {
    throw maps::InputError("trajectory \"" + name + "\": the recorded drive is shorter than 0.2 m");
  }
  planning::Trajectory trajectory = timed(points, config);
  const TPose2D start = trajectory.points.front().pose;
  if (!map) return {empty_hall(), std::move(trajectory), start};
  const Ground ground = ground_of(*map, std::nullopt);
  return {ground.world, std::move(trajectory), start, ground.world_from_map, std::move(map)};
}

}  // namespace rovigo::app
