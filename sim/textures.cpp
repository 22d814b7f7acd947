#include "sim/textures.h"

#include <algorithm>
#include <cmath>

#include "sim/marker_texture.h"
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

/// A print that fills one square metre: a tinted ground, discs and bars, blocks of text.
class Print {
 public:
  explicit Print(std::uint32_t seed) : seed_(seed) {
    const auto h = [&](int i, int k) { return hash01(i, k, seed); };
    ground_ = {0.7F + 0.8F * h(0, 1), 0.7F + 0.8F * h(0, 2), 0.7F + 0.8F * h(0, 3)};
    for (int i = 0; i < kShapes; ++i) {
      const float size = 0.02F + 0.11F * h(i + 1, 6) * h(i + 1, 7);
      shapes_[i] = {h(i + 1, 4),
                    h(i + 1, 5),
                    size,
                    size * (0.3F + 1.6F * h(i + 1, 12)),
                    h(i + 1, 11) < 0.4F,
                    {1.9F * h(i + 1, 8), 1.9F * h(i + 1, 9), 1.9F * h(i + 1, 10)}};
    }
    for (int i = 0; i < kTexts; ++i) {
      texts_[i] = {0.8F * h(i + 40, 4), 0.85F * h(i + 40, 6), 0.15F + 0.3F * h(i + 40, 5),
                   0.06F + 0.1F * h(i + 40, 7)};
    }
  }

  Rgb color_at(float u, float v) const {
    Rgb c = mix(ground_, grey(1.5F), 0.5F * v);
    for (const auto& s : shapes_) {
      const float dx = std::abs(u - s.x);
      const float dy = std::abs(v - s.y);
      const bool inside =
          s.is_disc ? dx * dx + dy * dy < s.width * s.width : dx < s.width && dy < s.height;
      if (inside) c = s.ink;
    }
    for (int i = 0; i < kTexts; ++i) {
      const auto& t = texts_[i];
      const float x = (u - t.x) / t.width;
      const float y = (v - t.y) / t.height;
      if (x < 0.0F || x > 1.0F || y < 0.0F || y > 1.0F) continue;
      const int line = static_cast<int>(y * 5.0F);
      const bool between_lines = y * 5.0F - static_cast<float>(line) < 0.4F;
      const bool word = hash01(static_cast<int>(x * 26.0F), line,
                               seed_ + 40U + static_cast<std::uint32_t>(i)) > 0.3F;
      c = !between_lines && word ? grey(0.08F) : grey(1.7F);
    }
    return c;
  }

 private:
  struct Shape {
    float x, y, width, height;
    bool is_disc;
    Rgb ink;
  };
  struct Text {
    float x, y, width, height;
  };
  static constexpr int kShapes = 26;
  static constexpr int kTexts = 5;
  std::uint32_t seed_;
  Rgb ground_;
  Shape shapes_[kShapes];
  Text texts_[kTexts];
};

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
    case Pattern::kCardboard:
      return cardboard(u, v, seed);
    case Pattern::kPoster:  // drawn as a whole, see Print
    case Pattern::kMarker:  // and see marker_color
    case Pattern::kPlain:
      break;
  }
  return {};
}

/// Texture coordinates grow upwards, the print's rows downwards.
Rgb marker_color(const MarkerPrint& print, float u, float v) {
  const auto cell = [](float share) {
    return static_cast<std::size_t>(
        std::clamp(static_cast<int>(share * kMarkerPrintCells), 0, kMarkerPrintCells - 1));
  };
  return grey(print[cell(1.0F - v)][cell(u)] ? 0.06F : 1.0F);
}

std::uint8_t to_texel(float value) {
  return static_cast<std::uint8_t>(std::clamp(value * 128.0F + 0.5F, 0.0F, 255.0F));
}

/// Each level is the mean of 2 x 2 texels of the one before it.
std::vector<std::uint8_t> halved(const std::vector<std::uint8_t>& fine, int side) {
  std::vector<std::uint8_t> coarse(static_cast<std::size_t>(side) * side);
  coarse.resize(coarse.size() * 4);
  const auto row = static_cast<std::size_t>(side) * 8;
  for (std::size_t y = 0; y < static_cast<std::size_t>(side); ++y) {
    for (std::size_t i = 0; i < static_cast<std::size_t>(side) * 4; ++i) {
      const std::uint8_t* p = &fine[2 * y * row + (i / 4) * 8 + i % 4];
      coarse[y * static_cast<std::size_t>(side) * 4 + i] =
          static_cast<std::uint8_t>((p[0] + p[4] + p[row] + p[row + 4] + 2) / 4);
    }
  }
  return coarse;
}

/// Appends the first texel to every row and the first row to the level, so that a bilinear lookup
/// at its border finds its neighbours in place.
std::vector<std::uint8_t> padded(const std::vector<std::uint8_t>& level, int side) {
  std::vector<std::uint8_t> out;
  const auto row = static_cast<std::ptrdiff_t>(side) * 4;
  out.reserve(static_cast<std::size_t>((side + 1) * (row + 4)));
  for (int y = 0; y <= side; ++y) {
    const auto start = level.begin() + (y % side) * row;
    out.insert(out.end(), start, start + row);
    out.insert(out.end(), start, start + 4);
  }
  return out;
}

std::unique_ptr<Texture> bake(Pattern pattern, std::uint32_t seed) {
  auto texture = std::make_unique<Texture>();
  if (pattern == Pattern::kPoster) texture->texels_per_m = kSide;  // a print covers 1 m
  const Print print(seed);
  const MarkerPrint marker = pattern == Pattern::kMarker ? marker_print(seed) : MarkerPrint{};
  std::vector<std::uint8_t> level(static_cast<std::size_t>(kSide) * kSide * 4);
  std::uint8_t* texel = level.data();
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x, texel += 4) {
      const float u = (static_cast<float>(x) + 0.5F) / kSide;
      const float v = (static_cast<float>(y) + 0.5F) / kSide;
      const Rgb c = pattern == Pattern::kPoster   ? print.color_at(u, v)
                    : pattern == Pattern::kMarker ? marker_color(marker, u, v)
                                                  : color_at(pattern, u, v, seed);
      texel[0] = to_texel(c.b);
      texel[1] = to_texel(c.g);
      texel[2] = to_texel(c.r);
    }
  }
  for (int i = 0, side = kSide; i < Texture::kLevels; ++i, side /= 2) {
    if (i > 0) level = halved(level, side);
    texture->texels[i] = padded(level, side);
  }
  return texture;
}

bool is_unique_per_surface(Pattern pattern) {
  return pattern == Pattern::kPoster || pattern == Pattern::kBooks || pattern == Pattern::kMarker;
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
