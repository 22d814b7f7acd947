#pragma once
// ArUco markers in a camera image, with their poses (mission F4, F8). Detection: Garrido-Jurado et
// al. 2014, through OpenCV; pose: infinitesimal plane-based, Collins & Bartoli 2014.

#include <mrpt/img/TCamera.h>
#include <mrpt/poses/CPose3D.h>

#include <opencv2/core/mat.hpp>
#include <vector>

namespace rovigo::slam {

struct MarkerSighting {
  int id = 0;  ///< of the dictionary 4x4_50
  /// The marker's frame: origin in its middle, x to its right, y up, z out of its face.
  mrpt::poses::CPose3D camera_from_marker;
  double reprojection_rms_px = 0.0;
  /// A square seen nearly face on from afar has two poses that fit about as well: the other one,
  /// mirrored in the line of sight. Near by (50 px and more across) the first is the right one.
  mrpt::poses::CPose3D other_camera_from_marker;
  double other_reprojection_rms_px = 0.0;
};

/// `image`: grey or BGR, 8 bits. `side_m`: of the black square, the same for all markers. Nothing
/// for an empty image, or a side that is no positive number.
std::vector<MarkerSighting> find_markers(const cv::Mat& image, const mrpt::img::TCamera& camera,
                                         double side_m);

}  // namespace rovigo::slam
