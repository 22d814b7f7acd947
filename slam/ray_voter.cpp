#include "slam/ray_voter.h"

#include <algorithm>
#include <cmath>

namespace rovigo::slam {

namespace {

constexpr double kHit = 0.9;      // log-odds of a band that stopped rays, when the range is exact
constexpr double kMiss = 0.45;    // and of one that rays passed
constexpr double kSilence = 0.2;  // and of one where nothing gave a return
constexpr double kSilentShare = 0.5;  // of the rays expected there
constexpr int kManyHits = 5;          // fewer rays vote with less weight: strays are single
constexpr int kManyPasses = 5;
constexpr double kHitShare = 0.2;         // of the rays in a band; thin legs let most of them by
constexpr float kSigmasBeforeEnd = 3.0f;  // a ray's last bit, which may not have been passed
constexpr float kCellsBeforeEnd = 0.75f;  // what stopped it may reach into its last cell
constexpr float kCrowdedM = 0.8f;         // nearer, one ray in eight is plenty
constexpr int kCrowd = 8;
constexpr float kClearBeyondM = 2.0f;  // farther than obstacles are marked, space is still cleared
constexpr std::size_t kShallowBands = 2;
constexpr int kMostCounts = 250;
constexpr int kHalfBands = 2 * kHeightBands;
// Rays expected in half a band, from which on each half gets one at least, however rows fall.
constexpr double kResolved = 1.0;
constexpr double kCrossedShare = 0.25;  // of them must pass both halves

float band_height(const GridConfig& c) {
  return static_cast<float>((c.obstacle_max_height_m - c.obstacle_min_height_m) / kHeightBands);
}

void count(std::uint8_t& n, int weight) {
  n = static_cast<std::uint8_t>(std::min(n + weight, kMostCounts));
}

}  // namespace

void RayVoter::open_window(const DepthScan& scan, const TPose2D& patch_from_level) {
  cosine_ = static_cast<float>(std::cos(patch_from_level.phi));
  sine_ = static_cast<float>(std::sin(patch_from_level.phi));
  eye_ = maps::transform(patch_from_level, {scan.camera.x(), scan.camera.y()});
  const float reach = static_cast<float>(config_.mapping_range_m) + kClearBeyondM;
  float x0 = 0, x1 = 0, y0 = 0, y1 = 0;
  for (const auto* rays : {&scan.rays, &scan.silent}) {
    for (const ScanRay& r : *rays) {
      const float range = std::min(r.range_m, reach);
      const float x = range * (cosine_ * r.along_x - sine_ * r.along_y);
      const float y = range * (sine_ * r.along_x + cosine_ * r.along_y);
      x0 = std::min(x0, x);
      x1 = std::max(x1, x);
      y0 = std::min(y0, y);
      y1 = std::max(y1, y);
    }
  }
  const double cell = config_.grid_resolution_m;
  const auto down = [&](double v) { return static_cast<int>(std::floor(v / cell)) - 1; };
  const auto up = [&](double v) { return static_cast<int>(std::floor(v / cell)) + 2; };
  corner_ = {down(eye_.x + x0), down(eye_.y + y0)};
  width_ = up(eye_.x + x1) - corner_.x;
  height_ = up(eye_.y + y1) - corner_.y;
  counts_.assign(
      static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_) * kHeightBands,
      Counts{});
}

RayVoter::CellRay RayVoter::cell_ray(const DepthScan& scan, const ScanRay& ray) const {
  const auto per_cell = static_cast<float>(1.0 / config_.grid_resolution_m);
  const float per_band = 2.0f / band_height(config_);
  CellRay out;
  out.x = static_cast<float>(eye_.x / config_.grid_resolution_m - corner_.x);
  out.y = static_cast<float>(eye_.y / config_.grid_resolution_m - corner_.y);
  out.dx = cosine_ * ray.along_x - sine_ * ray.along_y;
  out.dy = sine_ * ray.along_x + cosine_ * ray.along_y;
  out.low = (scan.camera.z() - static_cast<float>(config_.obstacle_min_height_m)) * per_band;
  out.slope = ray.slope * per_band / per_cell;
  out.end = ray.range_m * per_cell;
  out.sigma = ray.sigma_m * per_cell;
  return out;
}

