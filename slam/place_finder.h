#pragma once
// Where in the map may the rover be? Appearance and the shape of what stands around each propose
// places; every proposal is then judged by both, over several views tied together by odometry.

#include <deque>
#include <optional>
#include <vector>

#include "slam/depth_memory.h"
#include "slam/local_scan.h"
#include "slam/relocalizer.h"
#include "slam/scan_search.h"

namespace rovigo::slam {

/// A place proposed: where the odometry's frame would lie in the map.
struct PlaceCandidate {
  Se3 map_from_odom;
  double recognitions = 0.0;  ///< weights of the views recognised there, older ones fading
  double refutations = 0.0;   ///< how often following it ended in contradiction, fading likewise
  double scan_share = 0.0;    ///< of the local scan, how much fits the grid there
  double surface_share = kUnjudgedShare;  ///< of what keyframes saw there, how much views show

  /// Nobody looked that way: neither for nor against.
  static constexpr double kUnjudgedShare = 0.92;
  double shape() const { return (2.0 * scan_share + surface_share) / 3.0; }
};

/// What speaks for one place, and for the best other one.
struct PlaceSupport {
  double recognitions = 0.0, rival_recognitions = 0.0;
  double scan_share = 1.0, surface_share = 1.0;
  double shape = 1.0, rival_shape = 0.0;  ///< PlaceCandidate::shape()
  int scan_points = 0;
  double rival_recognition_share() const {
    const double all = recognitions + rival_recognitions;
    return all > 0.0 ? rival_recognitions / all : 0.0;
  }
};

class PlaceFinder {
 public:
  /// An empty grid (a camera whose height is not known) leaves appearance alone to judge.
  PlaceFinder(const maps::OccupancyGrid& grid, DepthMemory depths);

  /// A frame's depth image, and its scan in base_link; true if it showed enough new to judge again.
  /// `jumped`: it does not go on from the view before.
  bool see(double time_s, const Se3& odom_from_base, const std::vector<ScanPoint>& scan,
           const cv::Mat& depth, double depth_unit_m, bool jumped);

  /// A view recognised: `weight` 1 for a clear one.
  void recognize(const Se3& map_from_base, const Se3& odom_from_base, double weight);
  /// Following this place has led to what the map does not show.
  void refute(const Se3& map_from_base, const Se3& odom_from_base);
  /// Older recognitions and refutations count less: once a frame.
  void fade();

  /// Searches the whole grid for places that the local scan fits (inside `region`, if given), and
  /// judges all candidates anew.
  void search(const Se3& odom_from_base, const std::optional<PoseRegion>& region);
  /// Judges the candidates there are.
  void judge(const Se3& odom_from_base);

  std::optional<PlaceCandidate> best() const;
  /// Whether that is the place where the rover would be at `map_from_base`.
  bool is_best(const Se3& map_from_base, const Se3& odom_from_base) const;
  PlaceSupport support(const Se3& map_from_base, const Se3& odom_from_base) const;

  /// Forgets every place, and the views before this moment: the rover was carried then.
  void clear_before(double time_s);
  /// Forgets recognitions, not the scan: where views cannot be tied together.
  void forget_candidates() { candidates_.clear(); }

  /// The local scan in base_link of the newest frame.
  const std::vector<ScanPoint>& local_scan() const { return points_; }
  bool has_grid() const { return field_.has_value(); }
  const SignedDistanceField& field() const { return *field_; }

 private:
  struct View {
    double time_s = 0.0;
    Se3 odom_from_base;
    DepthView depth;
  };

  double surface_share(const Se3& map_from_odom) const;
  void propose(const Se3& map_from_odom, const Se3& odom_from_base);
  void refine(PlaceCandidate& candidate, const Se3& odom_from_base) const;
  void tidy(const Se3& odom_from_base);

  std::optional<SignedDistanceField> field_;
  std::optional<ScanSearch> scan_search_;
  DepthMemory depths_;
  std::deque<View> views_;  ///< the newest of the local scan's
  LocalScan local_scan_;
  std::vector<ScanPoint> points_;  ///< of the local scan, in base_link of the newest frame
  std::vector<PlaceCandidate> candidates_;
  bool unsearched_ = false;        ///< the scan is not that of the last search any more
  bool knows_all_rivals_ = false;  ///< a search has been made, and the last one came to its end
};

}  // namespace rovigo::slam
