#include "sim/textures.h"

#include <algorithm>
#include <cmath>

#include "sim/random.h"

namespace rovigo::sim {
namespace {

constexpr int kSide = Texture::kSide;

struct Rgb {
  float r = 1.0F;
  float g = 1.0F;
  float b = 1.0F;
};

Rgb grey(float v) { return {v, v, v}; }
Rgb mix(const Rgb& a, const Rgb& b, float t) {
  return {a.r + (b.r - a.r) * t, a.g + (b.g - a.g) * t, a.b + (b.b - a.b) * t};
}
Rgb scaled(const Rgb& a, float f) { return {a.r * f, a.g * f, a.b * f}; }

float hash01(int x, int y, std::uint32_t seed) {
  const auto key = (static_cast<std::uint64_t>(static_cast<std::uint32_t>(x)) << 32U) |
                   static_cast<std::uint32_t>(y);
  return static_cast<float>(unit_interval(scramble(key ^ derive_seed(seed, 7))));
}

int wrap(int v, int period) {
  const int m = v % period;
  return m < 0 ? m + period : m;
}

/// Value noise on a lattice of `cells_u` x `cells_v` over the texture, smooth and periodic, 0 .. 1.
float value_noise(float u, float v, int cells_u, int cells_v, std::uint32_t seed) {
  const float x = u * static_cast<float>(cells_u);
  const float y = v * static_cast<float>(cells_v);
  const int x0 = static_cast<int>(std::floor(x));
  const int y0 = static_cast<int>(std::floor(y));
  const auto smooth = [](float t) { return t * t * (3.0F - 2.0F * t); };
  const float fx = smooth(x - static_cast<float>(x0));
  const float fy = smooth(y - static_cast<float>(y0));
  const auto at = [&](int i, int j) { return hash01(wrap(i, cells_u), wrap(j, cells_v), seed); };
  const float low = at(x0, y0) + (at(x0 + 1, y0) - at(x0, y0)) * fx;
  const float high = at(x0, y0 + 1) + (at(x0 + 1, y0 + 1) - at(x0, y0 + 1)) * fx;
  return low + (high - low) * fy;
}

float value_noise(float u, float v, int cells, std::uint32_t seed) {
  return value_noise(u, v, cells, cells, seed);
}

/// Octaves of value noise from `first` lattice cells up, each finer one with `gain` the weight.
float octaves(float u, float v, int first, int count, float gain, std::uint32_t seed) {
  float sum = 0.0F;
  float weight = 1.0F;
  float total = 0.0F;
  for (int i = 0; i < count; ++i) {
    sum += weight * value_noise(u, v, first << i, seed + static_cast<std::uint32_t>(i));
    total += weight;
    weight *= gain;
  }
  return sum / total;
}

Rgb noise(float u, float v, std::uint32_t seed) {
  const float n = octaves(u, v, 6, 6, 0.8F, seed);
  const float sharp = std::clamp((n - 0.5F) * 3.2F + 0.5F, 0.0F, 1.0F);
  return grey(0.45F + 0.95F * sharp);
}

Rgb plaster(float u, float v, std::uint32_t seed) {
  return grey(0.97F + 0.06F * (octaves(u, v, 5, 5, 0.7F, seed) - 0.5F) * 2.0F);
}

Rgb bricks(float u, float v, std::uint32_t seed) {
  constexpr int kCourses = 26;  // about 8 cm each over 2 m
  constexpr int kPerCourse = 8;
  const float y = v * kCourses;
  const int row = static_cast<int>(std::floor(y));
  const float x = u * kPerCourse + (row % 2 != 0 ? 0.5F : 0.0F);
  const int column = wrap(static_cast<int>(std::floor(x)), kPerCourse);
  const float fx = x - std::floor(x);
  const float fy = y - static_cast<float>(row);
  if (fx < 0.035F || fy < 0.12F) return grey(1.25F);
  const float tone = 0.62F + 0.5F * hash01(column, row, seed);
  const float grain = octaves(u, v, 32, 3, 0.8F, seed + 50);
  return {tone * (0.8F + 0.4F * grain), tone * (0.75F + 0.4F * grain),
          tone * (0.7F + 0.4F * grain)};
}

Rgb wood(float u, float v, std::uint32_t seed) {
  constexpr int kPlanks = 12;
  const float x = u * kPlanks;
  const int plank = wrap(static_cast<int>(std::floor(x)), kPlanks);
  const float tone = 0.75F + 0.4F * hash01(plank, 1, seed);
  const float warp = octaves(u, v, 4, 3, 0.6F, seed + 9) * 1.5F;
  const float ring = value_noise(u + warp * 0.02F, v, 128, 16, seed + 20);
  const float fine = value_noise(u, v, 256, 32, seed + 21);
  const float knot = value_noise(u, v, 14, seed + 22) > 0.86F ? 0.62F : 1.0F;
  const float joint = (x - std::floor(x)) < 0.03F ? 0.55F : 1.0F;
  const float g = tone * joint * knot * (0.72F + 0.35F * ring + 0.2F * fine);
  return {g, g * 0.97F, g * 0.93F};
}

Rgb tiles(float u, float v, std::uint32_t seed) {
  constexpr int kTiles = 7;  // about 30 cm
  const float x = u * kTiles;
  const float y = v * kTiles;
  const float fx = x - std::floor(x);
  const float fy = y - std::floor(y);
  if (fx < 0.025F || fy < 0.025F) return grey(0.6F);
  const float tone =
      0.9F + 0.2F * hash01(static_cast<int>(std::floor(x)), static_cast<int>(std::floor(y)), seed);
  const float speckle = octaves(u, v, 48, 3, 1.0F, seed + 3);
  return grey(tone * (speckle > 0.66F ? 0.7F : 0.92F + 0.2F * (speckle - 0.5F)));
}

Rgb carpet(float u, float v, std::uint32_t seed) {
  const float blot = octaves(u, v, 10, 4, 0.75F, seed);
  const float weave = value_noise(u, v, 170, seed + 30);
  const float g = 0.62F + 0.55F * std::clamp((blot - 0.5F) * 2.5F + 0.5F, 0.0F, 1.0F);
  return grey(g * (0.85F + 0.3F * weave));
}

/// Rows of spines of random width, height and colour. One texture spans 2 m.
Rgb books(float u, float v, std::uint32_t seed) {
  constexpr int kRows = 6;
  const float y = v * kRows;
  const int row = static_cast<int>(std::floor(y));
  const float fy = y - static_cast<float>(row);
  if (fy < 0.06F) return grey(0.55F);  // the board
  constexpr int kSlots = 48;
  const int slot = wrap(static_cast<int>(std::floor(u * kSlots)), kSlots);
  // A spine is one or two slots wide: an odd slot may belong to its left neighbour.
  const bool joined = slot % 2 == 1 && hash01(slot, row, seed + 1) > 0.5F;
  const int book = joined ? slot - 1 : slot;
  const float height = 0.62F + 0.33F * hash01(book, row, seed + 2);
  if (fy > height) return grey(0.16F);
  const auto h = [&](std::uint32_t k) { return hash01(book, row, seed + k); };
  Rgb cover{0.25F + 1.4F * h(3), 0.25F + 1.2F * h(4), 0.25F + 1.3F * h(5)};
  const float fu = u * kSlots - static_cast<float>(book);
  const float width = hash01(book + 1, row, seed + 1) > 0.5F && book % 2 == 0 ? 2.0F : 1.0F;
  if (fu < 0.08F || fu > width - 0.08F) return scaled(cover, 0.5F);
  const float title = (fy - 0.2F) / (height - 0.35F);
  const bool lettering = title > 0.0F && title < 1.0F && std::abs(fu - width / 2) < 0.25F * width &&
                         value_noise(u, v, 220, seed + 6) > 0.5F;
  return lettering ? grey(h(7) > 0.5F ? 1.7F : 0.1F) : cover;
}

/// A print that fills one square metre: a tinted ground, discs, bars, blocks of text.
Rgb poster(float u, float v, std::uint32_t seed) {
  const auto h = [&](int i, std::uint32_t k) { return hash01(i, static_cast<int>(k), seed); };
  Rgb c = mix({0.6F + 1.1F * h(0, 1), 0.6F + 1.1F * h(0, 2), 0.6F + 1.1F * h(0, 3)}, grey(1.6F),
              0.5F * v);
  for (int i = 1; i <= 26; ++i) {
    const float x = h(i, 4);
    const float y = h(i, 5);
    const float size = 0.02F + 0.11F * h(i, 6) * h(i, 7);
    const Rgb ink{1.9F * h(i, 8), 1.9F * h(i, 9), 1.9F * h(i, 10)};
    const float dx = std::abs(u - x);
    const float dy = std::abs(v - y);
    const bool disc = h(i, 11) < 0.4F;
    const float aspect = 0.3F + 1.6F * h(i, 12);
    if (disc ? dx * dx + dy * dy < size * size : dx < size && dy < size * aspect) c = ink;
  }
  for (int i = 40; i < 45; ++i) {  // text: dark words on lines
    const float x = (u - 0.8F * h(i, 4)) / (0.15F + 0.3F * h(i, 5));
    const float y = (v - 0.85F * h(i, 6)) / (0.06F + 0.1F * h(i, 7));
    if (x < 0.0F || x > 1.0F || y < 0.0F || y > 1.0F) continue;
    const int line = static_cast<int>(y * 5.0F);
    const bool gap = y * 5.0F - static_cast<float>(line) < 0.4F;
    c = !gap && hash01(static_cast<int>(x * 26.0F), line, seed + static_cast<std::uint32_t>(i)) >
                    0.3F
            ? grey(0.08F)
            : grey(1.75F);
  }
  return c;
}

Rgb cardboard(float u, float v, std::uint32_t seed) {
  const float grain = octaves(u, v, 12, 5, 0.75F, seed);
  Rgb c = grey(0.78F + 0.44F * grain);
  constexpr int kCells = 5;  // a label, a stamp or nothing in every 40 cm
  const float x = u * kCells;
  const float y = v * kCells;
  const int i = static_cast<int>(std::floor(x));
  const int j = static_cast<int>(std::floor(y));
  const float fx = x - static_cast<float>(i) - 0.5F * hash01(i, j, seed + 60);
  const float fy = y - static_cast<float>(j) - 0.5F * hash01(i, j, seed + 61);
  if (fx > 0.05F && fx < 0.45F && fy > 0.05F && fy < 0.35F && hash01(i, j, seed + 62) > 0.25F) {
    const bool ink = hash01(static_cast<int>(fx * 40.0F), static_cast<int>(fy * 24.0F),
                            seed + 63 + static_cast<std::uint32_t>(i * 8 + j)) > 0.55F;
    c = grey(ink ? 0.25F : 1.55F);
  }
  return c;
}

Rgb color_at(Pattern pattern, float u, float v, std::uint32_t seed) {
  switch (pattern) {
    case Pattern::kNoise:
      return noise(u, v, seed);
    case Pattern::kPlaster:
      return plaster(u, v, seed);
    case Pattern::kBricks:
      return bricks(u, v, seed);
    case Pattern::kWood:
      return wood(u, v, seed);
    case Pattern::kTiles:
      return tiles(u, v, seed);
    case Pattern::kCarpet:
      return carpet(u, v, seed);
    case Pattern::kBooks:
      return books(u, v, seed);
    case Pattern::kPoster:
      return poster(u, v, seed);
    case Pattern::kCardboard:
      return cardboard(u, v, seed);
    case Pattern::kPlain:
      break;
  }
  return {};
}

std::uint8_t to_texel(float value) {
  return static_cast<std::uint8_t>(std::clamp(value * 128.0F + 0.5F, 0.0F, 255.0F));
}

/// Each level is the mean of 2 x 2 texels of the one before it.
void build_levels(Texture& texture) {
  for (int level = 1; level < Texture::kLevels; ++level) {
    const auto& fine = texture.texels[level - 1];
    auto& coarse = texture.texels[level];
    const int side = kSide >> level;
    const int fine_side = side * 2;
    coarse.resize(static_cast<std::size_t>(side) * side * 4);
    for (int y = 0; y < side; ++y) {
      for (int x = 0; x < side; ++x) {
        for (int c = 0; c < 4; ++c) {
          const auto at = [&](int dx, int dy) {
            return int{
                fine[(static_cast<std::size_t>(2 * y + dy) * fine_side + 2 * x + dx) * 4 + c]};
          };
          coarse[(static_cast<std::size_t>(y) * side + x) * 4 + c] =
              static_cast<std::uint8_t>((at(0, 0) + at(1, 0) + at(0, 1) + at(1, 1) + 2) / 4);
        }
      }
    }
  }
}

std::unique_ptr<Texture> bake(Pattern pattern, std::uint32_t seed) {
  auto texture = std::make_unique<Texture>();
  if (pattern == Pattern::kPoster) texture->texels_per_m = 512.0F;
  texture->texels[0].resize(static_cast<std::size_t>(kSide) * kSide * 4);
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      const Rgb c = color_at(pattern, (static_cast<float>(x) + 0.5F) / kSide,
                             (static_cast<float>(y) + 0.5F) / kSide, seed);
      auto* texel = &texture->texels[0][(static_cast<std::size_t>(y) * kSide + x) * 4];
      texel[0] = to_texel(c.b);
      texel[1] = to_texel(c.g);
      texel[2] = to_texel(c.r);
      texel[3] = 0;
    }
  }
  build_levels(*texture);
  return texture;
}

bool is_unique_per_surface(Pattern pattern) {
  return pattern == Pattern::kPoster || pattern == Pattern::kBooks;
}

}  // namespace

const Texture* TextureLibrary::get(const Material& material) {
  if (material.pattern == Pattern::kPlain) return nullptr;
  const std::uint32_t seed = is_unique_per_surface(material.pattern) ? material.seed : 0;
  auto& slot = baked_[{material.pattern, seed}];
  if (!slot) slot = bake(material.pattern, seed);
  return slot.get();
}

}  // namespace rovigo::sim
