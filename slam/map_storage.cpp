#include "slam/map_storage.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>

#include "maps/error.h"
#include "slam/keyframe_codec.h"

namespace rovigo::slam {

namespace {

StoredFeature stored_feature(const LandmarkMap& map, const Keyframe& k, std::size_t i,
                             const Se3& camera_from_map) {
  const Feature& f = k.features[i];
  const Landmark& l = map.landmark(k.landmark_of[i]);
  const Eigen::Vector3f p = (camera_from_map * l.position_map).cast<float>();
  StoredFeature s;
  s.pixel_u = f.pixel.x();
  s.pixel_v = f.pixel.y();
  s.angle_rad = f.angle_rad;
  s.depth_m = f.depth_m;
  s.octave = f.octave;
  s.landmark = k.landmark_of[i];
  s.point_x = p.x();
  s.point_y = p.y();
  s.point_z = p.z();
  s.sigma_m = static_cast<float>(std::sqrt(l.covariance.trace() / 3.0f));
  s.descriptor = k.features.descriptor(i);
  return s;
}

Se3 finite_pose(const maps::StoredKeyframe& stored) {
  const Se3 pose = from_mrpt(stored.map_from_base);
  if (!is_finite(pose)) {
    throw maps::InputError("Keyframe " + std::to_string(stored.id) +
                           " of the map has a pose that is not finite.");
  }
  return pose;
}

}  // namespace

std::vector<maps::StoredKeyframe> hand_over_keyframes(LandmarkMap& map) {
  std::vector<maps::StoredKeyframe> out;
  out.reserve(static_cast<std::size_t>(map.living_keyframes()));
  for (std::size_t id = 0; id < map.keyframes().size(); ++id) {
    Keyframe& k = map.keyframe(static_cast<int>(id));
    if (k.culled()) continue;
    const Se3 camera_from_map = (k.map_from_base * map.base_from_camera()).inverse();
    std::vector<StoredFeature> features;
    for (std::size_t i = 0; i < k.features.size(); ++i) {
      const int l = k.landmark_of[i];
      if (l < 0 || !map.landmark(l).alive) continue;
      features.push_back(stored_feature(map, k, i, camera_from_map));
    }
    maps::StoredKeyframe s;
    s.id = k.id;
    s.time_s = k.time_s;
    s.map_from_base = to_mrpt(k.map_from_base);
    s.color_jpeg = std::move(k.color_jpeg);
    s.depth_png = std::move(k.depth_png);
    s.features = encode_features(features);
    out.push_back(std::move(s));
  }
  return out;
}

std::vector<maps::StoredEdge> store_edges(const std::vector<PoseGraphEdge>& edges) {
  // The chart's rotation vector (roll, pitch, yaw) becomes MRPT's yaw, pitch, roll: to first order
  // the same three angles in the other order.
  constexpr std::array<int, 6> kOrder = {0, 1, 2, 5, 4, 3};
  std::vector<maps::StoredEdge> out;
  for (const PoseGraphEdge& e : edges) {
    maps::StoredEdge s;
    s.from = e.from;
    s.to = e.to;
    s.kind = e.kind;
    s.from_from_to = to_mrpt(e.from_from_to);
    for (int i = 0; i < 6; ++i) {
      for (int j = 0; j < 6; ++j) {
        s.information(i, j) =
            e.information(kOrder[static_cast<std::size_t>(i)], kOrder[static_cast<std::size_t>(j)]);
      }
    }
    out.push_back(s);
  }
  return out;
}

LandmarkMap restore_landmark_map(const maps::SavedMap& saved, const SlamConfig& config) {
  const CameraModel camera(saved.metadata.camera);
  LandmarkMap map(config, camera, from_mrpt(saved.metadata.base_from_camera));
  std::map<std::int32_t, int> id_of;  // the file's landmark numbers may be anything
  std::vector<Keyframe> keyframes;
  std::vector<Landmark> landmarks;
  for (const maps::StoredKeyframe& stored : saved.keyframes) {
    if (stored.features.empty()) continue;
    Keyframe k;
    k.id = static_cast<int>(keyframes.size());
    k.time_s = stored.time_s;
    k.map_from_base = finite_pose(stored);
    const Se3 map_from_camera = k.map_from_base * map.base_from_camera();
    std::vector<Feature> features;
    std::vector<Descriptor> descriptors;
    for (const StoredFeature& s : decode_features(stored.features)) {
      if (s.landmark < 0) continue;
      const int feature = static_cast<int>(features.size());
      Feature f;
      f.pixel = {s.pixel_u, s.pixel_v};
      f.angle_rad = s.angle_rad;
      f.depth_m = s.depth_m;
      f.octave = s.octave;
      features.push_back(f);
      descriptors.push_back(s.descriptor);
      const auto [it, is_new] = id_of.try_emplace(s.landmark, static_cast<int>(landmarks.size()));
      if (is_new) landmarks.emplace_back();
      k.landmark_of.push_back(it->second);
      Landmark& l = landmarks[static_cast<std::size_t>(it->second)];
      l.position_map = map_from_camera * Eigen::Vector3d(s.point_x, s.point_y, s.point_z);
      l.covariance = Eigen::Matrix3f::Identity() * (s.sigma_m * s.sigma_m);
      const Eigen::Vector3d to_camera = map_from_camera.translation - l.position_map;
      const double distance = std::max(1e-3, to_camera.norm());
      l.distance_m = static_cast<float>(distance);
      l.direction_map = (to_camera / distance).cast<float>();
      l.octave = s.octave;
      l.descriptor = s.descriptor;
      l.sightings.push_back({k.id, feature});
    }
    k.features =
        FeatureSet(std::move(features), std::move(descriptors), camera.width(), camera.height());
    keyframes.push_back(std::move(k));
  }
  map.restore(std::move(keyframes), std::move(landmarks));
  return map;
}

}  // namespace rovigo::slam
