#pragma once
// Procedural textures with mip levels. A texture is a square of texels that repeats; patterns that
// must not repeat (posters, books) get one of their own for every surface.

#include <cstdint>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "sim/world_model.h"

namespace rovigo::sim {

/// Texels are 4 bytes (blue, green, red, 0); 128 means the material's own colour, so a texel
/// multiplies by texel / 128. Level l has side kSide >> l and is stored with its
/// first column repeated at the end of every row, and its first row at the end.
struct Texture {
  static constexpr int kSide = 512;
  static constexpr int kLevels = 10;
  float texels_per_m = 250.0F;
  std::vector<std::uint8_t> texels[kLevels];
};

/// Bakes textures on demand and keeps them. Same material, same texels.
class TextureLibrary {
 public:
  /// nullptr for plain materials.
  const Texture* get(const Material& material);

 private:
  std::map<std::pair<Pattern, std::uint32_t>, std::unique_ptr<Texture>> baked_;
};

}  // namespace rovigo::sim
