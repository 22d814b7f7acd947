#include "slam/recording/rig_check.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <opencv2/core.hpp>

#include "slam/recording/images.h"
#include "slam/recording/observations.h"
#include "slam/recording/pose_numbers.h"

namespace rovigo::slam {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kWatched_s = 10.0;
constexpr double kFrameEvery_s = 0.8;
constexpr double kGravity_m_s2 = 9.81;

double degrees(double radians) { return radians * 180.0 / kPi; }

double percentile(std::vector<double> values, double share) {
  const auto at = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + at, values.end());
  return values[static_cast<std::size_t>(at)];
}

/// The lowest level on which a good part of the surfaces that look upwards lies; empty when there
/// is none.
std::optional<double> lowest_level(const std::vector<double>& heights_m) {
  constexpr std::size_t kFewest = 200;
  constexpr double kBin_m = 0.04;
  constexpr double kShare = 0.25;  // of all, within two bins: more than a table's edge
  if (heights_m.size() < kFewest) return std::nullopt;
  std::vector<double> sorted = heights_m;
  std::sort(sorted.begin(), sorted.end());
  const auto enough = static_cast<std::size_t>(kShare * static_cast<double>(sorted.size()));
  for (std::size_t i = 0; i + enough < sorted.size(); ++i) {
    if (sorted[i + enough] - sorted[i] < 2.0 * kBin_m) return sorted[i + enough / 2];
  }
  return std::nullopt;
}

}  // namespace

std::string intrinsics_warning(const mrpt::img::TCamera& camera) {
  const double width = camera.ncols;
  const double height = camera.nrows;
  const double view_rad = 2.0 * std::atan(0.5 * width / camera.fx());
  constexpr double kNarrowest_rad = 20.0 * kPi / 180.0;
  constexpr double kWidest_rad = 150.0 * kPi / 180.0;
  constexpr double kOffCentre = 0.2;
  const std::string begin = "The camera's calibration looks wrong: ";
  const std::string end = "; is it one for another resolution? --camera-info FILE overrides it.";
  if (std::abs(camera.cx() - 0.5 * width) > kOffCentre * width ||
      std::abs(camera.cy() - 0.5 * height) > kOffCentre * height) {
    return begin + "its principal point (" + fixed(camera.cx(), 1) + ", " + fixed(camera.cy(), 1) +
           ") is far from the middle of images of " + std::to_string(camera.ncols) + " x " +
           std::to_string(camera.nrows) + " pixels" + end;
  }
  if (view_rad < kNarrowest_rad || view_rad > kWidest_rad) {
    return begin + "a focal length of " + fixed(camera.fx(), 1) + " pixels would make its view " +
           fixed(degrees(view_rad), 0) + " degrees wide" + end;
  }
  const double ratio = camera.fx() / camera.fy();
  constexpr double kNotSquare = 1.25;
  if (ratio > kNotSquare || ratio < 1.0 / kNotSquare) {
    return begin + "its focal lengths, " + fixed(camera.fx(), 1) + " and " + fixed(camera.fy(), 1) +
           " pixels, differ as those of no RGB-D camera" + end;
  }
  return {};
}

RigCheck::RigCheck(const Rig& rig) : rig_(rig) {}

void RigCheck::add(const mrpt::obs::CObservation& observation) {
  if (is_over_) return;
  const double time_s = seconds_of(observation);
  if (!first_s_) first_s_ = next_frame_s_ = time_s;
  is_over_ = time_s - *first_s_ > kWatched_s;
  if (const auto* scan = dynamic_cast<const mrpt::obs::CObservation3DRangeScan*>(&observation)) {
    if (time_s < next_frame_s_) return;
    next_frame_s_ = time_s + kFrameEvery_s;
    add_frame(*scan);
  } else if (const auto* imu = dynamic_cast<const mrpt::obs::CObservationIMU*>(&observation)) {
    add_imu(*imu);
  }
}

void RigCheck::add_frame(const mrpt::obs::CObservation3DRangeScan& scan) {
  registration_.add(scan);
  const cv::Mat depth = depth_view(scan);
  std::vector<double> depths_m;
  for (int v = 0; v < depth.rows; v += 8) {
    for (int u = 0; u < depth.cols; u += 8) {
      const auto value = depth.at<std::uint16_t>(v, u);
      if (value != 0) depths_m.push_back(value * static_cast<double>(scan.rangeUnits));
    }
  }
  if (depths_m.size() * 8 > depth.total() / 64) {  // a covered lens says nothing
    median_depths_m_.push_back(percentile(depths_m, 0.5));
    near_depths_m_.push_back(percentile(depths_m, 0.95));
  }
  if (rig_.has_extrinsics) look_at_floor(scan);
}

