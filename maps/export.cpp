#include "maps/export.h"

#include <array>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "maps/atomic_file.h"
#include "maps/error.h"
#include "maps/exchange_loader.h"
#include "maps/ros_map.h"
#include "maps/stored_image.h"
#include "maps/view_cloud.h"
#include "maps/zones.h"

namespace rovigo::maps {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::pair<const char*, ExportFormat>, 10> kFormats = {{
    {"ros", ExportFormat::kRos},
    {"png", ExportFormat::kPng},
    {"ply", ExportFormat::kPly},
    {"pcd", ExportFormat::kPcd},
    {"octomap", ExportFormat::kOctomap},
    {"gridmap", ExportFormat::kGridmap},
    {"simplemap", ExportFormat::kSimplemap},
    {"trajectory", ExportFormat::kTrajectory},
    {"geojson", ExportFormat::kGeojson},
    {"keepout", ExportFormat::kKeepout},
}};

// Finer than the pixels of a cloud's cubes, and enough rays for a voxel map.
constexpr int kCloudStride = 2;
constexpr int kOctomapStride = 4;

void require_views(const SavedMap& map, const char* format) {
  for (const StoredKeyframe& k : map.keyframes) {
    if (!k.depth_png.empty()) return;
  }
  throw InputError(std::string("the map keeps no views with depth, which ") + format +
                   " is made of; ros, png, gridmap and geojson need only the grid");
}

void require(const std::string& problem, const fs::path& output) {
  if (!problem.empty()) throw InputError("cannot write " + output.string() + ": " + problem);
}

std::vector<ColoredPoint> whole_cloud(const SavedMap& map, double voxel_m) {
  VoxelFilter filter(voxel_m);
  for (const StoredKeyframe& k : map.keyframes) {
    filter.add(view_points(k, map.metadata, kCloudStride).points);
  }
  return filter.points();
}

void export_cloud(const SavedMap& map, ExportFormat format, const fs::path& output,
                  const ExportConfig& config) {
  const bool ply = format == ExportFormat::kPly;
  require_views(map, ply ? "ply" : "pcd");
  const ExchangePlugin& plugin = load_exchange_plugin(config.plugin_folder);
  const auto cloud = whole_cloud(map, config.cloud_voxel_m);
  if (cloud.empty()) throw InputError("the map's views hold no depth at all: the cloud is empty");
  write_file_atomically(output, [&](const fs::path& file) {
    require((ply ? plugin.write_ply : plugin.write_pcd)(cloud, file.string()), output);
  });
}

void export_octomap(const SavedMap& map, const fs::path& output, const ExportConfig& config) {
  const ExchangePlugin& plugin = load_exchange_plugin(config.plugin_folder);
  write_file_atomically(output, [&](const fs::path& file) {
    if (map.keyframes.empty()) {
      return require(plugin.write_octomap_layer(map.grid, file.string()), output);
    }
    std::size_t i = 0;
    const auto next = [&](ViewPoints& view) {
      if (i == map.keyframes.size()) return false;
      view = view_points(map.keyframes[i++], map.metadata, kOctomapStride);
      return true;
    };
    require(plugin.write_octomap(next, config.octomap_resolution_m, file.string()), output);
  });
}

void export_simplemap(const SavedMap& map, const fs::path& output, const ExportConfig& config) {
  require_views(map, "simplemap");
  const ExchangePlugin& plugin = load_exchange_plugin(config.plugin_folder);
  std::size_t i = 0;
  const auto next = [&](ExchangeView& view) {
    if (i == map.keyframes.size()) return false;
    const StoredKeyframe& k = map.keyframes[i++];
    view = {k.map_from_base, k.time_s, 0, 0, {}, k.color_jpeg};
    if (k.depth_png.empty()) return true;
    // Readers of a simplemap expect depth pixel for pixel over the camera's image.
    const auto& camera = map.metadata.camera;
    cv::Mat depth = decode_depth(k);
    if (camera.ncols > 0 && camera.nrows > 0) {
      cv::resize(depth, depth,
                 cv::Size(static_cast<int>(camera.ncols), static_cast<int>(camera.nrows)), 0, 0,
                 cv::INTER_NEAREST);
    }
    view.width = depth.cols;
    view.height = depth.rows;
    view.depth_mm.assign(depth.begin<std::uint16_t>(), depth.end<std::uint16_t>());
    return true;
  };
  write_file_atomically(output, [&](const fs::path& file) {
    require(plugin.write_simplemap(map.metadata, next, file.string()), output);
  });
}

void export_gridmap(const SavedMap& map, const fs::path& output, const ExportConfig& config) {
  const ExchangePlugin& plugin = load_exchange_plugin(config.plugin_folder);
  write_file_atomically(output, [&](const fs::path& file) {
    require(plugin.write_gridmap(map.grid, file.string()), output);
  });
}

}  // namespace

std::optional<ExportFormat> parse_export_format(const std::string& text) {
  for (const auto& [name, format] : kFormats) {
    if (text == name) return format;
  }
  return std::nullopt;
}

void export_map(const SavedMap& map, ExportFormat format, const fs::path& output,
                const ExportConfig& config) {
  switch (format) {
    case ExportFormat::kRos:
      return save_ros_map(map.grid, output);
    case ExportFormat::kKeepout:
      return save_ros_map(keepout_mask(map.grid.geometry, map.zones), output);
    case ExportFormat::kPng: {
      const Blob png = draw_map_png(map);
      return write_file_atomically(
          output, std::string_view(reinterpret_cast<const char*>(png.data()), png.size()));
    }
    case ExportFormat::kTrajectory:
      return write_file_atomically(output, trajectory_text(map));
    case ExportFormat::kGeojson:
      return write_file_atomically(output, geojson_text(map));
    case ExportFormat::kPly:
    case ExportFormat::kPcd:
      return export_cloud(map, format, output, config);
    case ExportFormat::kOctomap:
      return export_octomap(map, output, config);
    case ExportFormat::kGridmap:
      return export_gridmap(map, output, config);
    case ExportFormat::kSimplemap:
      return export_simplemap(map, output, config);
  }
}

}  // namespace rovigo::maps
