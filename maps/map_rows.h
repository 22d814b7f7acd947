#pragma once
// The tables of the map file, one struct for each: its columns are named once, in describe(), and
// serve the schema, the writer, the reader and the checksums alike. Internal to the map file.

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "maps/map_file.h"

namespace rovigo::maps::detail {

/// x, y, z in metres, then the rotation matrix row by row: comes back bit for bit.
using PoseNumbers = std::array<double, 12>;
/// x, y in metres, yaw in radians.
using Pose2DNumbers = std::array<double, 3>;

void describe_pose(auto& row, auto& pose) {
  static constexpr std::array<const char*, 12> kNames = {"x_m", "y_m", "z_m", "r11", "r12", "r13",
                                                         "r21", "r22", "r23", "r31", "r32", "r33"};
  for (std::size_t i = 0; i < kNames.size(); ++i) row.real(kNames[i], pose[i]);
}

void describe_pose_2d(auto& row, auto& pose) {
  row.real("x_m", pose[0]);
  row.real("y_m", pose[1]);
  row.real("yaw_rad", pose[2]);
}

// In each struct: kTable is the table's name, describe() goes through its columns in order (`self`
// is const when writing), problem() says in a few words why the values cannot be, empty if they
// can.

/// One row: who wrote the file, and how many rows each other table must have.
struct MapRow {
  static constexpr const char* kTable = "map";
  std::string software_version;
  std::string recording;
  std::int64_t keyframes = 0;
  std::int64_t edges = 0;
  std::int64_t trajectory = 0;
  std::int64_t places = 0;
  std::int64_t zones = 0;
  std::int64_t simulation = 0;

  static void describe(auto& row, auto& self) {
    row.text("software_version", self.software_version);
    row.text("recording", self.recording);
    row.integer("keyframes", self.keyframes);
    row.integer("edges", self.edges);
    row.integer("trajectory", self.trajectory);
    row.integer("places", self.places);
    row.integer("zones", self.zones);
    row.integer("simulation", self.simulation);
  }
  std::string problem() const;
};

/// One row: intrinsics and extrinsics.
struct CameraRow {
  static constexpr const char* kTable = "camera";
  std::int64_t width_px = 0;
  std::int64_t height_px = 0;
  double fx_px = 0.0;
  double fy_px = 0.0;
  double cx_px = 0.0;
  double cy_px = 0.0;
  std::string distortion_model;  ///< none, plumb_bob, kannala_brandt
  Blob distortion;               ///< 8 doubles
  double focal_length_m = 0.0;
  std::string name;
  PoseNumbers base_from_camera{};

  static void describe(auto& row, auto& self) {
    row.integer("width_px", self.width_px);
    row.integer("height_px", self.height_px);
    row.real("fx_px", self.fx_px);
    row.real("fy_px", self.fy_px);
    row.real("cx_px", self.cx_px);
    row.real("cy_px", self.cy_px);
    row.text("distortion_model", self.distortion_model);
    row.blob("distortion", self.distortion);
    row.real("focal_length_m", self.focal_length_m);
    row.text("name", self.name);
    describe_pose(row, self.base_from_camera);
  }
  std::string problem() const;
};

/// One row where the recording was simulated, else none.
struct SimulationRow {
  static constexpr const char* kTable = "simulation";
  std::string world;
  std::string seed;  ///< decimal; SQLite's integers are signed
  Pose2DNumbers world_from_map{};

  static void describe(auto& row, auto& self) {
    row.text("world", self.world);
    row.text("seed", self.seed);
    describe_pose_2d(row, self.world_from_map);
  }
  std::string problem() const;
};

/// One row: the occupancy grid.
struct GridRow {
  static constexpr const char* kTable = "grid";
  double resolution_m = 0.0;
  double origin_x_m = 0.0;
  double origin_y_m = 0.0;
  std::int64_t width = 0;
  std::int64_t height = 0;
  Blob cells;  ///< int8, row-major from the lower-left corner

  static void describe(auto& row, auto& self) {
    row.real("resolution_m", self.resolution_m);
    row.real("origin_x_m", self.origin_x_m);
    row.real("origin_y_m", self.origin_y_m);
    row.integer("width", self.width);
    row.integer("height", self.height);
    row.blob("cells", self.cells);
  }
  std::string problem() const;
};

struct KeyframeRow {
  static constexpr const char* kTable = "keyframes";
  std::int64_t id = 0;
  double time_s = 0.0;
  PoseNumbers map_from_base{};
  Blob color_jpeg;
  Blob depth_png;
  Blob features;

  static void describe(auto& row, auto& self) {
    row.integer("id", self.id);
    row.real("time_s", self.time_s);
    describe_pose(row, self.map_from_base);
    row.blob("color_jpeg", self.color_jpeg);
    row.blob("depth_png", self.depth_png);
    row.blob("features", self.features);
  }
  std::string problem() const;
};

struct EdgeRow {
  static constexpr const char* kTable = "edges";
  std::int64_t from_id = 0;
  std::int64_t to_id = 0;
  std::int64_t kind = 0;  ///< StoredEdge::Kind
  PoseNumbers from_from_to{};
  Blob information;  ///< 36 doubles, row by row

  static void describe(auto& row, auto& self) {
    row.integer("from_id", self.from_id);
    row.integer("to_id", self.to_id);
    row.integer("kind", self.kind);
    describe_pose(row, self.from_from_to);
    row.blob("information", self.information);
  }
  std::string problem() const;
};

struct TrajectoryRow {
  static constexpr const char* kTable = "trajectory";
  double time_s = 0.0;
  PoseNumbers map_from_base{};
  std::int64_t is_camera_frame = 0;

  static void describe(auto& row, auto& self) {
    row.real("time_s", self.time_s);
    describe_pose(row, self.map_from_base);
    row.integer("is_camera_frame", self.is_camera_frame);
  }
  std::string problem() const;
};

struct PlaceRow {
  static constexpr const char* kTable = "places";
  std::string name;
  Pose2DNumbers pose{};

  static void describe(auto& row, auto& self) {
    row.text("name", self.name);
    describe_pose_2d(row, self.pose);
  }
  std::string problem() const;
};

struct ZoneRow {
  static constexpr const char* kTable = "zones";
  std::string name;
  Blob corners;  ///< pairs of doubles: x, y in metres

  static void describe(auto& row, auto& self) {
    row.text("name", self.name);
    row.blob("corners", self.corners);
  }
  std::string problem() const;
};

// To and from the structs of the interface. restore() expects rows without a problem().
MapRow map_row(const SavedMap& map);
CameraRow camera_row(const MapMetadata& metadata);
SimulationRow simulation_row(const SimulationOrigin& origin);
GridRow grid_row(const OccupancyGrid& grid);
KeyframeRow keyframe_row(const StoredKeyframe& keyframe);
EdgeRow edge_row(const StoredEdge& edge);
TrajectoryRow trajectory_row(const StoredPose& pose);
PlaceRow place_row(const NamedPlace& place);
ZoneRow zone_row(const NoGoZone& zone);

void restore(const CameraRow& row, MapMetadata& metadata);
SimulationOrigin restore(const SimulationRow& row);
OccupancyGrid restore(const GridRow& row);
StoredKeyframe restore(KeyframeRow&& row);
StoredEdge restore(const EdgeRow& row);
StoredPose restore(const TrajectoryRow& row);
NamedPlace restore(const PlaceRow& row);
NoGoZone restore(const ZoneRow& row);

}  // namespace rovigo::maps::detail
