#include "slam/local_scan.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace rovigo::slam {

namespace {

constexpr double kStepM = 0.15, kStepRad = 0.12;  // a third of the view is new, or nearly
constexpr std::size_t kMostViews = 60;            // a full turn and some metres
constexpr double kOldestS = 20.0;                 // an uncalibrated gyro turns a degree or two
constexpr double kCellM = 0.10;

}  // namespace

bool LocalScan::add(double time_s, const TPose2D& odom_from_base,
                    const std::vector<ScanPoint>& scan, bool jumped) {
  if (!views_.empty() && !jumped) {
    const TPose2D& last = views_.back().odom_from_base;
    const bool moved =
        maps::distance(maps::position_of(last), maps::position_of(odom_from_base)) > kStepM ||
        std::abs(maps::wrap_angle(odom_from_base.phi - last.phi)) > kStepRad;
    if (!moved) return false;
  }
  views_.push_back({time_s, odom_from_base, scan});
  while (views_.size() > kMostViews || time_s - views_.front().time_s > kOldestS) {
    views_.pop_front();
  }
  return true;
}

void LocalScan::forget_before(double time_s) {
  while (!views_.empty() && views_.front().time_s < time_s) views_.pop_front();
}

std::vector<ScanPoint> LocalScan::points(const TPose2D& odom_from_base) const {
  std::map<std::pair<int, int>, ScanPoint> by_cell;
  const TPose2D base_from_odom = maps::inverse(odom_from_base);
  for (const View& view : views_) {
    const TPose2D base_from_view = maps::compose(base_from_odom, view.odom_from_base);
    for (const ScanPoint& p : view.scan) {
      const TPoint2D at = maps::transform(base_from_view, p.base_point);
      const std::pair cell{static_cast<int>(std::floor(at.x / kCellM)),
                           static_cast<int>(std::floor(at.y / kCellM))};
      const ScanPoint point{at, p.sigma_m};
      const auto [it, is_new] = by_cell.try_emplace(cell, point);
      if (!is_new && p.sigma_m < it->second.sigma_m) it->second = point;
    }
  }
  std::vector<ScanPoint> out;
  out.reserve(by_cell.size());
  for (const auto& [cell, p] : by_cell) out.push_back(p);
  return out;
}

}  // namespace rovigo::slam
