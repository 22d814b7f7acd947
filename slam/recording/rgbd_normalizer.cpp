#include "slam/recording/rgbd_normalizer.h"

#include <cmath>
#include <exception>
#include <filesystem>
#include <opencv2/imgproc.hpp>

#include "slam/recording/images.h"
#include "slam/recording/rig_yaml.h"
#include "slam/rig.h"

namespace rovigo::slam {
namespace {

bool is_file(const std::string& path) {
  std::error_code error;
  return std::filesystem::is_regular_file(path, error);
}

/// Images kept beside the rawlog, brought into memory. The files are looked for first, because
/// MRPT and OpenCV print when one is missing.
std::string load_external_images(mrpt::obs::CObservation3DRangeScan& scan) {
  mrpt::img::CImage& color = scan.intensityImage;
  if (color.isExternallyStored()) {
    const std::string path = color.getExternalStorageFileAbsolutePath();
    if (!is_file(path)) return "the colour image " + path + " is missing";
    color.forceLoad();
    color =
        mrpt::img::CImage(color.asCvMat<cv::Mat>(mrpt::img::DEEP_COPY), mrpt::img::SHALLOW_COPY);
  }
  if (scan.rangeImage_isExternallyStored()) {
    const std::string path = scan.rangeImage_getExternalStorageFileAbsolutePath("");
    if (!is_file(path)) return "the depth image " + path + " is missing";
    scan.points3D_overrideExternalStoredFlag(false);  // not needed, and may be missing
    scan.load();
    scan.rangeImage_forceResetExternalStorage();
  }
  return {};
}

std::string image_problem(const mrpt::obs::CObservation3DRangeScan& scan) {
  if (!scan.hasRangeImage || depth_view(scan).empty()) return "it has no depth image";
  const cv::Mat color = color_view(scan);
  if (color.empty()) return "it has no colour image, or a damaged one";
  if (color.depth() != CV_8U || (color.channels() != 1 && color.channels() != 3)) {
    return "its colour image is neither 8-bit colour nor grey";
  }
  if (!std::isfinite(scan.rangeUnits) || scan.rangeUnits < 1e-6F || scan.rangeUnits > 0.1F) {
    return "its depth unit is outside 0.000001 .. 0.1 m";
  }
  return {};
}

std::string fit_problem(const mrpt::img::TCamera& camera, int columns, int rows,
                        const std::string& which) {
  if (std::string problem = camera_problem(camera); !problem.empty()) {
    return "in the " + which + " camera's calibration, " + problem;
  }
  if (static_cast<int>(camera.ncols) != columns || static_cast<int>(camera.nrows) != rows) {
    return "its " + which + " image is " + std::to_string(columns) + " x " + std::to_string(rows) +
           " pixels where the calibration says " + std::to_string(camera.ncols) + " x " +
           std::to_string(camera.nrows);
  }
  return {};
}

bool is_finite(const mrpt::poses::CPose3D& pose) {
  constexpr double kFarthest_m = 1e6;
  const mrpt::math::TPose3D p = pose.asTPose();
  bool finite = std::isfinite(p.yaw) && std::isfinite(p.pitch) && std::isfinite(p.roll);
  for (const double coordinate : {p.x, p.y, p.z}) {
    finite = finite && std::abs(coordinate) < kFarthest_m;
  }
  return finite;
}

}  // namespace

bool RgbdNormalizer::normalize(mrpt::obs::CObservation3DRangeScan& scan, std::string& problem) {
  try {
    problem = load_external_images(scan);
  } catch (const std::exception&) {
    problem = "an image kept beside the rawlog cannot be read";
  }
  if (problem.empty()) problem = image_problem(scan);
  if (!problem.empty()) return false;
  const cv::Mat color = color_view(scan);
  const cv::Mat depth = depth_view(scan);
  if (scan.cameraParamsIntensity.fx() == 0.0) scan.cameraParamsIntensity = scan.cameraParams;
  problem = fit_problem(scan.cameraParamsIntensity, color.cols, color.rows, "colour");
  if (problem.empty()) problem = fit_problem(scan.cameraParams, depth.cols, depth.rows, "depth");
  if (problem.empty() &&
      !(is_finite(scan.sensorPose) && is_finite(scan.relativePoseIntensityWRTDepth))) {
    problem = "its sensor pose is not finite";
  }
  if (!problem.empty()) return false;
  if (color.channels() == 1) {
    cv::Mat bgr;
    cv::cvtColor(color, bgr, cv::COLOR_GRAY2BGR);
    scan.intensityImage = mrpt::img::CImage(bgr, mrpt::img::SHALLOW_COPY);
  }
  register_depth(scan);
  scan.hasPoints3D = false;
  scan.resizePoints3DVectors(0);
  return true;
}

void RgbdNormalizer::register_depth(mrpt::obs::CObservation3DRangeScan& scan) {
  const bool is_registered = scan.range_is_depth && scan.doDepthAndIntensityCamerasCoincide() &&
                             scan.cameraParams == scan.cameraParamsIntensity;
  if (is_registered) return;
  const mrpt::poses::CPose3D depth_sensor_from_depth = base_from_optical(mrpt::poses::CPose3D());
  RegistrationGeometry geometry;
  geometry.depth = scan.cameraParams;
  geometry.color = scan.cameraParamsIntensity;
  geometry.color_from_depth = -scan.relativePoseIntensityWRTDepth + depth_sensor_from_depth;
  if (!registration_ || !(registration_->geometry() == geometry)) registration_.emplace(geometry);
  scan.rangeImage = registration_->apply(scan.rangeImage, scan.rangeUnits, !scan.range_is_depth);
  scan.range_is_depth = true;
  scan.cameraParams = scan.cameraParamsIntensity;
  scan.sensorPose = base_from_mrpt_sensor(scan.sensorPose + scan.relativePoseIntensityWRTDepth);
  scan.relativePoseIntensityWRTDepth = depth_sensor_from_depth;
}

}  // namespace rovigo::slam