std::size_t RayVoter::cell_at(const CellRay& ray, float r) const {
  const int x = static_cast<int>(ray.x + r * ray.dx);
  const int y = static_cast<int>(ray.y + r * ray.dy);
  return (static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
          static_cast<std::size_t>(x)) *
         kHeightBands;
}

/// Counts the ray in every cell it passes between the lowest and the highest obstacle height.
void RayVoter::follow(const CellRay& ray, float from, float to, int weight) {
  float begin = from;
  float end = std::min(ray.end - std::max(kSigmasBeforeEnd * ray.sigma, kCellsBeforeEnd), to);
  const float to_floor = -ray.low, to_top = kHalfBands - ray.low;
  if (std::abs(ray.slope) < 1e-6f) {
    if (to_floor > 0.0f || to_top < 0.0f) return;
  } else {
    const float a = to_floor / ray.slope, b = to_top / ray.slope;
    begin = std::max(begin, std::min(a, b));
    end = std::min(end, std::max(a, b));
  }
  for (float r = begin; r < end; r += 1.0f) {
    const int half = std::clamp(static_cast<int>(ray.low + r * ray.slope), 0, kHalfBands - 1);
    Counts& c = counts_[cell_at(ray, r) + static_cast<std::size_t>(half / 2)];
    count(c.passes[static_cast<std::size_t>(half % 2)], weight);
  }
}

/// Only where it is close to the floor: higher up, open space beyond the range is as silent.
void RayVoter::follow_silent(const CellRay& ray) {
  if (ray.slope > -1e-6f) return;
  const float begin = std::max(0.0f, (2.0f * kShallowBands - ray.low) / ray.slope);
  const float end = std::min(ray.end, -ray.low / ray.slope);
  for (float r = begin; r < end; r += 1.0f) {
    const int half = std::clamp(static_cast<int>(ray.low + r * ray.slope), 0, kHalfBands - 1);
    count(counts_[cell_at(ray, r) + static_cast<std::size_t>(half / 2)].silent, 1);
  }
}

bool RayVoter::is_obstacle_hit(const CellRay& ray) const {
  const float height = ray.low + ray.end * ray.slope;
  return height >= 0.0f && height < kHalfBands &&
         ray.end * config_.grid_resolution_m <= config_.mapping_range_m;
}

maps::Cell RayVoter::end_cell(const CellRay& ray) const {
  return {corner_.x + static_cast<int>(ray.x + ray.end * ray.dx),
          corner_.y + static_cast<int>(ray.y + ray.end * ray.dy)};
}

void RayVoter::count_hit(const CellRay& ray) {
  const float height = ray.low + ray.end * ray.slope;
  const auto band = static_cast<std::size_t>(height) / 2;
  count(counts_[cell_at(ray, ray.end) + band].hits, 1);
}

/// In half a band of a cell.
double RayVoter::rays_expected(double range_m) const {
  const double area = 0.5 * band_height(config_) * config_.grid_resolution_m;
  return rays_per_steradian_ * area / std::max(0.01, range_m * range_m);
}

bool RayVoter::is_silent(const Counts& c, double range_m) const {
  const double expected = std::min<double>(2.0 * rays_expected(range_m), kMostCounts);
  return c.hits == 0 && c.silent > 0 && c.silent >= kSilentShare * expected;
}

/// Rays went through the whole height of the band, as far as the camera's resolution tells.
bool RayVoter::is_crossed(const Counts& c, double range_m) const {
  const double expected = rays_expected(range_m);
  const int fewer = std::min(c.passes[0], c.passes[1]);
  if (expected < kResolved) return c.passes[0] + c.passes[1] > 0;
  return fewer >= kCrossedShare * std::min<double>(expected, kMostCounts);
}

int RayVoter::vote_of(const Counts& counts, double range_m) const {
  const int passes = counts.passes[0] + counts.passes[1];
  if (counts.hits > 0 && counts.hits >= kHitShare * (counts.hits + passes)) {
    // The share of a hit's spread that stays within its cell.
    const double sigma = std::max(1e-3, depth_.sigma_at_1m_m * range_m * range_m);
    const double sure = std::erf(config_.grid_resolution_m / (2.83 * sigma));
    const double many = std::min(1.0, counts.hits / static_cast<double>(kManyHits));
    return std::max(1, static_cast<int>(std::lround(kHit * kStepsPerLogOdds * sure * many)));
  }
  if (!is_crossed(counts, range_m)) {
    return is_silent(counts, range_m) ? -static_cast<int>(kSilence * kStepsPerLogOdds) : 0;
  }
  const double many = std::min(1.0, passes / static_cast<double>(kManyPasses));
  return -static_cast<int>(std::lround(kMiss * kStepsPerLogOdds * many));
}

