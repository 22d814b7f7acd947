#include "slam/tracker.h"

#include <algorithm>
#include <cmath>

namespace rovigo::slam {

namespace {

constexpr double kMaxViewAngleCos = 0.5;  // a patch looks different from more than 60 deg aside
constexpr double kRatio = 0.85;           // best against second best on the same scale

struct Candidate {
  int landmark = -1;
  int distance = 257;
};

}  // namespace

std::vector<VisibleLandmark> visible_landmarks(const LandmarkMap& map,
                                               const std::vector<int>& landmarks,
                                               const Se3& map_from_base) {
  const Se3 map_from_camera = map_from_base * map.base_from_camera();
  const Se3 camera_from_map = map_from_camera.inverse();
  const FeatureConfig& features = map.config().features;
  const double log_scale = std::log(features.pyramid_scale);
  std::vector<VisibleLandmark> out;
  for (const int id : landmarks) {
    const Landmark& l = map.landmark(id);
    const Eigen::Vector3d p = camera_from_map * l.position_map;
    if (p.z() < 0.1) continue;
    const Eigen::Vector2d pixel = map.camera().project(p);
    if (!map.camera().in_image(pixel, 4.0)) continue;
    const Eigen::Vector3d to_camera = map_from_camera.translation - l.position_map;
    const double distance = to_camera.norm();
    if (to_camera.dot(l.direction_map.cast<double>()) < kMaxViewAngleCos * distance) continue;
    const double octave = l.octave + std::log(l.distance_m / distance) / log_scale;
    if (octave < -1.5 || octave > features.pyramid_levels + 0.5) continue;
    out.push_back({id, pixel, static_cast<int>(std::lround(octave))});
  }
  return out;
}

std::vector<FeatureMatch> match_by_projection(const LandmarkMap& map,
                                              const std::vector<VisibleLandmark>& visible,
                                              const FeatureSet& features, double radius_px) {
  std::vector<Candidate> owner(features.size());
  std::vector<int> near;
  const TrackingConfig& tracking = map.config().tracking;
  for (const VisibleLandmark& v : visible) {
    near.clear();
    const double scale = octave_scale(std::clamp(v.octave, 0, 8), map.config().features);
    features.near(v.pixel, radius_px * scale, near);
    const Descriptor& descriptor = map.landmark(v.landmark).descriptor;
    int best = 257, second = 257, best_index = -1, best_octave = -1, second_octave = -2;
    for (const int i : near) {
      const auto index = static_cast<std::size_t>(i);
      const int octave = features[index].octave;
      if (std::abs(octave - v.octave) > 1) continue;
      const int d = hamming_distance(descriptor, features.descriptor(index));
      if (d < best) {
        second = best;
        second_octave = best_octave;
        best = d;
        best_octave = octave;
        best_index = i;
      } else if (d < second) {
        second = d;
        second_octave = octave;
      }
    }
    if (best_index < 0 || best > tracking.max_descriptor_distance) continue;
    // The same corner on the next scale is no rival; another corner is.
    if (best_octave == second_octave && best > kRatio * second) continue;
    Candidate& c = owner[static_cast<std::size_t>(best_index)];
    if (best < c.distance) c = {v.landmark, best};
  }
  std::vector<FeatureMatch> matches;
  for (std::size_t i = 0; i < owner.size(); ++i) {
    if (owner[i].landmark >= 0) matches.push_back({owner[i].landmark, static_cast<int>(i)});
  }
  return matches;
}

std::vector<PointObservation> observations_of(const LandmarkMap& map,
                                              const std::vector<FeatureMatch>& matches,
                                              const FeatureSet& features, const Se3& map_from_base,
                                              double smear_px) {
  const Se3 camera_from_map = (map_from_base * map.base_from_camera()).inverse();
  std::vector<PointObservation> out;
  out.reserve(matches.size());
  for (const FeatureMatch& m : matches) {
    const Landmark& l = map.landmark(m.landmark);
    const Feature& f = features[static_cast<std::size_t>(m.feature)];
    const MeasurementNoise noise = noise_of(f, map.config());
    const Eigen::Vector3d p = camera_from_map * l.position_map;
    const Eigen::Matrix3d spread = camera_from_map.rotation * l.covariance.cast<double>() *
                                   camera_from_map.rotation.transpose();
    const double per_m = map.camera().fx() / std::max(0.1, p.z());
    // Only what moves the point across the ray moves its pixel.
    const Eigen::Vector3d ray = p.normalized();
    const double across = std::max(0.0, 0.5 * (spread.trace() - ray.dot(spread * ray)));
    PointObservation o;
    o.point_map = l.position_map;
    o.pixel = f.pixel.cast<double>();
    o.pixel_sigma = std::sqrt(noise.pixel_sigma * noise.pixel_sigma + across * per_m * per_m +
                              smear_px * smear_px);
    o.depth_m = f.depth_m;
    o.depth_sigma_m = std::sqrt(noise.depth_sigma_m * noise.depth_sigma_m + spread(2, 2));
    out.push_back(o);
  }
  return out;
}

TrackResult track_frame(const LandmarkMap& map, const std::vector<int>& local_landmarks,
                        const FeatureSet& features, const MotionPrediction& prediction) {
  const TrackingConfig& config = map.config().tracking;
  TrackResult result;
  Se3 pose = prediction.prior.map_from_base;
  const double smear_px = config.smear_s * prediction.turn_rate_rad_s.norm() * map.camera().fx();
  // Wide nets only when the narrow one comes up empty: wide nets catch wrong fish.
  const auto coarse = [&](double radius_px) {
    const auto visible = visible_landmarks(map, local_landmarks, pose);
    result.matches = match_by_projection(map, visible, features, radius_px);
    return static_cast<int>(result.matches.size()) >= 2 * config.min_inliers;
  };
  if (!coarse(config.search_radius_px) && !coarse(3.0 * config.search_radius_px) &&
      static_cast<int>(result.matches.size()) < config.min_inliers) {
    result.matches.clear();
    return result;
  }
  const auto solve = [&] {
    const auto observations = observations_of(map, result.matches, features, pose, smear_px);
    result.solution =
        optimize_pose(observations, pose, prediction.prior, map.camera(), map.base_from_camera());
    pose = result.solution.map_from_base;
  };
  solve();
  if (result.solution.inliers >= config.min_inliers) {
    const auto visible = visible_landmarks(map, local_landmarks, pose);
    result.matches = match_by_projection(map, visible, features, 0.5 * config.search_radius_px);
    result.visible.clear();
    for (const VisibleLandmark& v : visible) result.visible.push_back(v.landmark);
    solve();
  }
  std::vector<FeatureMatch> inliers;
  for (std::size_t i = 0; i < result.matches.size(); ++i) {
    if (i < result.solution.is_inlier.size() && result.solution.is_inlier[i]) {
      inliers.push_back(result.matches[i]);
    }
  }
  const std::size_t tried = result.matches.size();
  result.matches = std::move(inliers);
  if (result.solution.inliers < config.min_inliers) return result;
  const bool plausible = 4 * result.matches.size() >= tried && is_finite(pose);
  result.status = plausible ? TrackStatus::kTracked : TrackStatus::kImplausible;
  return result;
}

}  // namespace rovigo::slam
