#include "slam/recording/rig_yaml.h"

#include <yaml-cpp/yaml.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "maps/atomic_file.h"
#include "maps/error.h"
#include "slam/recording/pose_numbers.h"
#include "slam/recording/text_file.h"

namespace rovigo::slam {
namespace {

constexpr std::size_t kMaxYamlBytes = 1u << 20;
constexpr int kMaxSide_px = 8192;
constexpr std::size_t kMaxCoefficients = 8;

/// A YAML mapping with the name of its file, for messages.
class YamlFile {
 public:
  explicit YamlFile(const std::filesystem::path& path) : name_(path.string()) {
    const std::string text = maps::read_file(path, kMaxYamlBytes);
    try {
      root_ = YAML::Load(text);
    } catch (const YAML::Exception& error) {
      throw maps::InputError(name_ + ", line " + std::to_string(error.mark.line + 1) +
                             ": not valid YAML");
    }
    if (!root_.IsMap()) throw maps::InputError(name_ + ": keys and values are expected");
  }

  bool has(const std::string& key) const { return root_[key].IsDefined(); }

  template <class T>
  T get(const std::string& key, const std::string& what) const {
    return convert<T>(root_[key], key, what);
  }

  std::vector<double> numbers(const std::string& key, std::size_t least, std::size_t most) const {
    YAML::Node node = root_[key];
    if (!node.IsDefined()) throw maps::InputError(name_ + ": the key " + key + " is missing");
    if (node.IsMap()) node = node["data"];
    const std::string what = least == most ? "a list of " + std::to_string(least) + " numbers"
                                           : "a list of up to " + std::to_string(most) + " numbers";
    auto values = convert<std::vector<double>>(node, key, what);
    bool fits = values.size() >= least && values.size() <= most;
    for (const double value : values) fits = fits && std::isfinite(value);
    if (!fits) fail(key, what);
    return values;
  }

  [[noreturn]] void fail(const std::string& key, const std::string& what) const {
    throw maps::InputError(name_ + ": " + key + " must be " + what);
  }

 private:
  template <class T>
  T convert(const YAML::Node& node, const std::string& key, const std::string& what) const {
    if (!node.IsDefined()) throw maps::InputError(name_ + ": the key " + key + " is missing");
    try {
      return node.as<T>();
    } catch (const YAML::Exception&) {
      fail(key, what);
    }
  }

