#include "slam/landmark_map.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <map>

namespace rovigo::slam {

namespace {

constexpr double kPointFloorM = 0.002;  // no landmark is known better than this

/// Room for a little more, not twice as much: landmarks are the largest list there is.
template <class T>
void grow_gently(std::vector<T>& list) {
  if (list.size() == list.capacity()) list.reserve(list.size() + list.size() / 8 + 1024);
}

std::vector<std::pair<int, int>> ranked(const std::map<int, int>& votes, int min_votes) {
  std::vector<std::pair<int, int>> out;
  for (const auto& [id, n] : votes) {
    if (n >= min_votes) out.emplace_back(id, n);
  }
  std::stable_sort(out.begin(), out.end(),
                   [](const auto& a, const auto& b) { return a.second > b.second; });
  return out;
}

}  // namespace

MeasurementNoise noise_of(const Feature& feature, const SlamConfig& config) {
  const double z = feature.depth_m;
  return {config.tracking.pixel_sigma * octave_scale(feature.octave, config.features),
          std::max(0.002, config.depth.sigma_at_1m_m * z * z)};
}

LandmarkMap::LandmarkMap(const SlamConfig& config, const CameraModel& camera,
                         const Se3& base_from_camera)
    : config_(config), camera_(camera), base_from_camera_(base_from_camera) {}

Eigen::Vector3d LandmarkMap::measured_point(const Keyframe& k, int feature,
                                            Eigen::Matrix3d& covariance) const {
  const Feature& f = k.features[static_cast<std::size_t>(feature)];
  const MeasurementNoise noise = noise_of(f, config_);
  const Eigen::Vector3d ray = camera_.unproject(f.pixel.cast<double>(), 1.0);
  const double z = f.depth_m;
  const double side = std::pow(noise.pixel_sigma * z / camera_.fx(), 2) + std::pow(kPointFloorM, 2);
  const Eigen::Matrix3d in_camera =
      side * Eigen::Matrix3d::Identity() + std::pow(noise.depth_sigma_m, 2) * ray * ray.transpose();
  const Se3 map_from_camera = k.map_from_base * base_from_camera_;
  covariance = map_from_camera.rotation * in_camera * map_from_camera.rotation.transpose();
  return map_from_camera * (ray * z);
}

void LandmarkMap::sight(int landmark_id, int keyframe_id, int feature) {
  Landmark& l = landmark(landmark_id);
  const Keyframe& k = keyframe(keyframe_id);
  const Feature& f = k.features[static_cast<std::size_t>(feature)];
  if (f.depth_m > 0) {
    Eigen::Matrix3d covariance;
    const Eigen::Vector3d point = measured_point(k, feature, covariance);
    if (l.sightings.empty()) {
      l.position_map = point;
      l.covariance = covariance.cast<float>();
    } else {
      const Eigen::Matrix3d before = l.covariance.cast<double>();
      const Eigen::Matrix3d gain = before * (before + covariance).inverse();
      l.position_map += gain * (point - l.position_map);
      Eigen::Matrix3d after = before - gain * before;
      after = 0.5 * (after + after.transpose()).eval();
      after.diagonal().array() += 0.25 * kPointFloorM * kPointFloorM;
      l.covariance = after.cast<float>();
    }
  }
  const Eigen::Vector3d to_camera =
      (k.map_from_base * base_from_camera_).translation - l.position_map;
  const double distance = to_camera.norm();
  l.distance_m = static_cast<float>(distance);
  l.direction_map = (to_camera / std::max(1e-6, distance)).cast<float>();
  l.octave = f.octave;
  l.descriptor = k.features.descriptor(static_cast<std::size_t>(feature));
  l.sightings.push_back({keyframe_id, feature});
}

int LandmarkMap::new_landmark() {
  if (free_landmarks_.empty()) {
    grow_gently(landmarks_);
    landmarks_.emplace_back();
    return static_cast<int>(landmarks_.size()) - 1;
  }
  const int id = free_landmarks_.back();
  free_landmarks_.pop_back();
  landmark(id) = Landmark{};
  return id;
}

void LandmarkMap::release(int id) {
  Landmark& l = landmark(id);
  if (!l.alive) return;
  l.alive = false;
  l.sightings = {};
  free_landmarks_.push_back(id);
}

int LandmarkMap::add_keyframe(Keyframe added) {
  const int id = static_cast<int>(keyframes_.size());
  added.id = id;
  added.landmark_of.resize(added.features.size(), -1);
  keyframes_.push_back(std::move(added));
  Keyframe& k = keyframes_.back();
  for (std::size_t i = 0; i < k.features.size(); ++i) {
    const int feature = static_cast<int>(i);
    if (k.landmark_of[i] < 0) {
      if (k.features[i].depth_m <= 0) continue;
      k.landmark_of[i] = new_landmark();
    }
    sight(k.landmark_of[i], id, feature);
  }
  return id;
}

void LandmarkMap::add_sighting(int landmark_id, int keyframe_id, int feature) {
  Landmark& l = landmark(landmark_id);
  const bool known = std::any_of(l.sightings.begin(), l.sightings.end(),
                                 [&](const auto& s) { return s.keyframe == keyframe_id; });
  if (!l.alive || known) return;
  l.sightings.push_back({keyframe_id, feature});
  keyframe(keyframe_id).landmark_of[static_cast<std::size_t>(feature)] = landmark_id;
}

void LandmarkMap::remove_sighting(int landmark_id, int index) {
  Landmark& l = landmark(landmark_id);
  const Sighting s = l.sightings[static_cast<std::size_t>(index)];
  keyframe(s.keyframe).landmark_of[static_cast<std::size_t>(s.feature)] = -1;
  l.sightings.erase(l.sightings.begin() + index);
  if (l.sightings.empty()) release(landmark_id);
}

void LandmarkMap::merge_landmarks(int from, int into) {
  if (from == into) return;
  Landmark& a = landmark(from);
  Landmark& b = landmark(into);
  if (!a.alive || !b.alive) return;
  for (const Sighting& s : a.sightings) {
    const bool seen_twice = std::any_of(b.sightings.begin(), b.sightings.end(),
                                        [&](const auto& t) { return t.keyframe == s.keyframe; });
    keyframe(s.keyframe).landmark_of[static_cast<std::size_t>(s.feature)] = seen_twice ? -1 : into;
    if (!seen_twice) b.sightings.push_back(s);
  }
  release(from);
}

void LandmarkMap::forget_unmatched(int id) {
  Keyframe& k = keyframe(id);
  std::vector<Feature> features;
  std::vector<Descriptor> descriptors;
  std::vector<int> landmark_of;
  for (std::size_t i = 0; i < k.features.size(); ++i) {
    const int l = k.landmark_of[i];
    if (l < 0) continue;
    for (Sighting& s : landmark(l).sightings) {
      if (s.keyframe == id) s.feature = static_cast<int>(features.size());
    }
    features.push_back(k.features[i]);
    descriptors.push_back(k.features.descriptor(i));
    landmark_of.push_back(l);
  }
  features.shrink_to_fit();
  descriptors.shrink_to_fit();
  landmark_of.shrink_to_fit();
  k.features =
      FeatureSet(std::move(features), std::move(descriptors), camera_.width(), camera_.height());
  k.landmark_of = std::move(landmark_of);
}

void LandmarkMap::cull_keyframe(int id, int host) {
  Keyframe& k = keyframe(id);
  for (const int l : k.landmark_of) {
    if (l < 0) continue;
    const auto& seen = landmark(l).sightings;
    const auto at = std::find_if(seen.begin(), seen.end(),
                                 [id](const Sighting& s) { return s.keyframe == id; });
    if (at != seen.end()) remove_sighting(l, static_cast<int>(at - seen.begin()));
  }
  k.features = {};
  k.landmark_of = {};
  k.color_jpeg = {};
  k.depth_png = {};
  k.walls = {};
  k.host = host;
  for (Keyframe& rider : keyframes_) {
    if (rider.host != host && rider.host != id) continue;
    rider.host = host;
    rider.host_from_base = keyframe(host).map_from_base.inverse() * rider.map_from_base;
  }
}

int LandmarkMap::living_keyframes() const {
  return static_cast<int>(std::count_if(keyframes_.begin(), keyframes_.end(),
                                        [](const Keyframe& k) { return !k.culled(); }));
}

std::vector<std::pair<int, int>> LandmarkMap::covisible(int id, int min_shared) const {
  std::map<int, int> votes;
  for (const int l : keyframe(id).landmark_of) {
    if (l < 0 || !landmark(l).alive) continue;
    for (const Sighting& s : landmark(l).sightings) {
      if (s.keyframe != id) ++votes[s.keyframe];
    }
  }
  return ranked(votes, min_shared);
}

std::vector<std::pair<int, int>> LandmarkMap::observers(const std::vector<int>& landmarks) const {
  std::map<int, int> votes;
  for (const int l : landmarks) {
    for (const Sighting& s : landmark(l).sightings) ++votes[s.keyframe];
  }
  return ranked(votes, 1);
}

std::vector<int> LandmarkMap::landmarks_of(const std::vector<int>& keyframes) const {
  std::vector<int> out;
  for (const int k : keyframes) {
    for (const int l : keyframe(k).landmark_of) {
      if (l >= 0 && landmark(l).alive) out.push_back(l);
    }
  }
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

void LandmarkMap::move_keyframes(const std::vector<Se3>& map_from_base) {
  for (Landmark& l : landmarks_) {
    if (l.sightings.empty()) continue;
    const auto k = static_cast<std::size_t>(l.sightings.front().keyframe);
    const Se3 moved = map_from_base[k] * keyframes_[k].map_from_base.inverse();
    l.position_map = moved * l.position_map;
    const Eigen::Matrix3f turned = moved.rotation.cast<float>();
    l.direction_map = turned * l.direction_map;
    l.covariance = turned * l.covariance * turned.transpose();
  }
  for (std::size_t i = 0; i < keyframes_.size(); ++i) {
    const Keyframe& k = keyframes_[i];
    keyframes_[i].map_from_base =
        k.culled() ? map_from_base[static_cast<std::size_t>(k.host)] * k.host_from_base
                   : map_from_base[i];
  }
}

void LandmarkMap::cull(const std::vector<int>& candidates) {
  constexpr int kFairTrial = 8;
  for (const int id : candidates) {
    Landmark& l = landmark(id);
    if (!l.alive || l.sightings.size() > 2) continue;
    if (l.predicted < kFairTrial || l.tracked * 4 >= l.predicted) continue;
    for (const Sighting& s : l.sightings) {
      keyframe(s.keyframe).landmark_of[static_cast<std::size_t>(s.feature)] = -1;
    }
    release(id);
  }
}

}  // namespace rovigo::slam
