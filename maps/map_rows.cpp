#include "maps/map_rows.h"

#include <Eigen/LU>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>
#include <span>

namespace rovigo::maps::detail {
namespace {

using mrpt::poses::CPose3D;

static_assert(std::endian::native == std::endian::little,
              "blobs of numbers are written as they lie in memory, little-endian");

constexpr std::size_t kMaxName = 1000;

Blob blob_of(std::span<const double> numbers) {
  Blob blob(numbers.size_bytes());
  if (!blob.empty()) std::memcpy(blob.data(), numbers.data(), blob.size());
  return blob;
}

std::vector<double> doubles_in(const Blob& blob) {
  std::vector<double> numbers(blob.size() / sizeof(double));
  if (!numbers.empty()) std::memcpy(numbers.data(), blob.data(), numbers.size() * sizeof(double));
  return numbers;
}

PoseNumbers numbers_of(const CPose3D& pose) {
  const auto& r = pose.getRotationMatrix();
  return {pose.x(), pose.y(), pose.z(), r(0, 0), r(0, 1), r(0, 2),
          r(1, 0),  r(1, 1),  r(1, 2),  r(2, 0), r(2, 1), r(2, 2)};
}

CPose3D pose_of(const PoseNumbers& n) {
  mrpt::math::CMatrixDouble33 r;
  std::size_t next = 3;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) r(row, column) = n[next++];
  }
  return CPose3D(r, mrpt::math::TPoint3D(n[0], n[1], n[2]));
}

Pose2DNumbers numbers_of(const TPose2D& pose) { return {pose.x, pose.y, pose.phi}; }
TPose2D pose_of(const Pose2DNumbers& n) { return {n[0], n[1], n[2]}; }

bool all_finite(std::span<const double> numbers) {
  for (const double v : numbers) {
    if (!std::isfinite(v)) return false;
  }
  return true;
}

/// Empty for a pose that can be: finite, with a rotation matrix that rotates.
std::string pose_problem(const PoseNumbers& n) {
  if (!all_finite(n)) return "the pose is not finite";
  const Eigen::Matrix3d r =
      Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(n.data() + 3);
  const bool rotates =
      (r * r.transpose() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() < 1e-6 &&
      r.determinant() > 0.0;
  return rotates ? "" : "the pose has no rotation matrix";
}

std::string id_problem(std::int64_t id) {
  return id >= 0 && id <= std::numeric_limits<int>::max() ? "" : "the id is out of range";
}

std::string text_problem(const std::string& text) {
  return text.size() <= kMaxName ? "" : "a text is longer than " + std::to_string(kMaxName);
}

/// The first of several problems.
std::string first_of(std::initializer_list<std::string> problems) {
  for (const std::string& p : problems) {
    if (!p.empty()) return p;
  }
  return {};
}

constexpr std::array<const char*, 3> kDistortionModels = {"none", "plumb_bob", "kannala_brandt"};

int distortion_index(const std::string& name) {
  for (std::size_t i = 0; i < kDistortionModels.size(); ++i) {
    if (name == kDistortionModels[i]) return static_cast<int>(i);
  }
  return -1;
}

}  // namespace

std::string MapRow::problem() const {
  for (const std::int64_t n : {keyframes, edges, trajectory, places, zones}) {
    if (n < 0 || n > 100'000'000) return "a count of rows is out of range";
  }
  if (simulation != 0 && simulation != 1) return "simulation is neither 0 nor 1";
  return first_of({text_problem(software_version), text_problem(recording)});
}

std::string CameraRow::problem() const {
  if (width_px < 0 || height_px < 0 || width_px > 65535 || height_px > 65535) {
    return "the picture size is out of range";
  }
  if (!all_finite(std::array{fx_px, fy_px, cx_px, cy_px, focal_length_m})) {
    return "an intrinsic parameter is not finite";
  }
  if (distortion_index(distortion_model) < 0) return "the distortion model is unknown";
  if (distortion.size() != 8 * sizeof(double) || !all_finite(doubles_in(distortion))) {
    return "the distortion is not 8 finite numbers";
  }
  return first_of({text_problem(name), pose_problem(base_from_camera)});
}

