#pragma once
// Casts rays against quads through Embree, pinned to one instruction set and no threads of its own.

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <vector>

#include "sim/surfaces.h"

namespace rovigo::sim {

class RayScene {
 public:
  static constexpr std::uint32_t kMiss = 0xFFFFFFFFU;

  explicit RayScene(const std::vector<Quad>& quads);
  ~RayScene();

  /// Rays from `origin` along first + i * step, i = 0 .. count - 1, up to `max_t` direction
  /// lengths. Writes the quad's index or kMiss, and the distance in direction lengths.
  void cast_row(const Eigen::Vector3f& origin, const Eigen::Vector3f& first,
                const Eigen::Vector3f& step, int count, float max_t, std::uint32_t* quad,
                float* t) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace rovigo::sim
