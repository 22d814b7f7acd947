#include "slam/features.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>

namespace rovigo::slam {

namespace {

constexpr int kBorderPx = 19;  // the descriptor's patch, rotated, must stay inside the level
constexpr int kCellPx = 36;    // part of a level that competes for the best corner
// What makes a corner lies on FAST's circle or within it; depth edges are torn by a pixel more.
constexpr double kCornerReachPx = 4.0;

struct Corner {
  cv::Point2f place;  ///< on its level
  float response = 0;
  int rank = 0;  ///< within its cell: 0 is the best
};

/// Corners of a level; parts that show none are searched again with the weak threshold.
std::vector<Corner> corners_of_level(const cv::Mat& level, const FeatureConfig& config) {
  const int columns = std::max(1, (level.cols - 2 * kBorderPx) / kCellPx);
  const int rows = std::max(1, (level.rows - 2 * kBorderPx) / kCellPx);
  const double cell_w = static_cast<double>(level.cols - 2 * kBorderPx) / columns;
  const double cell_h = static_cast<double>(level.rows - 2 * kBorderPx) / rows;
  std::vector<std::vector<Corner>> cells(static_cast<std::size_t>(columns) *
                                         static_cast<std::size_t>(rows));
  const auto add = [&](const cv::KeyPoint& k, const cv::Point2f& offset) {
    const cv::Point2f p = k.pt + offset;
    const double x = p.x - kBorderPx, y = p.y - kBorderPx;
    if (x < 0 || y < 0 || p.x >= level.cols - kBorderPx || p.y >= level.rows - kBorderPx) return;
    const int c = std::min(columns - 1, static_cast<int>(x / cell_w));
    const int r = std::min(rows - 1, static_cast<int>(y / cell_h));
    cells[static_cast<std::size_t>(r * columns + c)].push_back({p, k.response, 0});
  };

  std::vector<cv::KeyPoint> found;
  cv::FAST(level, found, config.corner_threshold, true);
  for (const cv::KeyPoint& k : found) add(k, {0, 0});
  for (int r = 0; r < rows; ++r) {
    for (int c = 0; c < columns; ++c) {
      if (!cells[static_cast<std::size_t>(r * columns + c)].empty()) continue;
      const cv::Rect area(kBorderPx + static_cast<int>(c * cell_w) - 3,
                          kBorderPx + static_cast<int>(r * cell_h) - 3,
                          static_cast<int>(cell_w) + 6, static_cast<int>(cell_h) + 6);
      found.clear();
      cv::FAST(level(area & cv::Rect(0, 0, level.cols, level.rows)), found,
               config.weak_corner_threshold, true);
      for (const cv::KeyPoint& k : found) add(k, cv::Point2f(area.tl()));
    }
  }

  std::vector<Corner> corners;
  for (auto& cell : cells) {
    // A total order, so that equal responses never depend on the sort's inner workings.
    std::sort(cell.begin(), cell.end(), [](const Corner& a, const Corner& b) {
      if (a.response != b.response) return a.response > b.response;
      if (a.place.y != b.place.y) return a.place.y < b.place.y;
      return a.place.x < b.place.x;
    });
    for (std::size_t i = 0; i < cell.size(); ++i) {
      cell[i].rank = static_cast<int>(i);
      corners.push_back(cell[i]);
    }
  }
  return corners;
}

/// The best `quota` corners, each cell's best before any cell's second best.
void keep_best(std::vector<Corner>& corners, std::size_t quota) {
  std::sort(corners.begin(), corners.end(), [](const Corner& a, const Corner& b) {
    if (a.rank != b.rank) return a.rank < b.rank;
    if (a.response != b.response) return a.response > b.response;
    if (a.place.y != b.place.y) return a.place.y < b.place.y;
    return a.place.x < b.place.x;
  });
  if (corners.size() > quota) corners.resize(quota);
}

/// Half width of a disc of radius 15 at each row.
const std::array<int, 16>& disc_half_widths() {
  static const std::array<int, 16> widths = [] {
    std::array<int, 16> w{};
    for (int v = 0; v <= 15; ++v) {
      w[static_cast<std::size_t>(v)] = static_cast<int>(std::lround(std::sqrt(15.0 * 15 - v * v)));
    }
    return w;
  }();
  return widths;
}

/// Direction from a corner to the centroid of the grey values around it (Rosin 1999).
float orientation(const cv::Mat& level, const cv::Point2f& place) {
  const int cx = static_cast<int>(std::lround(place.x));
  const int cy = static_cast<int>(std::lround(place.y));
  int m10 = 0, m01 = 0;
  for (int v = -15; v <= 15; ++v) {
    const int half = disc_half_widths()[static_cast<std::size_t>(std::abs(v))];
    const std::uint8_t* row = level.ptr<std::uint8_t>(cy + v) + cx;
    int sum = 0;
    for (int u = -half; u <= half; ++u) {
      sum += row[u];
      m10 += u * row[u];
    }
    m01 += v * sum;
  }
  return std::atan2(static_cast<float>(m01), static_cast<float>(m10));
}

/// Share of the features that each level gets: by its area.
std::vector<std::size_t> level_quotas(const FeatureConfig& config) {
  std::vector<double> share;
  double total = 0.0;
  for (int l = 0; l < config.pyramid_levels; ++l) {
    share.push_back(1.0 / octave_scale(l, config));
    total += share.back();
  }
  std::vector<std::size_t> quotas;
  for (const double s : share) {
    quotas.push_back(static_cast<std::size_t>(std::lround(config.features_per_frame * s / total)));
  }
  return quotas;
}

/// Size of a level of the pyramid in whole pixels, as cv::ORB makes it.
cv::Size level_size(const cv::Size& full, int octave, const FeatureConfig& config) {
  const double scale = octave_scale(octave, config);
  return {static_cast<int>(std::lround(full.width / scale)),
          static_cast<int>(std::lround(full.height / scale))};
}

/// A corner's place on the full-size image. Levels are whole pixels wide, so that they shrink by a
/// little more or less than their nominal scale; shrinking maps outer edges to outer edges.
Eigen::Vector2d on_full_image(const cv::KeyPoint& k, const cv::Size& full,
                              const FeatureConfig& config) {
  const double nominal = octave_scale(k.octave, config);
  const cv::Size level = level_size(full, k.octave, config);
  return {(k.pt.x / nominal + 0.5) * full.width / level.width - 0.5,
          (k.pt.y / nominal + 0.5) * full.height / level.height - 0.5};
}

std::vector<cv::KeyPoint> find_keypoints(const cv::Mat& gray, const FeatureConfig& config) {
  const std::vector<std::size_t> quotas = level_quotas(config);
  std::vector<cv::KeyPoint> keypoints;
  cv::Mat level = gray;
  for (int l = 0; l < config.pyramid_levels; ++l) {
    const double scale = octave_scale(l, config);
    if (l > 0) {
      cv::Mat smaller;
      const cv::Size size = level_size(gray.size(), l, config);
      if (size.width < 3 * kBorderPx || size.height < 3 * kBorderPx) break;
      cv::resize(level, smaller, size, 0, 0, cv::INTER_LINEAR);
      level = smaller;
    }
    std::vector<Corner> corners = corners_of_level(level, config);
    keep_best(corners, quotas[static_cast<std::size_t>(l)]);
    for (const Corner& c : corners) {
      const float angle = orientation(level, c.place);
      keypoints.emplace_back(c.place * static_cast<float>(scale), 31.0f * static_cast<float>(scale),
                             static_cast<float>(angle * 180.0 / CV_PI), c.response, l);
    }
  }
  return keypoints;
}

}  // namespace

FeatureSet::FeatureSet(std::vector<Feature> features, std::vector<Descriptor> descriptors,
                       int width, int height)
    : columns_(std::max(1, (width + kCellPx - 1) / kCellPx)),
      rows_(std::max(1, (height + kCellPx - 1) / kCellPx)),
      features_(std::move(features)),
      descriptors_(std::move(descriptors)) {
  const auto cell_of = [&](const Feature& f) {
    const int c = std::clamp(static_cast<int>(f.pixel.x()) / kCellPx, 0, columns_ - 1);
    const int r = std::clamp(static_cast<int>(f.pixel.y()) / kCellPx, 0, rows_ - 1);
    return static_cast<std::size_t>(r * columns_ + c);
  };
  cell_start_.assign(static_cast<std::size_t>(columns_ * rows_) + 1, 0);
  for (const Feature& f : features_) ++cell_start_[cell_of(f) + 1];
  for (std::size_t i = 1; i < cell_start_.size(); ++i) cell_start_[i] += cell_start_[i - 1];
  cell_items_.resize(features_.size());
  std::vector<int> next(cell_start_.begin(), cell_start_.end() - 1);
  for (std::size_t i = 0; i < features_.size(); ++i) {
    cell_items_[static_cast<std::size_t>(next[cell_of(features_[i])]++)] = static_cast<int>(i);
  }
}

void FeatureSet::near(const Eigen::Vector2d& pixel, double radius_px, std::vector<int>& out) const {
  if (features_.empty()) return;
  const auto cell = [](double v, int limit) {
    return std::clamp(static_cast<int>(std::floor(v / kCellPx)), 0, limit - 1);
  };
  const int c0 = cell(pixel.x() - radius_px, columns_), c1 = cell(pixel.x() + radius_px, columns_);
  const int r0 = cell(pixel.y() - radius_px, rows_), r1 = cell(pixel.y() + radius_px, rows_);
  for (int r = r0; r <= r1; ++r) {
    const int first = cell_start_[static_cast<std::size_t>(r * columns_ + c0)];
    const int last = cell_start_[static_cast<std::size_t>(r * columns_ + c1) + 1];
    for (int k = first; k < last; ++k) {
      const int i = cell_items_[static_cast<std::size_t>(k)];
      const Eigen::Vector2f& p = features_[static_cast<std::size_t>(i)].pixel;
      if (std::abs(p.x() - pixel.x()) <= radius_px && std::abs(p.y() - pixel.y()) <= radius_px) {
        out.push_back(i);
      }
    }
  }
}

double octave_scale(int octave, const FeatureConfig& config) {
  return std::pow(config.pyramid_scale, octave);
}

FeatureSet extract_features(const CameraFrame& frame, const CameraModel& camera,
                            const FeatureConfig& config, const DepthConfig& depth,
                            const RollingShutter& shutter, const std::optional<FloorDepth>& floor) {
  std::vector<cv::KeyPoint> keypoints = find_keypoints(frame.gray, config);
  const auto orb =
      cv::ORB::create(config.features_per_frame, static_cast<float>(config.pyramid_scale),
                      config.pyramid_levels, kBorderPx, 0, 2, cv::ORB::FAST_SCORE, 31);
  cv::Mat bits;
  orb->compute(frame.gray, keypoints, bits);

  std::vector<Feature> features;
  std::vector<Descriptor> descriptors;
  features.reserve(keypoints.size());
  descriptors.reserve(keypoints.size());
  for (std::size_t i = 0; i < keypoints.size(); ++i) {
    const cv::KeyPoint& k = keypoints[i];
    const Eigen::Vector2d raw = on_full_image(k, frame.gray.size(), config);
    const double reach_px = kCornerReachPx * octave_scale(k.octave, config);
    if (frame.is_beside_nearer(raw, reach_px, depth)) continue;
    Feature f;
    f.pixel = at_middle_row(camera.undistort(raw), raw.y(), camera, shutter).cast<float>();
    f.angle_rad = static_cast<float>(k.angle * CV_PI / 180.0);
    f.depth_m = static_cast<float>(floor ? floor->at(raw) : frame.depth_at(raw, depth));
    f.octave = static_cast<std::uint8_t>(k.octave);
    features.push_back(f);
    Descriptor d;
    std::memcpy(d.data(), bits.ptr<std::uint8_t>(static_cast<int>(i)), sizeof d);
    descriptors.push_back(d);
  }
  FeatureSet set(std::move(features), std::move(descriptors), camera.width(), camera.height());
  if (floor) set.set_floor_roughness(floor->roughness());
  return set;
}

}  // namespace rovigo::slam
