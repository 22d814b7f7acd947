#include "slam/keyframe_scans.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "slam/keyframe_codec.h"

namespace rovigo::slam {

namespace {

constexpr int kStride = 16;
constexpr double kLevelM = 0.05;    // thickness of a level
constexpr double kGathered = 0.02;  // share of all points that makes a level a surface

void add_heights(const cv::Mat& depth, const Se3& map_from_camera, const LandmarkMap& map,
                 std::vector<float>& heights) {
  const double farthest = map.config().grid.mapping_range_m;
  for (int v = 0; v < depth.rows; v += kStride) {
    for (int u = 0; u < depth.cols; u += kStride) {
      const double z = depth.at<std::uint16_t>(v, u) * kStoredDepthUnitM;
      if (z < map.config().depth.min_depth_m || z > farthest) continue;
      const Eigen::Vector3d p =
          map_from_camera * map.camera().unproject(map.camera().undistort({u, v}), z);
      heights.push_back(static_cast<float>(p.z()));
    }
  }
}

}  // namespace

double estimate_floor_height(const std::vector<float>& heights_m) {
  if (heights_m.empty()) return 0.0;
  std::map<int, int> levels;
  for (const float h : heights_m) ++levels[static_cast<int>(std::floor(h / kLevelM))];
  const auto enough = static_cast<int>(kGathered * static_cast<double>(heights_m.size()));
  for (const auto& [level, count] : levels) {
    const auto above = levels.find(level + 1);
    // A level is a surface when it holds more than the slope of a wall would leave in it.
    if (count >= enough && (above == levels.end() || above->second <= 2 * count)) {
      return (level + 0.5) * kLevelM;
    }
  }
  return *std::min_element(heights_m.begin(), heights_m.end());
}

std::vector<LevelView> level_views(const LandmarkMap& map) {
  const cv::Size size(map.camera().width(), map.camera().height());
  std::vector<float> heights;
  for (const Keyframe& k : map.keyframes()) {
    if (k.depth_png.empty()) continue;
    add_heights(decode_depth(k.depth_png, size), k.map_from_base * map.base_from_camera(), map,
                heights);
  }
  const double floor = estimate_floor_height(heights);
  std::vector<LevelView> out;
  for (const Keyframe& k : map.keyframes()) {
    if (k.depth_png.empty()) continue;
    const Se3 level_from_map = from_planar(to_planar(k.map_from_base)).inverse();
    Se3 level_from_camera = level_from_map * k.map_from_base * map.base_from_camera();
    level_from_camera.translation.z() -= floor;
    out.push_back({k.id, level_from_camera});
  }
  return out;
}

}  // namespace rovigo::slam
