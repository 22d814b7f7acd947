#pragma once
// Occupancy maps as ROS map_server writes and reads them: a YAML file with an image beside it.

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "maps/gray_image.h"
#include "maps/occupancy_grid.h"

namespace rovigo::maps {

/// The YAML file. p = (white - v) / white is the probability of being occupied, or v / white when
/// `negate` is set.
struct RosMapHeader {
  enum class Mode {
    kTrinary,  ///< p >= occupied_thresh: 100; p <= free_thresh: 0; else unknown
    kScale,    ///< between the thresholds 0 .. 100 in proportion; transparent pixels are unknown
    kRaw,      ///< the pixel's value itself; above 100 unknown
  };
  std::string image;  ///< relative to the YAML file
  double resolution_m = 0.0;
  TPoint2D origin;  ///< of the lower-left pixel's lower-left corner
  bool negate = false;
  double occupied_thresh = 0.65;
  double free_thresh = 0.196;
  Mode mode = Mode::kTrinary;
};

/// Reads the YAML text; `name` is used in messages. Throws InputError for missing, malformed or
/// non-finite values and for a turned map (origin yaw other than 0), which a grid cannot hold.
RosMapHeader parse_ros_map_yaml(const std::string& text, const std::string& name);

/// The grid an image means under `header`. When free_thresh turns map_server's own grey for unknown
/// (205) into free, a sentence is added to `warnings`.
OccupancyGrid grid_from_ros_image(const RosMapHeader& header, const GrayImage& image,
                                  const std::string& name, std::vector<std::string>& warnings);

/// Reads a map_server map (PGM or PNG image). Throws InputError naming the file and what is wrong.
OccupancyGrid load_ros_map(const std::filesystem::path& yaml_path,
                           std::vector<std::string>& warnings);

/// Writes `yaml_path` and, beside it, the same name with `.pgm`: trinary, free 254, occupied 0,
/// unknown 205, numbers in full precision. Each file is replaced atomically, the image first.
/// Throws InputError when a file cannot be written.
void save_ros_map(const OccupancyGrid& grid, const std::filesystem::path& yaml_path);

}  // namespace rovigo::maps
