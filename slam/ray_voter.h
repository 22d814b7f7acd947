#pragma once
// One view's evidence: the rays of a depth scan, followed through cells and height bands.

#include <array>
#include <cstdint>
#include <vector>

#include "slam/depth_scan.h"
#include "slam/evidence_patch.h"

namespace rovigo::slam {

/// Occupancy mapping with an inverse sensor model (Moravec & Elfes 1985; in three dimensions
/// Hornung et al. 2013, OctoMap), a view at a time: within one view each cell and band is voted on
/// once, by the rays that end in it against those that pass. A ray's last bit, where noise may have
/// put its end too far, says nothing.
class RayVoter {
 public:
  RayVoter(const GridConfig& config, const DepthConfig& depth) : config_(config), depth_(depth) {}

  /// Adds one view to `patch`; the pose tells where the scan's level frame lies in it.
  void vote(const DepthScan& scan, const TPose2D& patch_from_level, EvidencePatch& patch);

  /// The rover's own body stood here: free at every height.
  void vote_driven(const TPoint2D& at_in_patch, double radius_m, EvidencePatch& patch) const;

 private:
  /// Of one band of one cell. Passes are counted apart in the band's lower and upper half: a thin
  /// top that hides one half stands, though rays pass through the other.
  struct Counts {
    std::uint8_t hits = 0;
    std::array<std::uint8_t, 2> passes{};
    std::uint8_t silent = 0;  ///< rays on their way to ground that gives no return
  };
  /// A ray in units of cells, from the window's corner.
  struct CellRay {
    float x = 0, y = 0, dx = 0, dy = 0;
    float low = 0, slope = 0;  ///< height in half bands, above the lowest
    float end = 0, sigma = 0;
  };

  void open_window(const DepthScan& scan, const TPose2D& patch_from_level);
  CellRay cell_ray(const DepthScan& scan, const ScanRay& ray) const;
  void follow(const CellRay& ray, float from, float to, int weight);
  void follow_silent(const CellRay& ray);
  bool is_obstacle_hit(const CellRay& ray) const;
  void count_hit(const CellRay& ray);
  maps::Cell end_cell(const CellRay& ray) const;
  std::size_t cell_at(const CellRay& ray, float r) const;
  void cast_votes(EvidencePatch& patch) const;
  int vote_of(const Counts& counts, double range_m) const;
  std::array<int, kHeightBands> votes_of(const Counts* bands, double range_m) const;
  bool is_crossed(const Counts& counts, double range_m) const;
  bool is_silent(const Counts& counts, double range_m) const;
  double rays_expected(double range_m) const;

  GridConfig config_;
  DepthConfig depth_;
  TPoint2D eye_;                       ///< in the patch
  float cosine_ = 1.0f, sine_ = 0.0f;  ///< patch from level
  maps::Cell corner_;                  ///< of the window, in the patch's cells
  int width_ = 0, height_ = 0;
  float rays_per_steradian_ = 0.0f;
  std::vector<Counts> counts_;  ///< by cell, then band
};

}  // namespace rovigo::slam
