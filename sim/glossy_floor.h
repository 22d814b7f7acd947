#pragma once
// What a depth camera makes of a floor that mirrors: in patches it matches the mirror image, whose
// depth is that of a point below the floor, finds no match, or is off by some centimetres.

#include <cstdint>
#include <optional>

#include "sim/pixel_rays.h"
#include "sim/renderer.h"
#include "sim/scenario.h"

namespace rovigo::sim {

class GlossyFloor {
 public:
  /// `rays` are those of the camera that `view` was rendered for; both must outlive this.
  GlossyFloor(const FloorGloss& gloss, const PixelRays& rays, const View& view,
              std::uint64_t world_seed, std::uint64_t frame_seed);

  bool is_at(std::size_t pixel) const;
  struct Reading {
    bool from_image = false;  ///< of the mirror image, not of the floor
    float depth_m = 0.0F;     ///< 0: no match
  };
  Reading at(int x, int y) const;

 private:
  const FloorGloss& gloss_;
  const PixelRays& rays_;
  const View& view_;
  std::uint64_t world_seed_;
  std::uint64_t frame_seed_;
};

}  // namespace rovigo::sim