/// Heights of the surfaces that look upwards. Were depth s times too large, a floor would appear
/// at (1 - s) times the camera's height, as flat and level as it is.
void RigCheck::look_at_floor(const mrpt::obs::CObservation3DRangeScan& scan) {
  constexpr int kStep = 6;
  constexpr double kUpwards = 0.95;  // cosine of 18 degrees
  const cv::Mat depth = depth_view(scan);
  const Eigen::Matrix3d rotation = rig_.base_from_camera.getRotationMatrix().asEigen();
  const mrpt::img::TCamera& camera = rig_.camera;
  const auto point = [&](int v, int u) -> Eigen::Vector3d {
    const double z = depth.at<std::uint16_t>(v, u) * static_cast<double>(scan.rangeUnits);
    return rotation * Eigen::Vector3d((u - camera.cx()) / camera.fx() * z,
                                      (v - camera.cy()) / camera.fy() * z, z);
  };
  std::vector<double> heights_m;
  for (int v = 0; v + kStep < depth.rows; v += kStep) {
    for (int u = 0; u + kStep < depth.cols; u += kStep) {
      const bool has_all = depth.at<std::uint16_t>(v, u) != 0 &&
                           depth.at<std::uint16_t>(v + kStep, u) != 0 &&
                           depth.at<std::uint16_t>(v, u + kStep) != 0;
      if (!has_all) continue;
      const Eigen::Vector3d p = point(v, u);
      const Eigen::Vector3d normal = (point(v + kStep, u) - p).cross(point(v, u + kStep) - p);
      if (std::abs(normal.z()) > kUpwards * normal.norm() && p.z() < 0.0) {
        heights_m.push_back(p.z() + rig_.base_from_camera.z());
      }
    }
  }
  if (const auto level = lowest_level(heights_m)) floor_heights_m_.push_back(*level);
}

void RigCheck::add_imu(const mrpt::obs::CObservationIMU& imu) {
  constexpr double kStill_rad_s = 0.06;
  constexpr double kStill_m_s2 = 0.6;
  const auto sample = imu_sample_of(imu);
  if (!sample) return;
  const bool goes_on =
      rest_.samples > 0 && (sample->specific_force_m_s2 - rest_.first).norm() < kStill_m_s2;
  if (sample->angular_rate_rad_s.norm() > kStill_rad_s) {
    rest_ = {};
    return;
  }
  if (!goes_on) {
    rest_ = {};
    rest_.begin_s = sample->time_s;
    rest_.first = sample->specific_force_m_s2;
  }
  rest_.end_s = sample->time_s;
  rest_.sum += sample->specific_force_m_s2;
  ++rest_.samples;
  if (rest_.length_s() > longest_rest_.length_s()) longest_rest_ = rest_;
}

std::vector<std::string> RigCheck::warnings() const {
  std::vector<std::string> all = {intrinsics_warning(rig_.camera)};
  if (const auto shift = registration_.shift_px()) {
    all.push_back("Depth is not registered to colour: its edges lie about " +
                  fixed(std::hypot(shift->x, shift->y), 0) +
                  " pixels beside those of the colour images; record aligned depth, or give the "
                  "transform between the two cameras.");
  }
  all.push_back(depth_scale_warning());
  all.push_back(gravity_warning());
  std::erase(all, std::string());
  return all;
}

std::string RigCheck::depth_scale_warning() const {
  constexpr std::size_t kFewestFrames = 3;
  constexpr double kLowest_m = 0.1;
  const double mount_m = rig_.base_from_camera.z();
  if (rig_.has_extrinsics && mount_m > kLowest_m && floor_heights_m_.size() >= kFewestFrames) {
    const double floor_m = percentile(floor_heights_m_, 0.5);
    const double scale = 1.0 - floor_m / mount_m;
    constexpr double kFactor = 1.4;
    if (scale > 1.0 / kFactor && scale < kFactor) return {};
    return "Depth does not fit the camera's height: it shows the floor " +
           fixed(mount_m - floor_m, 2) + " m below a camera that is mounted at " +
           fixed(mount_m, 2) + " m; is the depth unit wrong by a factor of " +
           fixed(scale > 1.0 ? scale : 1.0 / std::max(scale, 0.01), 1) + ", or the mount?";
  }
  if (median_depths_m_.size() < kFewestFrames) return {};
  constexpr double kFarthest_m = 10.0;
  constexpr double kNearest_m = 0.4;
  const double median_m = percentile(median_depths_m_, 0.5);
  const double near_m = percentile(near_depths_m_, 0.5);
  if (median_m < kFarthest_m && near_m > kNearest_m) return {};
  return "Depth is implausible for an RGB-D camera indoors: half of it is beyond " +
         fixed(median_m, 2) + " m and 5% beyond " + fixed(near_m, 2) +
         " m; is the depth unit wrong?";
}

std::string RigCheck::gravity_warning() const {
  constexpr double kShortest_s = 0.4;
  constexpr int kFewestSamples = 10;
  if (longest_rest_.length_s() < kShortest_s || longest_rest_.samples < kFewestSamples) return {};
  const Eigen::Vector3d force = longest_rest_.sum / longest_rest_.samples;
  constexpr double kTolerance = 0.15;
  if (std::abs(force.norm() - kGravity_m_s2) > kTolerance * kGravity_m_s2) {
    return "The accelerometer shows " + fixed(force.norm(), 2) +
           " m/s^2 at rest where gravity is 9.81; is it in other units, or was gravity removed?";
  }
  // A camera in the hand may be held at a slant; a rover stands level.
  const double allowed_rad = (rig_.has_extrinsics ? 20.0 : 60.0) * kPi / 180.0;
  const double tilt_rad = std::acos(std::clamp(force.z() / force.norm(), -1.0, 1.0));
  if (tilt_rad < allowed_rad) return {};
  return "The IMU's axes are not those of base_link: at rest it feels up at " +
         fixed(degrees(tilt_rad), 0) + " degrees from the z axis, along (" + fixed(force.x(), 1) +
         ", " + fixed(force.y(), 1) + ", " + fixed(force.z(), 1) + ") m/s^2.";
}

}  // namespace rovigo::slam
