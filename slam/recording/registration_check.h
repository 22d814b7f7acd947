#pragma once
// Whether depth images lie on the colour images they came with.

#include <mrpt/obs/CObservation3DRangeScan.h>

#include <opencv2/core/types.hpp>
#include <optional>
#include <vector>

namespace rovigo::slam {

/// Where depth jumps, an object ends, and there the colour usually changes, too. The shift between
/// the two kinds of edges at which they meet most often, over a few frames, is how far depth lies
/// beside colour.
class RegistrationCheck {
 public:
  RegistrationCheck();

  void add(const mrpt::obs::CObservation3DRangeScan& scan);

  /// The shift in pixels of the colour image (depth is to be moved by it), when the frames so far
  /// show clearly that it is one; empty when they lie on each other or nothing can be said.
  std::optional<cv::Point2d> shift_px() const;

 private:
  static constexpr int kReach = 14;  ///< in half pixels' images: 28 pixels
  static constexpr int kSide = 2 * kReach + 1;

  std::vector<double> met_;  ///< colour edge strength summed over depth edges, by shift
  long edges_ = 0;
  int frames_ = 0;
};

}  // namespace rovigo::slam
