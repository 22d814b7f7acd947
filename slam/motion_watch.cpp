#include "slam/motion_watch.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace rovigo::slam {

namespace {

constexpr int kBlocksAcross = 160;  // of the reduced images
constexpr int kReach = 1;           // blocks around: poses and edges are only so exact
constexpr int kLeastBlocks = 5;     // with returns, of the nine
constexpr std::uint16_t kEmpty = std::numeric_limits<std::uint16_t>::max();  // none at all
// Of the camera's range: farther, that nothing returns says nothing.
constexpr float kShareOfRange = 0.83f;
constexpr double kLeastReturned = 0.2;  // of the blocks of an image
constexpr double kEveryS = 0.3;         // between images kept
constexpr double kLeastApartS = 0.2;
// What moves is told from noise and from errors of the pose by a margin in depth.
constexpr float kMarginM = 0.10f;
constexpr float kSigmas = 4.0f;
// Of a body, whatever the height of obstacles: moving arms tell of feet that rest.
constexpr float kLowestM = 0.05f, kHighestM = 1.6f;
constexpr float kCellM = 0.10f;
constexpr float kFarthestM = 7.0f;
constexpr std::size_t kEveryRay = 2;   // is asked: bodies are larger
constexpr int kMovingRays = 4;         // around a cell; a few are flying pixels
constexpr float kMovingShare = 0.25f;  // of the rays that end around it
constexpr float kBodyRadiusM = 0.45f;

/// Counts over the floor around the camera.
class FloorCells {
 public:
  FloorCells() : counts_(static_cast<std::size_t>(kSide) * kSide, 0) {}
  static bool contains(float x, float y) {
    return std::abs(x) < kFarthestM && std::abs(y) < kFarthestM;
  }
  std::uint16_t& at(float x, float y) { return at(index(x), index(y)); }
  std::uint16_t& at(int x, int y) { return counts_[static_cast<std::size_t>(y * kSide + x)]; }

  static int index(float v) { return static_cast<int>((v + kFarthestM) / kCellM); }

  int around(int x, int y) const {
    int sum = 0;
    for (int v = std::max(0, y - 1); v <= std::min(kSide - 1, y + 1); ++v) {
      for (int u = std::max(0, x - 1); u <= std::min(kSide - 1, x + 1); ++u) {
        sum += counts_[static_cast<std::size_t>(v * kSide + u)];
      }
    }
    return sum;
  }

  static constexpr int kSide = static_cast<int>(2 * kFarthestM / kCellM) + 1;

 private:
  std::vector<std::uint16_t> counts_;
};

Eigen::Vector3f end_of(const ScanRay& ray, const Eigen::Vector3f& camera) {
  return camera + ray.range_m * Eigen::Vector3f(ray.along_x, ray.along_y, ray.slope);
}

/// The cells where enough moves, grown by a body's radius.
FloorCells moving_ground(const FloorCells& moving, const FloorCells& all) {
  constexpr int kGrow = static_cast<int>(kBodyRadiusM / kCellM + 0.01f);
  FloorCells out;
  for (int y = 0; y < FloorCells::kSide; ++y) {
    for (int x = 0; x < FloorCells::kSide; ++x) {
      const int n = moving.around(x, y);
      if (n < kMovingRays ||
          static_cast<float>(n) < kMovingShare * static_cast<float>(all.around(x, y))) {
        continue;
      }
      for (int dy = -kGrow; dy <= kGrow; ++dy) {
        for (int dx = -kGrow; dx <= kGrow; ++dx) {
          const int u = x + dx, v = y + dy;
          if (dx * dx + dy * dy > kGrow * kGrow + kGrow) continue;
          if (u < 0 || v < 0 || u >= FloorCells::kSide || v >= FloorCells::kSide) continue;
          out.at(u, v) = 1;
        }
      }
    }
  }
  return out;
}

}  // namespace

MotionWatch::MotionWatch(const CameraModel& camera, const DepthConfig& depth)
    : camera_(camera), depth_(depth) {}

void MotionWatch::remember(const cv::Mat& depth, double unit_m, const AnchoredView& view) {
  while (!remembered_.empty() && remembered_.front().view.time_s < view.time_s - 2.0 * kHorizonS) {
    remembered_.pop_front();
  }
  if (!remembered_.empty() && view.time_s - remembered_.back().view.time_s < kEveryS) return;
  const int block = std::max(1, depth.cols / kBlocksAcross);
  cv::Mat least(depth.rows / block, depth.cols / block, CV_16UC1, cv::Scalar(kEmpty));
  for (int v = 0; v < least.rows * block; ++v) {
    const auto* from = depth.ptr<std::uint16_t>(v);
    auto* to = least.ptr<std::uint16_t>(v / block);
    for (int u = 0; u < least.cols; ++u) {
      for (int i = 0; i < block; ++i) {
        // A missing return wraps round to the farthest there is.
        const auto z = static_cast<std::uint16_t>(from[u * block + i] - 1U);
        to[u] = std::min(to[u], z);
      }
    }
  }
  const int with_returns = cv::countNonZero(least != kEmpty);
  if (with_returns < kLeastReturned * static_cast<double>(least.total())) return;  // covered
  Remembered out{view, cv::Mat::zeros(least.size(), CV_16UC1)};
  const double to_mm = 1e3 * unit_m;
  for (int v = kReach; v < least.rows - kReach; ++v) {
    for (int u = kReach; u < least.cols - kReach; ++u) {
      std::uint16_t nearest = kEmpty;
      int returns = 0;
      for (int dv = -kReach; dv <= kReach; ++dv) {
        const auto* row = least.ptr<std::uint16_t>(v + dv);
        for (int du = -kReach; du <= kReach; ++du) {
          nearest = std::min(nearest, row[u + du]);
          returns += row[u + du] != kEmpty ? 1 : 0;
        }
      }
      auto& cell = out.nearest_mm.at<std::uint16_t>(v, u);
      if (returns == 0) cell = kEmpty;
      if (returns < kLeastBlocks) continue;
      cell = static_cast<std::uint16_t>(std::min(kEmpty - 1.0, to_mm * (nearest + 1.0)));
    }
  }
  remembered_.push_back(std::move(out));
}

