#include "sim/shading.h"

#include <emmintrin.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

namespace rovigo::sim {
namespace {

constexpr int kSide = 512;  // Texture::kSide, checked in renderer.cpp
constexpr float kMaxLevel = 9.0F;
constexpr int kMaxTaps = 6;  // along the longer axis of a pixel's footprint
constexpr int kChunk = 64;   // pixels worked on together
constexpr float kSubTexel = 256.0F;

/// Where to look up the texture for each pixel of a chunk: `taps` places around (u, v), `step`
/// apart, at a mip level (integer part and share of the next).
struct Lookups {
  float u[kChunk];
  float v[kChunk];
  float step_u[kChunk];
  float step_v[kChunk];
  float level[kChunk];
  float taps[kChunk];
};

/// log2 of positive numbers, linear between powers of two: within 0.09, and continuous.
inline float rough_log2(float v) {
  return static_cast<float>(std::bit_cast<std::int32_t>(v)) * (1.0F / 8388608.0F) - 127.0F;
}

/// Pixels x0 .. x0 + count of one face: geometry, and where their footprints lie on the texture.
/// The footprint's derivatives come from u = u_start + t (u . D), t = plane / (n . D). The longer
/// of its two sides is sampled in several places, each as wide as the shorter one (in the manner
/// of Heckbert 1986), so that floors seen at a grazing angle stay sharp across.
inline void locate(const FaceView& face, const RowShading& row, int x0, int count,
                   float* __restrict depth, float* __restrict cos_incidence,
                   Lookups& __restrict out) {
  const float n0 = face.n[0] + face.n[2] * row.y;
  const float u0 = face.u[0] + face.u[2] * row.y;
  const float v0 = face.v[0] + face.v[2] * row.y;
  for (int i = 0; i < count; ++i) {
    const auto x = static_cast<float>(x0 + i);
    const float facing = n0 + face.n[1] * x;
    const float inverse = 1.0F / facing;
    const float t = face.plane * inverse;
    depth[x0 + i] = t;
    cos_incidence[x0 + i] = std::fabs(facing) * row.inverse_ray_length[x0 + i];
    const float ud = u0 + face.u[1] * x;
    const float vd = v0 + face.v[1] * x;
    out.u[i] = face.u_start + t * ud;
    out.v[i] = face.v_start + t * vd;
    const float du_dx = t * (face.u[1] - ud * face.n[1] * inverse);
    const float dv_dx = t * (face.v[1] - vd * face.n[1] * inverse);
    const float du_dy = t * (face.u[2] - ud * face.n[2] * inverse);
    const float dv_dy = t * (face.v[2] - vd * face.n[2] * inverse);
    const float a = std::sqrt(du_dx * du_dx + dv_dx * dv_dx);
    const float b = std::sqrt(du_dy * du_dy + dv_dy * dv_dy);
    const bool along_x = a > b;
    const float long_side = along_x ? a : b;
    const float short_side = along_x ? b : a;
    const float limit = short_side > 1.0F ? short_side : 1.0F;
    float taps = static_cast<float>(static_cast<int>(long_side / limit + 0.75F));
    taps = taps > 1.0F ? taps : 1.0F;  // written so that a NaN, too, ends up inside
    taps = taps > kMaxTaps ? static_cast<float>(kMaxTaps) : taps;
    const float per_tap = 1.0F / taps;
    float width = long_side * per_tap;
    width = width > limit ? width : limit;
    float level = rough_log2(width);
    level = level > 0.0F ? level : 0.0F;
    out.level[i] = level > kMaxLevel ? kMaxLevel : level;
    out.taps[i] = taps;
    out.step_u[i] = (along_x ? du_dx : du_dy) * per_tap;
    out.step_v[i] = (along_x ? dv_dx : dv_dy) * per_tap;
  }
}

/// Bilinear sample of a mip level: four channels of 16 bits (texel * 256) in the low half. `x` and
/// `y` count 1/256 of a texel of that level. A row holds one texel more than the side, the first
/// again, and so does the level hold one row more.
inline __m128i bilinear(const std::uint8_t* texels, int side, int x, int y) {
  const int column = (x >> 8) & (side - 1);
  const int line = (y >> 8) & (side - 1);
  const std::ptrdiff_t pitch = (static_cast<std::ptrdiff_t>(side) + 1) * 4;
  const std::uint8_t* low = texels + line * pitch + column * 4;
  const __m128i zero = _mm_setzero_si128();
  const auto pair = [zero](const std::uint8_t* p) {
    std::int64_t two_texels;
    std::memcpy(&two_texels, p, sizeof two_texels);
    return _mm_unpacklo_epi8(_mm_cvtsi64_si128(two_texels), zero);
  };
  const int fx = x & 255;
  const int fy = (y & 255) << 8;
  const __m128i weights = _mm_unpacklo_epi64(_mm_set1_epi16(static_cast<std::int16_t>(256 - fx)),
                                             _mm_set1_epi16(static_cast<std::int16_t>(fx)));
  const __m128i row0 = _mm_mullo_epi16(pair(low), weights);
  const __m128i row1 = _mm_mullo_epi16(pair(low + pitch), weights);
  const __m128i top = _mm_add_epi16(row0, _mm_unpackhi_epi64(row0, row0));
  const __m128i bottom = _mm_add_epi16(row1, _mm_unpackhi_epi64(row1, row1));
  return _mm_add_epi16(_mm_mulhi_epu16(top, _mm_set1_epi16(static_cast<std::int16_t>(65535 - fy))),
                       _mm_mulhi_epu16(bottom, _mm_set1_epi16(static_cast<std::int16_t>(fy))));
}

/// Mean over the taps of the trilinear sample; texel * 256 in four lanes.
inline __m128 sample(const std::uint8_t* const* levels, const Lookups& at, int i) {
  const int fine = static_cast<int>(at.level[i]);
  const int coarse = fine < static_cast<int>(kMaxLevel) ? fine + 1 : fine;
  const auto blend = static_cast<int>((at.level[i] - static_cast<float>(fine)) * 65535.0F);
  const float fine_scale = kSubTexel / static_cast<float>(1 << fine);
  const float coarse_scale = kSubTexel / static_cast<float>(1 << coarse);
  // A texel's value belongs to its middle, hence the half.
  const __m128 scale = _mm_set_ps(coarse_scale, coarse_scale, fine_scale, fine_scale);
  const __m128 half = _mm_set1_ps(-0.5F * kSubTexel);
  const auto taps = static_cast<int>(at.taps[i]);
  const float first = -0.5F * static_cast<float>(taps - 1);
  __m128i sum = _mm_setzero_si128();
  for (int k = 0; k < taps; ++k) {
    const float offset = first + static_cast<float>(k);
    const float u = at.u[i] + offset * at.step_u[i];
    const float v = at.v[i] + offset * at.step_v[i];
    alignas(16) std::int32_t place[4];
    _mm_store_si128(reinterpret_cast<__m128i*>(place),
                    _mm_cvtps_epi32(_mm_add_ps(_mm_mul_ps(_mm_set_ps(v, u, v, u), scale), half)));
    __m128i texel = bilinear(levels[fine], kSide >> fine, place[0], place[1]);
    if (blend > 0) {
      const __m128i other = bilinear(levels[coarse], kSide >> coarse, place[2], place[3]);
      texel = _mm_add_epi16(
          _mm_mulhi_epu16(texel, _mm_set1_epi16(static_cast<std::int16_t>(65535 - blend))),
          _mm_mulhi_epu16(other, _mm_set1_epi16(static_cast<std::int16_t>(blend))));
    }
    sum = _mm_add_epi32(sum, _mm_unpacklo_epi16(texel, _mm_setzero_si128()));
  }
  return _mm_mul_ps(_mm_cvtepi32_ps(sum), _mm_set1_ps(1.0F / static_cast<float>(taps)));
}

/// Pixels that met nothing, or a plain face.
inline void fill(const float bgr[3], int x0, int count, float* out) {
  for (int x = x0; x < x0 + count; ++x) {
    for (int c = 0; c < 3; ++c) out[static_cast<std::ptrdiff_t>(x) * 3 + c] = bgr[c];
  }
}

}  // namespace

__attribute__((target_clones("avx2", "default"))) void shade_row(const RowShading& row,
                                                                 float* depth, float* cos_incidence,
                                                                 float* bgr) {
  constexpr float kBlack[3] = {0.0F, 0.0F, 0.0F};
  Lookups lookups;
  int x = 0;
  while (x < row.width) {  // runs of pixels on one face
    const std::uint32_t id = row.face[x];
    int count = 1;
    while (count < kChunk && x + count < row.width && row.face[x + count] == id) ++count;
    if (id == kNoFace) {
      for (int i = x; i < x + count; ++i) {
        depth[i] = std::numeric_limits<float>::infinity();
        cos_incidence[i] = 0.0F;
      }
      fill(kBlack, x, count, bgr);
      x += count;
      continue;
    }
    const FaceView& face = row.faces[id];
    locate(face, row, x, count, depth, cos_incidence, lookups);
    if (!face.levels) {
      fill(face.bgr, x, count, bgr);
    } else {
      // 128 * 256 is the material's own colour.
      const __m128 tint = _mm_mul_ps(_mm_set_ps(0.0F, face.bgr[2], face.bgr[1], face.bgr[0]),
                                     _mm_set1_ps(1.0F / 32768.0F));
      for (int i = 0; i < count; ++i) {
        alignas(16) float color[4];
        _mm_store_ps(color, _mm_mul_ps(sample(face.levels, lookups, i), tint));
        for (int c = 0; c < 3; ++c) bgr[static_cast<std::ptrdiff_t>(x + i) * 3 + c] = color[c];
      }
    }
    x += count;
  }
}

}  // namespace rovigo::sim
