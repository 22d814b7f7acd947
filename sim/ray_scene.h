#pragma once
// Casts rays against quads through Embree, pinned to one instruction set and no threads of its own.

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <vector>

#include "sim/surfaces.h"

namespace rovigo::sim {

/// A row of rays from `origin` along first + i * step, i = 0 .. count - 1, up to `max_t` direction
/// lengths. With `min_t`, each ray begins there; it is not cast where that is negative.
struct RayRow {
  Eigen::Vector3f origin;
  Eigen::Vector3f first;
  Eigen::Vector3f step;
  int count = 0;
  float max_t = 0.0F;
  const float* min_t = nullptr;
};

class RayScene {
 public:
  static constexpr std::uint32_t kMiss = 0xFFFFFFFFU;

  explicit RayScene(const std::vector<Quad>& quads);
  /// On the other scene's device: cheap enough to be made anew for every frame.
  RayScene(const std::vector<Quad>& quads, const RayScene& device_of);
  ~RayScene();

  /// Writes for each ray the quad's index or kMiss, and the distance in direction lengths.
  void cast_row(const RayRow& row, std::uint32_t* quad, float* t) const;
  /// For rays begin .. end - 1, overwrites what lies farther than a hit here; `first_quad` is added
  /// to the quad's index.
  void cast_nearer(const RayRow& row, int begin, int end, std::uint32_t first_quad,
                   std::uint32_t* quad, float* t) const;

 private:
  void build(const std::vector<Quad>& quads, bool often);
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace rovigo::sim
