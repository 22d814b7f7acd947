#include "slam/depth_scan.h"

#include <algorithm>
#include <cmath>

namespace rovigo::slam {

namespace {

constexpr int kColumns = 160;          // about so many samples a row, whatever the image's size
constexpr float kUprightRay = 0.05f;   // rays nearly straight up or down say nothing of the floor
constexpr float kFloorM = 0.03f;       // returns from below are the floor's
constexpr float kSilentReachM = 3.0f;  // what stands nearer gives a return

}  // namespace

DepthScanner::DepthScanner(const CameraModel& camera, const DepthConfig& depth)
    : camera_(camera), depth_(depth) {}

void DepthScanner::lay_samples(int cols, int rows) {
  if (cols == cols_ && rows == rows_) return;
  cols_ = cols;
  rows_ = rows;
  samples_.clear();
  const int across = std::max(1, cols / kColumns);
  const int down = std::max(1, across / 2);
  const auto focal = static_cast<float>(camera_.fx() * cols / camera_.width());
  columns_per_rad_ = focal / static_cast<float>(across);
  rows_per_rad_ = focal / static_cast<float>(down);
  // A smaller image's pixels stand for blocks of the camera's.
  const double scale = static_cast<double>(camera_.width()) / cols;
  for (const bool fine : {false, true}) {
    if (fine) fine_from_ = samples_.size();
    for (int v = 0; v < rows; v += down) {
      for (int u = 0; u < cols; u += across) {
        const bool is_coarse = (v / down) % 4 == 0 && (u / across) % 2 == 0;
        if (is_coarse == fine) continue;
        const Eigen::Vector2d raw((u + 0.5) * scale - 0.5, (v + 0.5) * scale - 0.5);
        samples_.push_back({u, v, camera_.unproject(camera_.undistort(raw), 1.0).cast<float>()});
      }
    }
  }
}

DepthScanner::Samples DepthScanner::sample(const cv::Mat& depth) {
  lay_samples(depth.cols, depth.rows);
  Samples out{depth.cols, depth.rows, {}};
  out.depths.reserve(samples_.size());
  for (const Sample& s : samples_) out.depths.push_back(depth.at<std::uint16_t>(s.v, s.u));
  return out;
}

DepthScan DepthScanner::scan(const Samples& samples, double unit_m, const Se3& level_from_camera) {
  lay_samples(samples.cols, samples.rows);
  DepthScan out;
  out.camera = level_from_camera.translation.cast<float>();
  out.columns_per_rad = columns_per_rad_;
  out.rows_per_rad = rows_per_rad_;
  out.rays.reserve(samples_.size());
  const Eigen::Matrix3f rotation = level_from_camera.rotation.cast<float>();
  const auto unit = static_cast<float>(unit_m);
  const auto nearest = static_cast<float>(depth_.min_depth_m);
  const auto farthest = static_cast<float>(depth_.max_depth_m);
  const auto sigma_at_1m = static_cast<float>(depth_.sigma_at_1m_m);
  for (std::size_t i = 0; i < samples_.size(); ++i) {
    if (i == fine_from_) out.fine_from = static_cast<int>(out.rays.size());
    const Sample& s = samples_[i];
    const float z = unit * samples.depths[i];
    if (z < nearest || z > farthest) continue;
    const Eigen::Vector3f d = rotation * s.ray;
    const float across = std::sqrt(d.x() * d.x() + d.y() * d.y());
    if (across < kUprightRay) continue;
    out.rays.push_back({d.x() / across, d.y() / across, d.z() / across, z * across,
                        sigma_at_1m * z * z * across, false});
  }
  if (fine_from_ >= samples_.size()) out.fine_from = static_cast<int>(out.rays.size());
  add_silent(samples, unit, rotation, out);
  return out;
}

/// From the bottom of the image up: the floor nearby gives returns; silence right beyond it is
/// floor as well. Where something else came first, or nothing at all, silence says nothing.
void DepthScanner::add_silent(const Samples& samples, float unit_m, const Eigen::Matrix3f& rotation,
                              DepthScan& scan) const {
  std::vector<bool> on_floor(static_cast<std::size_t>(samples.cols), false);
  for (std::size_t i = samples_.size(); i > fine_from_; --i) {
    const Sample& s = samples_[i - 1];
    const Eigen::Vector3f d = rotation * s.ray;
    const auto column = static_cast<std::size_t>(s.u);
    const float z = unit_m * samples.depths[i - 1];
    if (z > 0.0f) {
      on_floor[column] = scan.camera.z() + z * d.z() < kFloorM;
    } else if (on_floor[column] && d.z() < 0.0f) {
      const float across = std::sqrt(d.x() * d.x() + d.y() * d.y());
      if (across < kUprightRay) continue;
      scan.silent.push_back(
          {d.x() / across, d.y() / across, d.z() / across, kSilentReachM, 0.0f, false});
    }
  }
}

}  // namespace rovigo::slam