/// The images near enough in time to be of the same scene, far enough for somebody to have moved.
std::vector<MotionWatch::Eye> MotionWatch::eyes_for(const AnchoredView& view,
                                                    const LandmarkMap& map) const {
  std::vector<Eye> out;
  const auto placed = [&](const AnchoredView& v) {
    return from_planar(to_planar(map.keyframe(v.keyframe).map_from_base)) * v.keyframe_from_level;
  };
  const Se3 map_from_level = placed(view);
  for (const Remembered& r : remembered_) {
    const double apart = std::abs(r.view.time_s - view.time_s);
    if (apart < kLeastApartS || apart > kHorizonS) continue;
    const Se3 map_from_camera = placed(r.view) * r.view.level_from_camera;
    const Se3 camera_from_level = map_from_camera.inverse() * map_from_level;
    out.push_back({camera_from_level.rotation.cast<float>(),
                   camera_from_level.translation.cast<float>(), &r.nearest_mm});
  }
  return out;
}

MotionWatch::Verdict MotionWatch::look_at(const Eye& eye, const Eigen::Vector3f& point) const {
  const Eigen::Vector3f p = eye.rotation * point + eye.translation;
  if (p.z() < static_cast<float>(depth_.min_depth_m)) return Verdict::kSilent;
  const Eigen::Vector2d raw = camera_.distort(camera_.project(p.cast<double>()));
  if (!(raw.x() >= 0.0 && raw.y() >= 0.0 && raw.x() < camera_.width() &&
        raw.y() < camera_.height())) {
    return Verdict::kSilent;
  }
  const int u = static_cast<int>(raw.x() * eye.nearest_mm->cols / camera_.width());
  const int v = static_cast<int>(raw.y() * eye.nearest_mm->rows / camera_.height());
  const std::uint16_t nearest_mm = eye.nearest_mm->at<std::uint16_t>(v, u);
  if (nearest_mm == 0) return Verdict::kSilent;
  if (nearest_mm == kEmpty) {
    const bool in_range = p.z() < kShareOfRange * static_cast<float>(depth_.max_depth_m);
    return in_range ? Verdict::kNothingThere : Verdict::kSilent;
  }
  const float nearest = 0.001f * static_cast<float>(nearest_mm);
  const float margin =
      kMarginM + kSigmas * static_cast<float>(depth_.sigma_at_1m_m) * nearest * nearest;
  if (nearest > p.z() + margin) return Verdict::kSeenThrough;
  return nearest < p.z() - margin ? Verdict::kSilent : Verdict::kThere;
}

/// Open ground beyond the range returns nothing; nor do some surfaces at some angles. That they
/// have been seen from elsewhere tells these from who has left.
bool MotionWatch::moves(const std::vector<Eye>& eyes, const Eigen::Vector3f& point) const {
  bool there = false, nothing_there = false;
  for (const Eye& eye : eyes) {
    const Verdict said = look_at(eye, point);
    if (said == Verdict::kSeenThrough) return true;
    there = there || said == Verdict::kThere;
    nothing_there = nothing_there || said == Verdict::kNothingThere;
  }
  return nothing_there && !there;
}

void MotionWatch::mark_moving(const AnchoredView& view, const LandmarkMap& map,
                              DepthScan& scan) const {
  const std::vector<Eye> eyes = eyes_for(view, map);
  if (eyes.empty()) return;
  FloorCells moving, all;
  bool any = false;
  for (std::size_t i = 0; i < scan.rays.size(); i += kEveryRay) {
    const Eigen::Vector3f p = end_of(scan.rays[i], scan.camera);
    if (p.z() < kLowestM || p.z() > kHighestM || !FloorCells::contains(p.x(), p.y())) continue;
    ++all.at(p.x(), p.y());
    if (!moves(eyes, p)) continue;
    ++moving.at(p.x(), p.y());
    any = true;
  }
  if (!any) return;
  FloorCells doubted = moving_ground(moving, all);
  for (ScanRay& ray : scan.rays) {
    const Eigen::Vector3f p = end_of(ray, scan.camera);
    if (FloorCells::contains(p.x(), p.y())) ray.moving = doubted.at(p.x(), p.y()) != 0;
  }
}

std::size_t MotionWatch::memory_bytes() const {
  std::size_t sum = 0;
  for (const Remembered& r : remembered_) sum += r.nearest_mm.total() * r.nearest_mm.elemSize();
  return sum;
}

}  // namespace rovigo::slam
