#include "slam/marker_detector.h"

#include <cmath>
#include <opencv2/aruco.hpp>
#include <opencv2/calib3d.hpp>

namespace rovigo::slam {
namespace {

constexpr double kMostReprojectionPx = 3.0;

mrpt::poses::CPose3D pose_of(const cv::Mat& rotation, const cv::Mat& translation) {
  cv::Mat r;
  cv::Rodrigues(rotation, r);
  mrpt::math::CMatrixDouble44 m;
  m.setIdentity();
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) m(i, j) = r.at<double>(i, j);
    m(i, 3) = translation.at<double>(i);
  }
  return mrpt::poses::CPose3D(m);
}

}  // namespace

std::vector<MarkerSighting> find_markers(const cv::Mat& image, const mrpt::img::TCamera& camera,
                                         double side_m) {
  if (image.empty() || !(side_m > 0.0) || !std::isfinite(side_m)) return {};
  auto parameters = cv::aruco::DetectorParameters::create();
  parameters->cornerRefinementMethod = cv::aruco::CORNER_REFINE_SUBPIX;
  std::vector<int> ids;
  std::vector<std::vector<cv::Point2f>> corners;
  cv::aruco::detectMarkers(image, cv::aruco::getPredefinedDictionary(cv::aruco::DICT_4X4_50),
                           corners, ids, parameters);

  const cv::Matx33d intrinsics(camera.fx(), 0, camera.cx(), 0, camera.fy(), camera.cy(), 0, 0, 1);
  const cv::Matx<double, 5, 1> distortion(camera.dist[0], camera.dist[1], camera.dist[2],
                                          camera.dist[3], camera.dist[4]);
  const auto h = static_cast<float>(side_m / 2.0);
  const std::vector<cv::Point3f> square{{-h, h, 0}, {h, h, 0}, {h, -h, 0}, {-h, -h, 0}};
  std::vector<MarkerSighting> out;
  for (std::size_t i = 0; i < ids.size(); ++i) {
    std::vector<cv::Mat> rotations, translations;
    std::vector<double> errors;  // of each solution, the better one first
    cv::solvePnPGeneric(square, corners[i], intrinsics, distortion, rotations, translations, false,
                        cv::SOLVEPNP_IPPE_SQUARE, cv::noArray(), cv::noArray(), errors);
    if (rotations.empty() || !(errors.front() <= kMostReprojectionPx)) continue;
    out.push_back({ids[i], pose_of(rotations.front(), translations.front()), errors.front(),
                   pose_of(rotations.back(), translations.back()), errors.back()});
  }
  return out;
}

}  // namespace rovigo::slam
