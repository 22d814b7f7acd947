#include "sim/shading.h"

#include <cmath>
#include <cstring>
#include <limits>

namespace rovigo::sim {
namespace {

constexpr int kSide = 512;  // Texture::kSide, checked in renderer.cpp
constexpr int kMaxLevel = 9;
constexpr int kMaxTaps = 6;  // along the longer axis of the pixel's footprint

using Float4 = float __attribute__((vector_size(16)));
using Int4 = std::int32_t __attribute__((vector_size(16)));
using Byte4 = std::uint8_t __attribute__((vector_size(4)));

inline Float4 load_texel(const std::uint8_t* texels, int index) {
  Byte4 bytes;
  std::memcpy(&bytes, texels + static_cast<std::ptrdiff_t>(index) * 4, 4);
  return __builtin_convertvector(bytes, Float4);
}

inline int fast_floor(float v) {
  const int i = static_cast<int>(v);
  return i - (v < static_cast<float>(i) ? 1 : 0);
}

/// Bilinear sample of one mip level at texel coordinates of level 0; the texture repeats.
inline Float4 sample_level(const std::uint8_t* texels, int level, float u, float v) {
  const int side = kSide >> level;
  const int mask = side - 1;
  const float scale = 1.0F / static_cast<float>(1 << level);
  const float x = u * scale - 0.5F;
  const float y = v * scale - 0.5F;
  const int ix = fast_floor(x);
  const int iy = fast_floor(y);
  const float fx = x - static_cast<float>(ix);
  const float fy = y - static_cast<float>(iy);
  const int x0 = ix & mask;
  const int x1 = (ix + 1) & mask;
  const int y0 = (iy & mask) * side;
  const int y1 = ((iy + 1) & mask) * side;
  const Float4 low = load_texel(texels, y0 + x0) * (1.0F - fx) + load_texel(texels, y0 + x1) * fx;
  const Float4 high = load_texel(texels, y1 + x0) * (1.0F - fx) + load_texel(texels, y1 + x1) * fx;
  return low * (1.0F - fy) + high * fy;
}

/// log2 for positive numbers, piecewise linear in the mantissa: good to 0.09, plenty for mip
/// levels, and continuous.
inline float rough_log2(float v) {
  std::int32_t bits;
  std::memcpy(&bits, &v, sizeof bits);
  return static_cast<float>(bits) * (1.0F / 8388608.0F) - 127.0F;
}

struct Footprint {
  float du_dx, dv_dx, du_dy, dv_dy;  // texels a pixel
};

/// Anisotropic trilinear lookup (in the manner of Heckbert 1986): taps along the footprint's
/// longer axis, each from the mip levels that fit the shorter one.
inline Float4 sample(const FaceView& face, float u, float v, const Footprint& f) {
  const float a2 = f.du_dx * f.du_dx + f.dv_dx * f.dv_dx;
  const float b2 = f.du_dy * f.du_dy + f.dv_dy * f.dv_dy;
  const bool along_x = a2 > b2;
  const float long_side = std::sqrt(along_x ? a2 : b2);
  const float short_side = std::sqrt(along_x ? b2 : a2);
  const float limit = short_side > 1.0F ? short_side : 1.0F;
  int taps = static_cast<int>(long_side / limit + 0.999F);
  taps = taps < 1 ? 1 : (taps > kMaxTaps ? kMaxTaps : taps);
  float width = long_side / static_cast<float>(taps);
  width = width > limit ? width : limit;
  float level = rough_log2(width);
  level = level > static_cast<float>(kMaxLevel) ? static_cast<float>(kMaxLevel) : level;
  const int fine = level > 0.0F ? static_cast<int>(level) : 0;
  const int coarse = fine < kMaxLevel ? fine + 1 : fine;
  const float blend = level > 0.0F ? level - static_cast<float>(fine) : 0.0F;
  const float step_u = (along_x ? f.du_dx : f.du_dy) / static_cast<float>(taps);
  const float step_v = (along_x ? f.dv_dx : f.dv_dy) / static_cast<float>(taps);
  const float centre = 0.5F * static_cast<float>(taps - 1);
  Float4 sum = {0.0F, 0.0F, 0.0F, 0.0F};
  for (int i = 0; i < taps; ++i) {
    const float k = static_cast<float>(i) - centre;
    const float tu = u + k * step_u;
    const float tv = v + k * step_v;
    Float4 s = sample_level(face.levels[fine], fine, tu, tv);
    if (blend > 0.0F) {
      s += (sample_level(face.levels[coarse], coarse, tu, tv) - s) * blend;
    }
    sum += s;
  }
  return sum * (1.0F / (128.0F * static_cast<float>(taps)));
}

}  // namespace

__attribute__((target_clones("avx2", "default"))) void shade_row(const RowShading& row,
                                                                 float* depth, float* cos_incidence,
                                                                 float* bgr) {
  for (int x = 0; x < row.width; ++x) {
    float* out = bgr + static_cast<std::ptrdiff_t>(x) * 3;
    if (row.face[x] == kNoFace) {
      depth[x] = std::numeric_limits<float>::infinity();
      cos_incidence[x] = 0.0F;
      out[0] = out[1] = out[2] = 0.0F;
      continue;
    }
    const FaceView& face = row.faces[row.face[x]];
    const auto px = static_cast<float>(x);
    const float facing = face.n[0] + face.n[1] * px + face.n[2] * row.y;
    const float inverse = 1.0F / facing;
    const float t = face.plane * inverse;
    depth[x] = t;
    cos_incidence[x] = std::fabs(facing) * row.inverse_ray_length[x];
    if (!face.levels) {
      for (int c = 0; c < 3; ++c) out[c] = face.bgr[c];
      continue;
    }
    const float ud = face.u[0] + face.u[1] * px + face.u[2] * row.y;
    const float vd = face.v[0] + face.v[1] * px + face.v[2] * row.y;
    // d(t u)/dx with t = plane / facing
    const Footprint f{
        t * (face.u[1] - ud * face.n[1] * inverse), t * (face.v[1] - vd * face.n[1] * inverse),
        t * (face.u[2] - ud * face.n[2] * inverse), t * (face.v[2] - vd * face.n[2] * inverse)};
    const Float4 texel = sample(face, face.u_start + t * ud, face.v_start + t * vd, f);
    for (int c = 0; c < 3; ++c) out[c] = texel[c] * face.bgr[c];
  }
}

}  // namespace rovigo::sim
