#include "maps/ros_map.h"

#include <yaml-cpp/yaml.h>

#include <charconv>
#include <cmath>

#include "maps/atomic_file.h"
#include "maps/error.h"

namespace rovigo::maps {
namespace {

constexpr std::size_t kMaxYamlBytes = 1 << 20;
constexpr std::size_t kMaxImageBytes = std::size_t{1} << 30;
constexpr std::uint8_t kFreePixel = 254;
constexpr std::uint8_t kOccupiedPixel = 0;
constexpr std::uint8_t kUnknownPixel = 205;

/// The keys of one YAML file, with errors that name file, line and key.
class HeaderReader {
 public:
  HeaderReader(const YAML::Node& root, const std::string& name) : root_(root), name_(name) {}

  [[noreturn]] void fail(const std::string& why) const { throw InputError(name_ + ": " + why); }

  YAML::Node at(const char* key) const {
    const YAML::Node node = root_[key];
    if (!node) fail(std::string("the key ") + key + " is missing; map_server maps must have it");
    return node;
  }
  double number(const YAML::Node& node, const char* key, double min, double max) const {
    double value = 0.0;
    const bool reads = node.IsScalar() && YAML::convert<double>::decode(node, value);
    if (reads && std::isfinite(value) && value >= min && value <= max) return value;
    fail("line " + std::to_string(node.Mark().line + 1) + ": " + key + " = \"" +
         (node.IsScalar() ? node.Scalar() : "a list") + "\" is no number in [" + text_of(min) +
         ", " + text_of(max) + "]");
  }
  double number(const char* key, double min, double max) const {
    return number(at(key), key, min, max);
  }
  std::string text(const char* key) const {
    const YAML::Node node = at(key);
    if (!node.IsScalar() || node.Scalar().empty()) fail(std::string(key) + " is no text");
    return node.Scalar();
  }
  /// map_server writes 0 and 1, people write true and false.
  bool flag(const char* key) const {
    const std::string value = text(key);
    if (value == "0" || value == "false" || value == "False") return false;
    if (value == "1" || value == "true" || value == "True") return true;
    fail(std::string(key) + " = \"" + value + "\" is neither 0 nor 1");
  }
  bool has(const char* key) const { return static_cast<bool>(root_[key]); }

  static std::string text_of(double value) {
    char text[32];
    const auto end = std::to_chars(text, text + sizeof text, value).ptr;
    return {text, end};
  }

