#pragma once
// The renderer's inner loop. Its .cpp is compiled for several instruction sets and therefore
// includes no library header whose layout depends on them (Eigen, MRPT).

#include <cstdint>

namespace rovigo::sim {

/// A face as one camera pose sees it. With pixel (x, y) the ray is D = d0 + x dx + y dy; every
/// field below is linear in it, so that one reciprocal a pixel gives depth and texture position.
struct FaceView {
  float n[3];     ///< normal . D = n0 + n1 x + n2 y
  float plane;    ///< normal . (point on the face - camera); depth = plane / (normal . D)
  float u[3];     ///< u axis . D, likewise
  float v[3];     ///< v axis . D
  float u_start;  ///< texture position of the camera's foot, texels
  float v_start;
  float bgr[3];
  const std::uint8_t* const* levels;  ///< texels of each mip level; nullptr: plain
};

struct RowShading {
  const FaceView* faces;
  const std::uint32_t* face;  ///< per pixel, kNoFace where the ray met nothing
  int width;
  float y;
  const float* inverse_ray_length;  ///< 1 / |D| per pixel
};

inline constexpr std::uint32_t kNoFace = 0xFFFFFFFFU;

void shade_row(const RowShading& row, float* depth, float* cos_incidence, float* bgr);

}  // namespace rovigo::sim
