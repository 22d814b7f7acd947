#pragma once
// The RGB-D camera: what it makes of a perfect view. Noise is a function of (seed, frame, pixel).

#include <mrpt/obs/CObservation3DRangeScan.h>

#include <memory>
#include <opencv2/core/mat.hpp>

#include "sim/random.h"
#include "sim/renderer.h"
#include "sim/scenario.h"

namespace rovigo::sim {

/// One exposure.
struct Shot {
  std::uint64_t index = 0;
  mrpt::poses::CPose3D world_from_camera;  ///< optical frame
  double yaw_rate_rad_s = 0.0;             ///< about the camera's vertical: turning blurs
  double interval_s = 1.0 / 30.0;          ///< since the previous shot
  double light = 1.0;                      ///< 1: as the world was lit when it was made
  bool covered = false;                    ///< something lies on the lenses
  std::vector<Mover> movers = {};          ///< people
};

class DepthCamera {
 public:
  DepthCamera(const WorldModel& world, const CameraNoise& noise, const FloorGloss& floor,
              const mrpt::img::TCamera& intrinsics, std::uint64_t seed);

  /// Shots are to be taken in order: auto exposure follows them.
  mrpt::obs::CObservation3DRangeScan::Ptr take(const Shot& shot);

 private:
  void expose(const Shot& shot, cv::Mat& image);
  void measure_depth(const Shot& shot, mrpt::math::CMatrix_u16& range_mm) const;

  CameraNoise noise_;
  FloorGloss floor_;
  mrpt::img::TCamera intrinsics_;
  std::uint64_t seed_;
  Renderer renderer_;
  GaussianTable gaussian_;
  View view_;
  double gain_ = 1.0;
  bool gain_is_set_ = false;
};

}  // namespace rovigo::sim
