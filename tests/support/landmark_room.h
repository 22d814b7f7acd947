#pragma once
// A small synthetic room: keyframes that see the same landmarks, exact or with errors.

#include <map>
#include <random>
#include <vector>

#include "slam/landmark_map.h"

namespace rovigo::slam::test {

inline mrpt::img::TCamera intrinsics() {
  mrpt::img::TCamera c;
  c.ncols = 640;
  c.nrows = 480;
  c.setIntrinsicParamsFromValues(500, 500, 320, 240);
  return c;
}

inline Se3 forward_camera() {
  Se3 s;
  s.rotation << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  s.translation = {0.1, 0.0, 0.25};
  return s;
}

/// Points on a wall 3 m ahead, each with a descriptor of its own.
struct Room {
  explicit Room(int points) {
    std::mt19937_64 random(21);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    for (int i = 0; i < points; ++i) {
      where.emplace_back(3.0 + 0.6 * unit(random), 1.5 * unit(random), 0.25 + 0.8 * unit(random));
      look.push_back({random(), random(), random(), random()});
    }
  }

  /// What a camera at `truth` sees; `truth_of` receives the point behind each feature.
  FeatureSet seen_from(const Se3& truth, double pixel_noise, double depth_noise, std::uint64_t seed,
                       std::vector<int>& truth_of) const {
    const CameraModel camera(intrinsics());
    const Se3 camera_from_map = (truth * forward_camera()).inverse();
    std::mt19937_64 random(seed);
    std::normal_distribution<double> noise;
    std::vector<Feature> features;
    std::vector<Descriptor> descriptors;
    for (std::size_t i = 0; i < where.size(); ++i) {
      const Eigen::Vector3d p = camera_from_map * where[i];
      const double nu = noise(random), nv = noise(random), nz = noise(random);
      if (p.z() < 0.3) continue;
      const Eigen::Vector2d pixel = camera.project(p);
      if (!camera.in_image(pixel, 5)) continue;
      Feature f;
      f.pixel = (pixel + pixel_noise * Eigen::Vector2d(nu, nv)).cast<float>();
      f.depth_m = static_cast<float>(p.z() + depth_noise * nz);
      features.push_back(f);
      descriptors.push_back(look[i]);
      truth_of.push_back(static_cast<int>(i));
    }
    return FeatureSet(features, descriptors, 640, 480);
  }

  std::vector<Eigen::Vector3d> where;
  std::vector<Descriptor> look;
};

/// Keyframes along a line, matched by what is truly the same point.
inline LandmarkMap room_map(const Room& room, const std::vector<TPose2D>& truth,
                            const std::vector<TPose2D>& believed, double pixel_noise,
                            double depth_noise) {
  LandmarkMap map(SlamConfig{}, CameraModel(intrinsics()), forward_camera());
  std::map<int, int> landmark_of_point;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    Keyframe k;
    k.time_s = static_cast<double>(i);
    k.map_from_base = from_planar(believed[i]);
    std::vector<int> point_of;
    k.features = room.seen_from(from_planar(truth[i]), pixel_noise, depth_noise, i + 1, point_of);
    for (const int p : point_of) {
      const auto it = landmark_of_point.find(p);
      k.landmark_of.push_back(it == landmark_of_point.end() ? -1 : it->second);
    }
    const int id = map.add_keyframe(std::move(k));
    for (std::size_t f = 0; f < point_of.size(); ++f) {
      landmark_of_point.try_emplace(point_of[f], map.keyframe(id).landmark_of[f]);
    }
  }
  return map;
}

}  // namespace rovigo::slam::test
