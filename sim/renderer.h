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
  /// Where the floor mirrors: depth of the virtual image below it (infinity: it mirrors nothing);
  /// NaN off the floor. Empty when no mirror was asked for.
  std::vector<float> mirror_depth_m;
};

/// Something that is elsewhere in every frame.
struct Mover {
  std::vector<Solid> solids;
};

struct ViewRequest {
  mrpt::poses::CPose3D world_from_camera;  ///< optical frame
  mrpt::img::TCamera camera;
  std::vector<Mover> movers = {};
  double mirror = 0.0;  ///< of the floor: 0 matt .. 1 as water is
  int threads = 1;      ///< rows are shared out; their number does not change the result
};

class Renderer {
 public:
  explicit Renderer(const WorldModel& world);
  ~Renderer();

  void render(const ViewRequest& request, View& view) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace rovigo::sim
