#include "slam/evidence_patch.h"

#include <algorithm>

namespace rovigo::slam {

namespace {

constexpr int kMostSteps = 56;  // log-odds 3.5

int floor_div(int a, int b) { return a >= 0 ? a / b : -((-a + b - 1) / b); }

}  // namespace

EvidencePatch::TileIndex EvidencePatch::index_of(maps::Cell cell) {
  return {floor_div(cell.y, kTileSide), floor_div(cell.x, kTileSide)};
}

EvidencePatch::Tile& EvidencePatch::tile_of(maps::Cell cell) {
  return tiles_.try_emplace(index_of(cell)).first->second;  // value-initialised: zeros
}

std::size_t EvidencePatch::place_in_tile(maps::Cell cell) {
  const TileIndex i = index_of(cell);
  return static_cast<std::size_t>((cell.y - i.y * kTileSide) * kTileSide + cell.x -
                                  i.x * kTileSide);
}

void EvidencePatch::add(std::int8_t& evidence, int steps) {
  evidence = static_cast<std::int8_t>(std::clamp(evidence + steps, -kMostSteps, kMostSteps));
}

}  // namespace rovigo::slam
