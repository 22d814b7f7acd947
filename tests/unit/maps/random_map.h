#pragma once
// A saved map full of random but valid content, for round trips and for damaging.

#include <random>

#include "maps/map_file.h"

namespace rovigo::maps::test {

inline Blob random_blob(std::mt19937_64& rng, std::size_t max_size) {
  Blob blob(std::uniform_int_distribution<std::size_t>(0, max_size)(rng));
  for (auto& b : blob) b = static_cast<std::uint8_t>(rng());
  return blob;
}

inline mrpt::poses::CPose3D random_pose(std::mt19937_64& rng) {
  std::uniform_real_distribution<double> meters(-30.0, 30.0);
  std::uniform_real_distribution<double> angle(-1.5, 1.5);
  return {meters(rng), meters(rng), meters(rng), 2.0 * angle(rng), angle(rng), angle(rng)};
}

inline TPose2D random_pose_2d(std::mt19937_64& rng) {
  const auto pose = random_pose(rng);
  return {pose.x(), pose.y(), pose.yaw()};
}

inline SavedMap random_map(std::uint64_t seed, int size = 8) {
  std::mt19937_64 rng(seed);
  std::uniform_int_distribution<int> few(0, size);
  std::uniform_int_distribution<int> cell(-1, 100);
  SavedMap map;
  map.metadata.software_version = "0.1.0";
  map.metadata.recording = "lab \xc3\xa8.rawlog";
  map.metadata.camera.setIntrinsicParamsFromValues(517.3, 516.5, 318.6, 255.3);
  map.metadata.camera.distortion = mrpt::img::DistortionModel::plumb_bob;
  for (double& d : map.metadata.camera.dist) d = random_pose(rng).x();
  map.metadata.base_from_camera = random_pose(rng);
  if (seed % 2 == 1) map.metadata.simulation = {"lab", rng(), random_pose_2d(rng)};
  map.grid =
      OccupancyGrid({0.05, {random_pose(rng).x(), -0.0}, 3 * few(rng) + 1, 5 * few(rng) + 1});
  for (auto& c : map.grid.cells) c = static_cast<std::int8_t>(cell(rng));
  const int keyframes = few(rng);
  for (int i = 0; i < keyframes; ++i) {
    map.keyframes.push_back({3 * i, 0.1 * i, random_pose(rng), random_blob(rng, 9000),
                             random_blob(rng, 20000), random_blob(rng, 300)});
  }
  for (int i = 0; i + 1 < keyframes; ++i) {
    StoredEdge edge{3 * i, 3 * i + 3, StoredEdge::Kind::kLoop, random_pose(rng), {}};
    for (int k = 0; k < 36; ++k) edge.information(k / 6, k % 6) = random_pose(rng).y();
    map.edges.push_back(edge);
  }
  for (int i = few(rng) * 20; i > 0; --i) {
    map.trajectory.push_back({1e9 + 0.1 * i, random_pose(rng), i % 3 == 0});
  }
  for (int i = few(rng); i > 0; --i) {
    map.places.push_back({"place " + std::to_string(i), random_pose_2d(rng)});
  }
  for (int i = few(rng); i > 0; --i) {
    NoGoZone zone{std::string("zone\0with a zero", 16), {}};
    for (int k = few(rng); k > 0; --k) zone.corners.emplace_back(random_pose(rng).x(), -0.0);
    map.zones.push_back(zone);
  }
  return map;
}

inline bool same_pose(const mrpt::poses::CPose3D& a, const mrpt::poses::CPose3D& b) {
  return a.x() == b.x() && a.y() == b.y() && a.z() == b.z() &&
         a.getRotationMatrix() == b.getRotationMatrix();
}
inline bool same_pose(const TPose2D& a, const TPose2D& b) {
  return a.x == b.x && a.y == b.y && a.phi == b.phi;
}

/// The first part in which two maps differ, empty when they are the same to the last bit.
inline std::string difference(const SavedMap& a, const SavedMap& b) {
  const auto& ma = a.metadata;
  const auto& mb = b.metadata;
  if (ma.software_version != mb.software_version || ma.recording != mb.recording) return "metadata";
  if (ma.camera != mb.camera || ma.camera.cameraName != mb.camera.cameraName) return "camera";
  if (!same_pose(ma.base_from_camera, mb.base_from_camera)) return "extrinsics";
  if (ma.simulation.has_value() != mb.simulation.has_value()) return "simulation";
  if (ma.simulation &&
      (ma.simulation->world != mb.simulation->world || ma.simulation->seed != mb.simulation->seed ||
       !same_pose(ma.simulation->world_from_map, mb.simulation->world_from_map))) {
    return "simulation";
  }
  if (!(a.grid.geometry == b.grid.geometry) || a.grid.cells != b.grid.cells) return "grid";
  const auto same = [](const auto& x, const auto& y, auto equal) {
    return std::equal(x.begin(), x.end(), y.begin(), y.end(), equal);
  };
  if (!same(a.keyframes, b.keyframes, [](const StoredKeyframe& x, const StoredKeyframe& y) {
        return x.id == y.id && x.time_s == y.time_s &&
               same_pose(x.map_from_base, y.map_from_base) && x.color_jpeg == y.color_jpeg &&
               x.depth_png == y.depth_png && x.features == y.features;
      })) {
    return "keyframes";
  }
  if (!same(a.edges, b.edges, [](const StoredEdge& x, const StoredEdge& y) {
        return x.from == y.from && x.to == y.to && x.kind == y.kind &&
               same_pose(x.from_from_to, y.from_from_to) && x.information == y.information;
      })) {
    return "edges";
  }
  if (!same(a.trajectory, b.trajectory, [](const StoredPose& x, const StoredPose& y) {
        return x.time_s == y.time_s && same_pose(x.map_from_base, y.map_from_base) &&
               x.is_camera_frame == y.is_camera_frame;
      })) {
    return "trajectory";
  }
  if (!same(a.places, b.places, [](const NamedPlace& x, const NamedPlace& y) {
        return x.name == y.name && same_pose(x.pose, y.pose);
      })) {
    return "places";
  }
  if (!same(a.zones, b.zones, [](const NoGoZone& x, const NoGoZone& y) {
        return x.name == y.name &&
               std::equal(x.corners.begin(), x.corners.end(), y.corners.begin(), y.corners.end());
      })) {
    return "zones";
  }
  return {};
}

}  // namespace rovigo::maps::test
