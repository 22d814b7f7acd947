#pragma once
// Does a view fit the map as well from somewhere else over the floor? Walls repeat themselves,
// brick by brick and panel by panel; RANSAC takes one of the places, this shows them all.

#include <vector>

#include "slam/landmark_map.h"

namespace rovigo::slam {

/// A place beside the one asked about, at the same heading.
struct Slide {
  Eigen::Vector2d shift_map = Eigen::Vector2d::Zero();  ///< metres, from the place asked about
  int features = 0;  ///< of the view, those that look like a landmark just where they would be
};

/// What the view says about a place and those beside it.
struct SlideSpectrum {
  int here = 0;                  ///< features that speak for the place asked about
  std::vector<Slide> elsewhere;  /// the best others, most features first, apart from one another
  int best() const { return elsewhere.empty() ? here : std::max(here, elsewhere[0].features); }
};

/// Correlates a view's features with the landmarks that stand upright (Hough's vote over shifts of
/// the floor): heights and heading are known, so that every look-alike pair names one shift.
class ViewSlide {
 public:
  explicit ViewSlide(const LandmarkMap& map);  ///< must outlive this and stay as it is

  /// `features` with depth; shifts of up to kReachM along each axis of the map.
  SlideSpectrum around(const FeatureSet& features, const Se3& map_from_base) const;

  static constexpr double kReachM = 4.5;
  static constexpr double kHereM = 0.10;  ///< a shift within it is the place itself

 private:
  struct Upright {
    double height_m = 0.0;
    int landmark = -1;
  };
  const LandmarkMap& map_;
  std::vector<Upright> upright_;  ///< by height
};

}  // namespace rovigo::slam
