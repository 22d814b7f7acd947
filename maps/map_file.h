#pragma once
// The map file, NAME.rovigo: one SQLite file that holds all a saved map is. Schema: maps/SCHEMA.md.

#include <mrpt/img/TCamera.h>
#include <mrpt/poses/CPose3D.h>

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "maps/occupancy_grid.h"

namespace rovigo::maps {

using Blob = std::vector<std::uint8_t>;

/// A view kept for recognising the place again. Images are encoded; only slam reads `features`.
struct StoredKeyframe {
  int id = 0;
  double time_s = 0.0;  ///< recording time
  mrpt::poses::CPose3D map_from_base;
  Blob color_jpeg;
  Blob depth_png;  ///< 16-bit, 1 mm per unit, 0 = no return; may be a whole fraction of the
                   ///< camera's size
  Blob features;   ///< opaque outside slam
};

/// A relative pose between two keyframes, as the pose graph holds it.
struct StoredEdge {
  enum class Kind { kOdometry = 0, kLoop = 1 };
  int from = 0;
  int to = 0;
  Kind kind = Kind::kOdometry;
  mrpt::poses::CPose3D from_from_to;
  /// Order x, y, z, yaw, pitch, roll (MRPT's), in metres and radians.
  Eigen::Matrix<double, 6, 6> information = Eigen::Matrix<double, 6, 6>::Identity();
};

struct StoredPose {
  double time_s = 0.0;
  mrpt::poses::CPose3D map_from_base;
  bool is_camera_frame = true;  ///< false: dead-reckoned between frames
};

struct NamedPlace {
  std::string name;
  TPose2D pose;
};

/// A polygon, counter-clockwise or not, that no path may enter.
struct NoGoZone {
  std::string name;
  std::vector<TPoint2D> corners;
};

/// Where a simulated recording came from; read only by app's scorer and spawner.
struct SimulationOrigin {
  std::string world;
  std::uint64_t seed = 0;
  TPose2D world_from_map;
};

struct MapMetadata {
  std::string software_version;
  std::string recording;  ///< base name only
  mrpt::img::TCamera camera;
  mrpt::poses::CPose3D base_from_camera;  ///< of the optical frame
  std::optional<SimulationOrigin> simulation;
};

struct SavedMap {
  MapMetadata metadata;
  OccupancyGrid grid;
  std::vector<StoredKeyframe> keyframes;
  std::vector<StoredEdge> edges;
  std::vector<StoredPose> trajectory;
  std::vector<NamedPlace> places;
  std::vector<NoGoZone> zones;
};

/// Writes `map` beside `path`, syncs file and folder, renames: whatever kills the process, the old
/// or the new map opens, whole. Same map, same bytes. Throws InputError when it cannot be written.
void save_map(const SavedMap& map, const std::filesystem::path& path);

/// Reads a map file. Throws InputError that says what is wrong and where: not a map, a newer
/// schema, a failed checksum (table and row), a truncated file.
SavedMap load_map(const std::filesystem::path& path);

/// What of a damaged map file is whole: every table and row that reads and whose checksum holds.
struct RecoveredMap {
  SavedMap map;
  std::vector<std::string> lost;  ///< one sentence for each thing that could not be saved
};
RecoveredMap recover_map(const std::filesystem::path& path);

/// True when the file starts as a Rovigo map does (SQLite with our application id).
bool is_map_file(const std::filesystem::path& path);

/// Anything a map file is accepted for: a `.rovigo`, a ROS map `.yaml`, a MovingAI `.map`. The
/// latter two give a map with a grid and nothing else. Warnings (a free_thresh that turns unknown
/// into free) are added to `warnings`.
SavedMap load_any_map(const std::filesystem::path& path, std::vector<std::string>& warnings);

}  // namespace rovigo::maps