  std::string name_;
  YAML::Node root_;
};

mrpt::img::TCamera make_camera(int width, int height, const std::vector<double>& matrix,
                               const std::vector<double>& distortion) {
  mrpt::img::TCamera camera;
  camera.ncols = static_cast<std::uint32_t>(width);
  camera.nrows = static_cast<std::uint32_t>(height);
  camera.setIntrinsicParamsFromValues(matrix[0], matrix[4], matrix[2], matrix[5]);
  bool is_distorted = false;
  for (std::size_t i = 0; i < distortion.size(); ++i) {
    camera.dist[i] = distortion[i];  // MRPT's order is OpenCV's: k1 k2 p1 p2 k3 k4 k5 k6
    is_distorted = is_distorted || distortion[i] != 0.0;
  }
  camera.distortion =
      is_distorted ? mrpt::img::DistortionModel::plumb_bob : mrpt::img::DistortionModel::none;
  return camera;
}

}  // namespace

std::string camera_problem(const mrpt::img::TCamera& camera) {
  if (camera.ncols < 16 || camera.nrows < 16 || camera.ncols > kMaxSide_px ||
      camera.nrows > kMaxSide_px) {
    return "the image size " + std::to_string(camera.ncols) + " x " + std::to_string(camera.nrows) +
           " is outside 16 .. 8192 pixels a side";
  }
  const double focal[2] = {camera.fx(), camera.fy()};
  for (const double f : focal) {
    if (!(f > 1.0) || !(f < 1e5)) {
      return "the focal length " + shortest(f) + " is outside 1 .. 100000 pixels";
    }
  }
  const bool centre_is_inside = camera.cx() >= 0.0 && camera.cx() <= camera.ncols &&
                                camera.cy() >= 0.0 && camera.cy() <= camera.nrows;
  if (!centre_is_inside) {
    return "the principal point (" + shortest(camera.cx()) + ", " + shortest(camera.cy()) +
           ") lies outside the image";
  }
  for (const double k : camera.dist) {
    if (!std::isfinite(k) || std::abs(k) > 1e3) return "a distortion coefficient is out of range";
  }
  return {};
}

mrpt::img::TCamera read_camera_info(const std::filesystem::path& path) {
  const YamlFile file(path);
  const bool is_message = !file.has("camera_matrix");
  const std::string side = is_message ? "" : "image_";
  const std::string whole = "a whole number of pixels";
  const int width = file.get<int>(side + "width", whole);
  const int height = file.get<int>(side + "height", whole);
  if (width < 1 || height < 1) file.fail(side + "width and " + side + "height", "above 0");
  const std::string model_key = "distortion_model";
  if (file.has(model_key)) {
    const auto model = file.get<std::string>(model_key, "a word");
    if (model != "plumb_bob" && model != "rational_polynomial" && model != "none" &&
        !model.empty()) {
      file.fail(model_key, "plumb_bob or rational_polynomial, not " + shown_text(model));
    }
  }
  const std::string lower_k = file.has("k") ? "k" : "K";
  const std::string lower_d = file.has("d") ? "d" : "D";
  const std::string distortion_key = is_message ? lower_d : "distortion_coefficients";
  std::vector<double> distortion;
  if (file.has(distortion_key)) distortion = file.numbers(distortion_key, 0, kMaxCoefficients);
  const auto matrix = file.numbers(is_message ? lower_k : "camera_matrix", 9, 9);
  mrpt::img::TCamera camera = make_camera(width, height, matrix, distortion);
  if (const std::string problem = camera_problem(camera); !problem.empty()) {
    throw maps::InputError(path.string() + ": " + problem);
  }
  return camera;
}

std::string camera_info_text(const mrpt::img::TCamera& camera) {
  const std::string fx = shortest(camera.fx());
  const std::string fy = shortest(camera.fy());
  const std::string cx = shortest(camera.cx());
  const std::string cy = shortest(camera.cy());
  std::string distortion;
  const bool is_rational = camera.dist[5] != 0.0 || camera.dist[6] != 0.0 || camera.dist[7] != 0.0;
  const std::size_t count = is_rational ? kMaxCoefficients : 5;
  for (std::size_t i = 0; i < count; ++i) {
    distortion += (i > 0 ? ", " : "") + shortest(camera.dist[i]);
  }
  return "image_width: " + std::to_string(camera.ncols) +
         "\nimage_height: " + std::to_string(camera.nrows) +
         "\ncamera_name: camera\ncamera_matrix:\n  rows: 3\n  cols: 3\n  data: [" + fx + ", 0, " +
         cx + ", 0, " + fy + ", " + cy +
         ", 0, 0, 1]\ndistortion_model: " + (is_rational ? "rational_polynomial" : "plumb_bob") +
         "\ndistortion_coefficients:\n  rows: 1\n  cols: " + std::to_string(count) + "\n  data: [" +
         distortion +
         "]\nrectification_matrix:\n  rows: 3\n  cols: 3\n  data: [1, 0, 0, 0, 1, 0, 0, 0, 1]\n"
         "projection_matrix:\n  rows: 3\n  cols: 4\n  data: [" +
         fx + ", 0, " + cx + ", 0, 0, " + fy + ", " + cy + ", 0, 0, 0, 1, 0]\n";
}

mrpt::poses::CPose3D read_extrinsics(const std::filesystem::path& path) {
  const YamlFile file(path);
  const auto t = file.numbers("translation", 3, 3);
  const auto q = file.numbers("rotation_xyzw", 4, 4);
  const auto pose = pose_from_numbers({t[0], t[1], t[2], q[0], q[1], q[2], q[3]});
  if (!pose) file.fail("rotation_xyzw", "a quaternion of length 1, and translation below 1e6 m");
  return *pose;
}

std::string extrinsics_text(const mrpt::poses::CPose3D& base_from_camera) {
  const PoseNumbers n = numbers_of(base_from_camera);
  return "# base_from_camera: p_base = R(q) * p_camera + t; the optical frame has z forward\n"
         "translation: [" +
         shortest(n[0]) + ", " + shortest(n[1]) + ", " + shortest(n[2]) + "]\nrotation_xyzw: [" +
         shortest(n[3]) + ", " + shortest(n[4]) + ", " + shortest(n[5]) + ", " + shortest(n[6]) +
         "]\n";
}

maps::SimulationOrigin read_simulation(const std::filesystem::path& path) {
  const YamlFile file(path);
  maps::SimulationOrigin simulation;
  simulation.world = file.get<std::string>("world", "a name");
  simulation.seed = file.get<std::uint64_t>("seed", "a whole number from 0");
  const auto pose = file.numbers("world_from_map", 3, 3);
  simulation.world_from_map = {pose[0], pose[1], pose[2]};
  return simulation;
}

std::string simulation_text(const maps::SimulationOrigin& simulation) {
  YAML::Emitter quoted;
  quoted << YAML::DoubleQuoted << simulation.world;
  const TPose2D& pose = simulation.world_from_map;
  return "world: " + std::string(quoted.c_str()) + "\nseed: " + std::to_string(simulation.seed) +
         "\nworld_from_map: [" + shortest(pose.x) + ", " + shortest(pose.y) + ", " +
         shortest(pose.phi) + "]\n";
}

std::optional<mrpt::img::TCamera> tum_camera_by_name(const std::string& folder) {
  struct Calibration {
    const char* name;
    std::vector<double> matrix;
    std::vector<double> distortion;
  };
  // Published with the TUM RGB-D benchmark (Sturm et al. 2012), colour cameras at 640x480.
  const Calibration known[] = {
      {"freiburg1",
       {517.306408, 0, 318.643040, 0, 516.469215, 255.313989, 0, 0, 1},
       {0.262383, -0.953104, -0.005358, 0.002628, 1.163314}},
      {"freiburg2",
       {520.908620, 0, 325.141442, 0, 521.007327, 249.701764, 0, 0, 1},
       {0.231222, -0.784899, -0.003257, -0.000105, 0.917205}},
      {"freiburg3", {535.4, 0, 320.1, 0, 539.2, 247.6, 0, 0, 1}, {}},
  };
  for (const Calibration& calibration : known) {
    if (folder.find(calibration.name) != std::string::npos) {
      return make_camera(640, 480, calibration.matrix, calibration.distortion);
    }
  }
  return std::nullopt;
}

double tum_rolling_shutter_by_name(const std::string& folder) {
  // The Kinect's colour camera reads its rows in about 26 ms of each thirtieth of a second; on
  // freiburg1_rpy anything from 24 to 30 ms does as well. freiburg3 used another camera.
  constexpr double kKinectReadoutS = 0.026;
  const bool kinect = folder.find("freiburg1") != std::string::npos ||
                      folder.find("freiburg2") != std::string::npos;
  return kinect ? kKinectReadoutS : 0.0;
}

}  // namespace rovigo::slam
