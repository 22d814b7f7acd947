#include "sim/glossy_floor.h"

#include <algorithm>
#include <cmath>

#include "sim/random.h"

namespace rovigo::sim {
namespace {

constexpr float kPatchM = 0.35F;   // on the floor: where it is polished
constexpr float kPatchPx = 24.0F;  // in the image: what happens to match
constexpr float kWavePx = 16.0F;   // of the floor's own depth

float smooth(float v) {
  v = std::clamp(v, 0.0F, 1.0F);
  return v * v * (3.0F - 2.0F * v);
}

/// Smooth noise in [0, 1] with features about 1 wide (Perlin 1985's value form).
float value_noise(float u, float v, std::uint64_t seed) {
  const float fu = std::floor(u);
  const float fv = std::floor(v);
  const auto corner = [&](int du, int dv) {
    const auto i = static_cast<std::uint64_t>(static_cast<std::int64_t>(fu) + du);
    const auto j = static_cast<std::uint64_t>(static_cast<std::int64_t>(fv) + dv);
    return static_cast<float>(
        unit_interval(scramble(seed + i * 0x9e3779b97f4a7c15ULL + (j << 32U))));
  };
  const float a = smooth(u - fu);
  const float b = smooth(v - fv);
  const float low = corner(0, 0) + a * (corner(1, 0) - corner(0, 0));
  const float high = corner(0, 1) + a * (corner(1, 1) - corner(0, 1));
  return low + b * (high - low);
}

/// 0 where one looks steeply down, 1 where the view grazes the floor.
float shallowness(float cosine) {
  constexpr float kSteep = 0.57F;    // 55 deg from the floor's normal
  constexpr float kShallow = 0.21F;  // 78 deg
  return smooth((kSteep - cosine) / (kSteep - kShallow));
}

}  // namespace

GlossyFloor::GlossyFloor(const FloorGloss& gloss, const PixelRays& rays, const View& view,
                         std::uint64_t world_seed, std::uint64_t frame_seed)
    : gloss_(gloss), rays_(rays), view_(view), world_seed_(world_seed), frame_seed_(frame_seed) {}

bool GlossyFloor::is_at(std::size_t pixel) const {
  return !view_.mirror_depth_m.empty() && !std::isnan(view_.mirror_depth_m[pixel]);
}

GlossyFloor::Reading GlossyFloor::at(int x, int y) const {
  const std::size_t i = static_cast<std::size_t>(y) * static_cast<std::size_t>(view_.width) +
                        static_cast<std::size_t>(x);
  const float z = view_.depth_m[i];
  const Eigen::Vector3d p =
      rays_.origin + static_cast<double>(z) * (rays_.d0 + x * rays_.dx + y * rays_.dy);
  const auto px = static_cast<float>(x);
  const auto py = static_cast<float>(y);
  const float polish = value_noise(static_cast<float>(p.x()) / kPatchM,
                                   static_cast<float>(p.y()) / kPatchM, world_seed_);
  const float match = value_noise(px / kPatchPx, py / kPatchPx, frame_seed_);
  // The mean of two such noises is bunched round 1/2; this spreads it over 0 .. 1.
  const float chance = smooth((0.5F * (polish + match) - 0.15F) / 0.7F);
  const float shallow = shallowness(view_.cos_incidence[i]);
  const auto image_share = static_cast<float>(gloss_.virtual_depth_share) * shallow;
  const auto lost_share = static_cast<float>(gloss_.dropout_share) * shallow;
  if (chance < image_share) {
    const float image_m = view_.mirror_depth_m[i];
    return {true, std::isfinite(image_m) ? image_m : 0.0F};
  }
  if (chance > 1.0F - lost_share) return {false, 0.0F};
  const float wave = 2.0F * value_noise(px / kWavePx, py / kWavePx, frame_seed_ + 1) - 1.0F;
  return {false, z + 2.0F * static_cast<float>(gloss_.depth_noise_m) * shallow * wave};
}

}  // namespace rovigo::sim