std::string SimulationRow::problem() const {
  std::uint64_t parsed = 0;
  const auto [end, error] = std::from_chars(seed.data(), seed.data() + seed.size(), parsed);
  if (error != std::errc() || end != seed.data() + seed.size()) return "the seed is no number";
  if (!all_finite(world_from_map)) return "the pose is not finite";
  return text_problem(world);
}

std::string GridRow::problem() const {
  if (!(std::isfinite(resolution_m) && resolution_m > 0.0)) return "the resolution is not positive";
  if (!all_finite(std::array{origin_x_m, origin_y_m})) return "the origin is not finite";
  if (width < 0 || height < 0 || width > kMaxGridSide || height > kMaxGridSide) {
    return "a side is not in 0 .. " + std::to_string(kMaxGridSide) + " cells";
  }
  if (cells.size() != static_cast<std::size_t>(width * height)) {
    return std::to_string(cells.size()) + " cells instead of " + std::to_string(width) + " x " +
           std::to_string(height);
  }
  for (const std::uint8_t cell : cells) {
    if (cell > 100 && cell != 255) return "a cell is outside -1 .. 100";
  }
  return {};
}

std::string KeyframeRow::problem() const {
  if (!std::isfinite(time_s)) return "the time is not finite";
  return first_of({id_problem(id), pose_problem(map_from_base)});
}

std::string EdgeRow::problem() const {
  if (kind != 0 && kind != 1) return "the kind is neither 0 (odometry) nor 1 (loop)";
  if (information.size() != 36 * sizeof(double) || !all_finite(doubles_in(information))) {
    return "the information matrix is not 36 finite numbers";
  }
  return first_of({id_problem(from_id), id_problem(to_id), pose_problem(from_from_to)});
}

std::string TrajectoryRow::problem() const {
  if (!std::isfinite(time_s)) return "the time is not finite";
  if (is_camera_frame != 0 && is_camera_frame != 1) return "is_camera_frame is neither 0 nor 1";
  return pose_problem(map_from_base);
}

std::string PlaceRow::problem() const {
  if (!all_finite(pose)) return "the pose is not finite";
  return text_problem(name);
}

std::string ZoneRow::problem() const {
  if (corners.size() % (2 * sizeof(double)) != 0) return "the corners are not pairs of numbers";
  if (!all_finite(doubles_in(corners))) return "a corner is not finite";
  return text_problem(name);
}

MapRow map_row(const SavedMap& map) {
  const auto count = [](const auto& list) { return static_cast<std::int64_t>(list.size()); };
  return {map.metadata.software_version,
          map.metadata.recording,
          count(map.keyframes),
          count(map.edges),
          count(map.trajectory),
          count(map.places),
          count(map.zones),
          map.metadata.simulation.has_value()};
}

CameraRow camera_row(const MapMetadata& metadata) {
  const mrpt::img::TCamera& c = metadata.camera;
  const auto model = static_cast<std::size_t>(c.distortion);
  return {.width_px = c.ncols,
          .height_px = c.nrows,
          .fx_px = c.intrinsicParams(0, 0),
          .fy_px = c.intrinsicParams(1, 1),
          .cx_px = c.intrinsicParams(0, 2),
          .cy_px = c.intrinsicParams(1, 2),
          .distortion_model = model < kDistortionModels.size() ? kDistortionModels[model] : "?",
          .distortion = blob_of(c.dist),
          .focal_length_m = c.focalLengthMeters,
          .name = c.cameraName,
          .base_from_camera = numbers_of(metadata.base_from_camera)};
}

