#include "slam/depth_memory.h"

#include <algorithm>
#include <cmath>

#include "slam/keyframe_codec.h"

namespace rovigo::slam {

namespace {

constexpr double kNearM = 2.5, kNearRad = 0.7;  // of a keyframe whose view overlaps this one
constexpr double kRadAsM = 2.0;                 // how much farther a keyframe is that looks aside
constexpr std::size_t kMostViews = 3;

}  // namespace

void DepthMemory::add(const Se3& map_from_base, const maps::Blob& depth_png) {
  const cv::Mat depth = decode_depth(depth_png, {camera_.width(), camera_.height()});
  views_.push_back({map_from_base * base_from_camera_, to_planar(map_from_base),
                    view_of(depth, kStoredDepthUnitM)});
}

std::vector<const DepthMemory::View*> DepthMemory::nearby(const TPose2D& here) const {
  std::vector<std::pair<double, const View*>> near;
  for (const View& v : views_) {
    const double distance =
        maps::distance(maps::position_of(v.map_from_base), maps::position_of(here));
    const double turn = std::abs(maps::wrap_angle(v.map_from_base.phi - here.phi));
    if (distance > kNearM || turn > kNearRad) continue;
    near.emplace_back(distance + kRadAsM * turn, &v);
  }
  const auto end = near.begin() + static_cast<std::ptrdiff_t>(std::min(kMostViews, near.size()));
  std::partial_sort(near.begin(), end, near.end());
  std::vector<const View*> out;
  for (auto it = near.begin(); it != end; ++it) out.push_back(it->second);
  return out;
}

DepthView DepthMemory::view_of(const cv::Mat& depth, double unit_m) const {
  DepthView out{sample_depth(depth, unit_m), {}};
  out.points_camera = lift(out.sample, camera_);
  return out;
}

DepthAgreement DepthMemory::agreement(const DepthView& here, const Se3& map_from_base) const {
  DepthAgreement out;
  const auto add = [&](const DepthAgreement& one) {
    out.at_depth += one.at_depth;
    out.seen_through += one.seen_through;
    out.hidden += one.hidden;
  };
  const Se3 camera_from_map = (map_from_base * base_from_camera_).inverse();
  for (const View* there : nearby(to_planar(map_from_base))) {
    const Se3 here_from_there = camera_from_map * there->map_from_camera;
    add(compare(there->depth.points_camera, here_from_there, here.sample, camera_));
    add(compare(here.points_camera, here_from_there.inverse(), there->depth.sample, camera_));
  }
  return out;
}

}  // namespace rovigo::slam
