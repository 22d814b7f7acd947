#pragma once
// What the depth camera met at obstacle height over the last metres: a short-sighted camera that
// turns becomes a wide scan.

#include <deque>
#include <vector>

#include "slam/grid_match.h"

namespace rovigo::slam {

/// Scans tied together by odometry. Old ones go: odometry drifts, and people walk on.
class LocalScan {
 public:
  /// Takes a scan (in base_link) made at `odom_from_base`, unless the rover has hardly moved since
  /// the last one taken; one that does not go on from it (`jumped`) is taken in any case. True if
  /// it was taken.
  bool add(double time_s, const TPose2D& odom_from_base, const std::vector<ScanPoint>& scan,
           bool jumped = false);
  void clear() { views_.clear(); }
  void forget_before(double time_s);

  /// All points in base_link at `odom_from_base`, one per 10 cm square: near surfaces are sampled
  /// densely and would outvote the far ones. Ordered by place, whatever the order of adding.
  std::vector<ScanPoint> points(const TPose2D& odom_from_base) const;

 private:
  struct View {
    double time_s = 0.0;
    TPose2D odom_from_base;
    std::vector<ScanPoint> scan;
  };
  std::deque<View> views_;
};

}  // namespace rovigo::slam