void restore(const CameraRow& row, MapMetadata& metadata) {
  mrpt::img::TCamera& c = metadata.camera;
  c.ncols = static_cast<std::uint32_t>(row.width_px);
  c.nrows = static_cast<std::uint32_t>(row.height_px);
  c.setIntrinsicParamsFromValues(row.fx_px, row.fy_px, row.cx_px, row.cy_px);
  c.distortion = static_cast<mrpt::img::DistortionModel>(distortion_index(row.distortion_model));
  const std::vector<double> distortion = doubles_in(row.distortion);
  std::copy(distortion.begin(), distortion.end(), c.dist.begin());
  c.focalLengthMeters = row.focal_length_m;
  c.cameraName = row.name;
  metadata.base_from_camera = pose_of(row.base_from_camera);
}

SimulationRow simulation_row(const SimulationOrigin& origin) {
  return {origin.world, std::to_string(origin.seed), numbers_of(origin.world_from_map)};
}

SimulationOrigin restore(const SimulationRow& row) {
  SimulationOrigin origin{row.world, 0, pose_of(row.world_from_map)};
  std::from_chars(row.seed.data(), row.seed.data() + row.seed.size(), origin.seed);
  return origin;
}

GridRow grid_row(const OccupancyGrid& grid) {
  const GridGeometry& g = grid.geometry;
  return {g.resolution_m, g.origin.x, g.origin.y,
          g.width,        g.height,   Blob(grid.cells.begin(), grid.cells.end())};
}

OccupancyGrid restore(const GridRow& row) {
  OccupancyGrid grid;
  grid.geometry = {row.resolution_m,
                   {row.origin_x_m, row.origin_y_m},
                   static_cast<int>(row.width),
                   static_cast<int>(row.height)};
  grid.cells.assign(row.cells.begin(), row.cells.end());
  return grid;
}

KeyframeRow keyframe_row(const StoredKeyframe& k) {
  return {k.id, k.time_s, numbers_of(k.map_from_base), k.color_jpeg, k.depth_png, k.features};
}

StoredKeyframe restore(KeyframeRow&& row) {
  return {static_cast<int>(row.id),   row.time_s,
          pose_of(row.map_from_base), std::move(row.color_jpeg),
          std::move(row.depth_png),   std::move(row.features)};
}

EdgeRow edge_row(const StoredEdge& edge) {
  const Eigen::Matrix<double, 6, 6, Eigen::RowMajor> information = edge.information;
  return {edge.from, edge.to, static_cast<std::int64_t>(edge.kind), numbers_of(edge.from_from_to),
          blob_of({information.data(), 36})};
}

StoredEdge restore(const EdgeRow& row) {
  StoredEdge edge;
  edge.from = static_cast<int>(row.from_id);
  edge.to = static_cast<int>(row.to_id);
  edge.kind = static_cast<StoredEdge::Kind>(row.kind);
  edge.from_from_to = pose_of(row.from_from_to);
  const std::vector<double> information = doubles_in(row.information);
  edge.information =
      Eigen::Map<const Eigen::Matrix<double, 6, 6, Eigen::RowMajor>>(information.data());
  return edge;
}

TrajectoryRow trajectory_row(const StoredPose& pose) {
  return {pose.time_s, numbers_of(pose.map_from_base), pose.is_camera_frame};
}

StoredPose restore(const TrajectoryRow& row) {
  return {row.time_s, pose_of(row.map_from_base), row.is_camera_frame != 0};
}

PlaceRow place_row(const NamedPlace& place) { return {place.name, numbers_of(place.pose)}; }
NamedPlace restore(const PlaceRow& row) { return {row.name, pose_of(row.pose)}; }

ZoneRow zone_row(const NoGoZone& zone) {
  std::vector<double> corners;
  for (const TPoint2D& c : zone.corners) {
    corners.push_back(c.x);
    corners.push_back(c.y);
  }
  return {zone.name, blob_of(corners)};
}

NoGoZone restore(const ZoneRow& row) {
  NoGoZone zone{row.name, {}};
  const std::vector<double> corners = doubles_in(row.corners);
  for (std::size_t i = 0; i + 1 < corners.size(); i += 2) {
    zone.corners.emplace_back(corners[i], corners[i + 1]);
  }
  return zone;
}

}  // namespace rovigo::maps::detail