/// Of a cell. Rays that pass close to the floor meet it at too shallow an angle for a return: who
/// stood there could leave, and his feet would stay. What is taller is known by what is higher up.
std::array<int, kHeightBands> RayVoter::votes_of(const Counts* bands, double range_m) const {
  std::array<int, kHeightBands> votes{};
  for (std::size_t b = 0; b < votes.size(); ++b) votes[b] = vote_of(bands[b], range_m);
  const bool is_taller = votes[kShallowBands] > 0 && votes[kShallowBands + 1] > 0;
  for (std::size_t b = 0; b < kShallowBands && is_taller; ++b) votes[b] = std::min(votes[b], 0);
  return votes;
}

void RayVoter::cast_votes(EvidencePatch& patch) const {
  for (int y = 0; y < height_; ++y) {
    const Counts* row =
        &counts_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) * kHeightBands];
    EvidencePatch::Tile* tile = nullptr;
    EvidencePatch::TileIndex tile_index{};
    for (int x = 0; x < width_; ++x, row += kHeightBands) {
      const bool nothing = std::all_of(row, row + kHeightBands, [](const Counts& c) {
        return c.hits == 0 && c.passes[0] == 0 && c.passes[1] == 0 && c.silent == 0;
      });
      if (nothing) continue;
      const maps::Cell cell{corner_.x + x, corner_.y + y};
      const auto index = EvidencePatch::index_of(cell);
      if (tile == nullptr || !(index == tile_index)) tile = &patch.tile_of(cell);
      tile_index = index;
      CellEvidence& evidence = (*tile)[EvidencePatch::place_in_tile(cell)];
      const double range = std::hypot((cell.x + 0.5) * config_.grid_resolution_m - eye_.x,
                                      (cell.y + 0.5) * config_.grid_resolution_m - eye_.y);
      const auto votes = votes_of(row, range);
      for (std::size_t b = 0; b < votes.size(); ++b) EvidencePatch::add(evidence[b], votes[b]);
    }
  }
}

void RayVoter::vote(const DepthScan& scan, const TPose2D& patch_from_level, EvidencePatch& patch) {
  if (scan.rays.empty()) return;
  open_window(scan, patch_from_level);
  rays_per_steradian_ = scan.columns_per_rad * scan.rows_per_rad;
  const auto crowded = static_cast<float>(kCrowdedM / config_.grid_resolution_m);
  const auto reach =
      static_cast<float>((config_.mapping_range_m + kClearBeyondM) / config_.grid_resolution_m);
  for (std::size_t i = 0; i < scan.rays.size(); ++i) {
    const CellRay ray = cell_ray(scan, scan.rays[i]);
    if (i < static_cast<std::size_t>(scan.fine_from)) follow(ray, 0.0f, crowded, kCrowd);
    follow(ray, crowded, reach, 1);
    if (!is_obstacle_hit(ray)) continue;
    if (scan.rays[i].moving) {
      patch.doubt(end_cell(ray));
    } else {
      count_hit(ray);
    }
  }
  for (const ScanRay& ray : scan.silent) follow_silent(cell_ray(scan, ray));
  cast_votes(patch);
}

void RayVoter::vote_driven(const TPoint2D& at_in_patch, double radius_m,
                           EvidencePatch& patch) const {
  constexpr int kDriven = 16;
  const double cell = config_.grid_resolution_m;
  const maps::Cell c{static_cast<int>(std::floor(at_in_patch.x / cell)),
                     static_cast<int>(std::floor(at_in_patch.y / cell))};
  const int n = static_cast<int>(std::ceil(radius_m / cell));
  for (int dy = -n; dy <= n; ++dy) {
    for (int dx = -n; dx <= n; ++dx) {
      const maps::Cell at{c.x + dx, c.y + dy};
      if (std::hypot((at.x + 0.5) * cell - at_in_patch.x, (at.y + 0.5) * cell - at_in_patch.y) >
          radius_m) {
        continue;
      }
      for (std::int8_t& e : patch.tile_of(at)[EvidencePatch::place_in_tile(at)]) {
        EvidencePatch::add(e, -kDriven);
      }
    }
  }
}

}  // namespace rovigo::slam