 private:
  YAML::Node root_;
  const std::string& name_;
};

RosMapHeader::Mode read_mode(const HeaderReader& reader) {
  if (!reader.has("mode")) return RosMapHeader::Mode::kTrinary;
  const std::string mode = reader.text("mode");
  if (mode == "trinary") return RosMapHeader::Mode::kTrinary;
  if (mode == "scale") return RosMapHeader::Mode::kScale;
  if (mode == "raw") return RosMapHeader::Mode::kRaw;
  reader.fail("mode = \"" + mode + "\" is none of trinary, scale, raw");
}

RosMapHeader read_header(const HeaderReader& reader) {
  RosMapHeader header;
  header.image = reader.text("image");
  header.resolution_m = reader.number("resolution", 1e-4, 1e3);
  const YAML::Node origin = reader.at("origin");
  if (!origin.IsSequence() || origin.size() != 3) reader.fail("origin is no list [x, y, yaw]");
  header.origin = {reader.number(origin[0], "origin x", -1e7, 1e7),
                   reader.number(origin[1], "origin y", -1e7, 1e7)};
  const double yaw = reader.number(origin[2], "origin yaw", -10.0, 10.0);
  if (std::abs(yaw) > 1e-9) {
    reader.fail("the map is turned by " + HeaderReader::text_of(yaw) +
                " rad (origin yaw); only maps with yaw 0 can be used, turn the image instead");
  }
  header.negate = reader.flag("negate");
  header.occupied_thresh = reader.number("occupied_thresh", 0.0, 1.0);
  header.free_thresh = reader.number("free_thresh", 0.0, 1.0);
  header.mode = read_mode(reader);
  if (header.free_thresh >= header.occupied_thresh) {
    reader.fail("free_thresh " + HeaderReader::text_of(header.free_thresh) +
                " must be below occupied_thresh " + HeaderReader::text_of(header.occupied_thresh));
  }
  return header;
}

std::int8_t cell_value(const RosMapHeader& header, const GrayImage& image, std::size_t pixel) {
  const int value = image.pixels[pixel];
  if (header.mode == RosMapHeader::Mode::kRaw) {
    return value <= 100 ? static_cast<std::int8_t>(value) : OccupancyGrid::kUnknown;
  }
  const bool scale = header.mode == RosMapHeader::Mode::kScale;
  if (scale && !image.is_opaque.empty() && !image.is_opaque[pixel]) return OccupancyGrid::kUnknown;
  const double white = image.max_value;
  const double p = (header.negate ? value : white - value) / white;
  if (p >= header.occupied_thresh) return OccupancyGrid::kOccupied;
  if (p <= header.free_thresh) return OccupancyGrid::kFree;
  if (!scale) return OccupancyGrid::kUnknown;
  const double share = (p - header.free_thresh) / (header.occupied_thresh - header.free_thresh);
  return static_cast<std::int8_t>(std::lround(100.0 * share));
}

bool turns_unknown_into_free(const RosMapHeader& header, const GrayImage& image) {
  if (header.negate || header.mode == RosMapHeader::Mode::kRaw || image.max_value != 255) {
    return false;
  }
  if (header.free_thresh < (255.0 - kUnknownPixel) / 255.0) return false;
  for (const std::uint16_t v : image.pixels) {
    if (v == kUnknownPixel) return true;
  }
  return false;
}

/// Plain where YAML certainly reads it as the same text, quoted otherwise.
std::string yaml_text(const std::string& text) {
  const bool plain = text.find_first_not_of(
                         "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ"
                         "0123456789._-") == std::string::npos;
  if (plain && std::isalpha(static_cast<unsigned char>(text[0]))) return text;
  YAML::Emitter emitter;
  emitter << YAML::DoubleQuoted << text;
  return emitter.c_str();
}

}  // namespace

RosMapHeader parse_ros_map_yaml(const std::string& text, const std::string& name) {
  try {
    const YAML::Node root = YAML::Load(text);
    if (!root.IsMap()) {
      throw InputError(name + ": is no ROS map; it must hold image, resolution, origin and so on");
    }
    return read_header(HeaderReader(root, name));
  } catch (const YAML::Exception& e) {
    throw InputError(name + ": line " + std::to_string(e.mark.line + 1) +
                     " is no valid YAML: " + e.msg);
  }
}

OccupancyGrid grid_from_ros_image(const RosMapHeader& header, const GrayImage& image,
                                  const std::string& name, std::vector<std::string>& warnings) {
  OccupancyGrid grid({header.resolution_m, header.origin, image.width, image.height});
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    const Cell c = grid.geometry.cell_of(i);
    grid.at({c.x, image.height - 1 - c.y}) = cell_value(header, image, i);
  }
  if (turns_unknown_into_free(header, image)) {
    warnings.push_back(name + ": free_thresh " + HeaderReader::text_of(header.free_thresh) +
                       " makes unknown ground (grey 205) free; 0.196 keeps it unknown");
  }
  return grid;
}

OccupancyGrid load_ros_map(const std::filesystem::path& yaml_path,
                           std::vector<std::string>& warnings) {
  const std::string name = yaml_path.string();
  const RosMapHeader header = parse_ros_map_yaml(read_file(yaml_path, kMaxYamlBytes), name);
  const std::filesystem::path image_path = yaml_path.parent_path() / header.image;
  const GrayImage image =
      decode_gray_image(read_file(image_path, kMaxImageBytes), image_path.string());
  return grid_from_ros_image(header, image, name, warnings);
}

void save_ros_map(const OccupancyGrid& grid, const std::filesystem::path& yaml_path) {
  const GridGeometry& g = grid.geometry;
  const auto image_path = std::filesystem::path(yaml_path).replace_extension(".pgm");
  if (image_path == yaml_path) {
    throw InputError("cannot write " + yaml_path.string() +
                     ": the name of a ROS map's main file must end in .yaml, its image in .pgm");
  }
  std::vector<std::uint8_t> pixels(grid.cells.size());
  for (std::size_t i = 0; i < grid.cells.size(); ++i) {
    const Cell c = g.cell_of(i);
    const std::int8_t value = grid.at({c.x, g.height - 1 - c.y});
    pixels[i] = OccupancyGrid::is_unknown(value)    ? kUnknownPixel
                : OccupancyGrid::is_occupied(value) ? kOccupiedPixel
                                                    : kFreePixel;
  }
  const auto number = HeaderReader::text_of;
  const std::string yaml = "image: " + yaml_text(image_path.filename().string()) +
                           "\nresolution: " + number(g.resolution_m) + "\norigin: [" +
                           number(g.origin.x) + ", " + number(g.origin.y) +
                           ", 0.0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n";
  write_file_atomically(image_path, encode_pgm(g.width, g.height, pixels, "Rovigo"));
  write_file_atomically(yaml_path, yaml);
}

}  // namespace rovigo::maps
