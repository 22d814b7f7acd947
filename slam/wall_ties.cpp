#include "slam/wall_ties.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>

namespace rovigo::slam {

namespace {

constexpr int kMinWallPoints = 30;
constexpr double kMinWallShare = 0.7;      // of the points that must lie on the walls
constexpr double kWallStep = 1.0;          // a step beyond this is no correction
constexpr std::size_t kWallKeyframes = 5;  // whose walls are looked at together

/// How far a match leads away from the prior, in units of 5 cm and 30 mrad.
double step_of(const WallMatch& match, const TPose2D& prior) {
  const TPose2D& at = match.look.map_from_base;
  return std::hypot(at.x - prior.x, at.y - prior.y) / 0.05 +
         std::abs(maps::wrap_angle(at.phi - prior.phi)) / 0.03;
}

/// A person's flank is no wall: it asks for a step that wheels and gyro do not believe.
bool is_plausible(const WallMatch& match, const TPose2D& prior) {
  return match.points >= kMinWallPoints && match.inlier_share >= kMinWallShare &&
         step_of(match, prior) <= kWallStep;
}

/// The keyframe at hand and those before it that may show the same walls.
std::vector<int> last_keyframes(const LandmarkMap& map, int anchor) {
  std::vector<int> out;
  for (int k = anchor; k >= 0 && out.size() < kWallKeyframes; --k) {
    if (!map.keyframe(k).culled()) out.push_back(k);
  }
  return out;
}

std::vector<PlacedWalls> placed_walls(const LandmarkMap& map, const std::vector<int>& keyframes) {
  std::vector<PlacedWalls> out;
  for (const int k : keyframes) {
    out.push_back({&map.keyframe(k).walls, to_planar(map.keyframe(k).map_from_base)});
  }
  return out;
}

}  // namespace

MotionLink wall_link(const WallMatch& match, const Keyframe& from, const Keyframe& to) {
  Eigen::Matrix3d information = match.look.information;
  information.diagonal() += Eigen::Vector3d(1.0, 1.0, 1.0);  // 1 m, 1 rad: nothing
  const Eigen::Vector3d step = -information.ldlt().solve(match.look.gradient);
  const TPose2D& at = match.look.map_from_base;
  const TPose2D map_from_from = to_planar(from.map_from_base);
  Eigen::Matrix3d from_map = Eigen::Matrix3d::Identity();
  from_map.topLeftCorner<2, 2>() = Eigen::Rotation2Dd(-map_from_from.phi).toRotationMatrix();
  MotionLink link;
  link.from = from.id;
  link.to = to.id;
  link.begin_s = from.time_s;
  link.end_s = to.time_s;
  link.from_from_to = maps::compose(maps::inverse(map_from_from),
                                    {at.x + step.x(), at.y + step.y(), at.phi + step.z()});
  link.covariance = from_map * information.inverse() * from_map.transpose();
  return link;
}

std::optional<PlanarInformation> WallTies::look(const CameraFrame& frame, const LandmarkMap& map,
                                                int anchor, const Se3& pose,
                                                const MotionModel& motion) {
  if (frame.depth.empty()) return std::nullopt;
  scan_ = wall_scan(frame, map.camera(), map.base_from_camera(), config_);
  const TPose2D prior = to_planar(pose);
  const WallMatch match = match_walls(placed_walls(map, last_keyframes(map, anchor)), scan_, prior,
                                      motion.dead_reckoning().pose_covariance());
  if (!is_plausible(match, prior)) return std::nullopt;
  return match.look;
}

WallScan WallTies::scan(const CameraFrame& frame, const LandmarkMap& map) const {
  return seen() ? scan_ : wall_scan(frame, map.camera(), map.base_from_camera(), config_);
}

void WallTies::tie(const LandmarkMap& map, int keyframe, int anchor, const MotionModel& motion) {
  const Keyframe& now = map.keyframe(keyframe);
  const TPose2D prior = to_planar(now.map_from_base);
  for (const int k : last_keyframes(map, anchor)) {
    const WallMatch match = match_walls(placed_walls(map, {k}), now.walls, prior,
                                        motion.dead_reckoning().pose_covariance());
    if (!is_plausible(match, prior)) continue;
    links_.push_back(wall_link(match, map.keyframe(k), now));
  }
}

}  // namespace rovigo::slam
