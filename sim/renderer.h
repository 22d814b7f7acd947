#pragma once
// What a perfect pinhole camera would see of a world: colour and depth, without noise.

#include <mrpt/img/TCamera.h>
#include <mrpt/poses/CPose3D.h>

#include <cstdint>
#include <memory>
#include <vector>

#include "sim/world_model.h"

namespace rovigo::sim {

/// Row-major, one entry a pixel.
struct View {
  int width = 0;
  int height = 0;
  std::vector<float> depth_m;        ///< along the optical axis; infinity: nothing there
  std::vector<float> cos_incidence;  ///< of the ray on the surface, 0 .. 1
  std::vector<float> bgr;            ///< three a pixel, 0 .. 1 and above where overexposed
};

class Renderer {
 public:
  explicit Renderer(const WorldModel& world);
  ~Renderer();

  /// `world_from_camera` is the optical frame. Rows are shared out over `threads` threads; their
  /// number does not change the result.
  void render(const mrpt::poses::CPose3D& world_from_camera, const mrpt::img::TCamera& camera,
              int threads, View& view) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace rovigo::sim
