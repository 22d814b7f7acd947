#pragma once
// What the depth camera should measure at a pose, as the map's keyframes remember it: surfaces with
// and without texture, at every height. It judges a place that features or a flat scan suggested.

#include <Eigen/Core>
#include <vector>

#include "maps/map_file.h"
#include "slam/depth_sample.h"

namespace rovigo::slam {

/// A depth image ready to be compared, both ways.
struct DepthView {
  DepthSample sample;
  std::vector<Eigen::Vector3f> points_camera;
};

class DepthMemory {
 public:
  DepthMemory(const CameraModel& camera, const Se3& base_from_camera)
      : camera_(camera), base_from_camera_(base_from_camera) {}

  /// Takes in a keyframe's depth image as the map holds it; one that cannot be read shows nothing.
  void add(const Se3& map_from_base, const maps::Blob& depth_png);

  DepthView view_of(const cv::Mat& depth, double unit_m) const;

  /// What keyframes near `map_from_base` saw, against the view, and what the view shows against
  /// the space they saw to be free. Nothing to judge where no keyframe looked that way.
  DepthAgreement agreement(const DepthView& view, const Se3& map_from_base) const;

 private:
  struct View {
    Se3 map_from_camera;
    TPose2D map_from_base;
    DepthView depth;
  };
  std::vector<const View*> nearby(const TPose2D& map_from_base) const;

  CameraModel camera_;
  Se3 base_from_camera_;
  std::vector<View> views_;
};

}  // namespace rovigo::slam
