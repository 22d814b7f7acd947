#include "slam/recording/tum_reader.h"

#include <array>
#include <optional>
#include <utility>

#include "maps/atomic_file.h"
#include "maps/error.h"
#include "slam/recording/association.h"
#include "slam/recording/images.h"
#include "slam/recording/rig_yaml.h"
#include "slam/recording/tum_lists.h"
#include "slam/recording/warnings.h"

namespace rovigo::slam {
namespace {

namespace fs = std::filesystem;

constexpr double kAssociation_s = 0.02;        // TUM's associate.py
constexpr float kMetresPerUnit = 1.0F / 5000;  // TUM's depth images
constexpr std::size_t kMaxImageBytes = 64u << 20;

bool is_there(const fs::path& path) {
  std::error_code error;
  return fs::exists(path, error);
}

std::string read_image(const fs::path& path) {
  std::error_code error;
  if (!fs::is_regular_file(path, error)) {  // a pipe would wait for ever
    throw maps::InputError("cannot read " + path.string() + ": there is no such file");
  }
  return maps::read_file(path, kMaxImageBytes);
}

class TumReader final : public RecordingReader {
 public:
  TumReader(fs::path directory, const OpenOptions& options);

  const RecordingInfo& info() const override { return info_; }
  mrpt::obs::CObservation::Ptr next() override;
  double progress() const override;
  int skipped() const override { return skipped_; }
  std::vector<std::string> warnings() const override { return warnings_.sentences(); }

 private:
  void read_lists();
  void read_rig(const OpenOptions& options);
  void require_a_readable_frame() const;
  /// Null, with `problem` set, when an image is missing, damaged or of another size.
  mrpt::obs::CObservation3DRangeScan::Ptr read_frame(const RgbdEntry& frame,
                                                     std::string& problem) const;

  fs::path directory_;
  RecordingInfo info_;
  std::vector<RgbdEntry> frames_;
  std::vector<ImuSample> imu_;
  std::vector<WheelSample> wheels_;
  std::size_t next_frame_ = 0;
  std::size_t next_imu_ = 0;
  std::size_t next_wheel_ = 0;
  int skipped_ = 0;
  WarningList warnings_;
};

TumReader::TumReader(fs::path directory, const OpenOptions& options)
    : directory_(std::move(directory)) {
  const fs::path name = directory_.has_filename() ? directory_ : directory_.parent_path();
  info_.name = fs::absolute(name).lexically_normal().filename().string();
  info_.format = "tum";
  read_lists();
  read_rig(options);
  require_a_readable_frame();
}

void TumReader::read_lists() {
  const fs::path associations = directory_ / "associations.txt";
  if (is_there(associations)) {
    frames_ = read_associations(associations);
  } else if (!is_there(directory_ / "rgb.txt")) {
    throw maps::InputError(directory_.string() +
                           ": not a TUM directory; it has neither rgb.txt nor associations.txt");
  } else {
    const auto color = read_image_list(directory_ / "rgb.txt");
    const auto depth = read_image_list(directory_ / "depth.txt");
    frames_ = associate(color, depth, kAssociation_s);
    if (frames_.empty()) {
      throw maps::InputError(directory_.string() +
                             ": no colour image has a depth image within 0.02 s; check the times "
                             "in rgb.txt and depth.txt");
    }
    if (frames_.size() < color.size()) {
      warnings_.add(std::to_string(color.size() - frames_.size()) + " of " +
                    std::to_string(color.size()) +
                    " colour images have no depth image within 0.02 s and are left out.");
    }
  }
  std::vector<double> differences_s;
  for (const RgbdEntry& frame : frames_) {
    differences_s.push_back(frame.depth_time_s - frame.time_s);
  }
  if (std::string offset = time_offset_warning(std::move(differences_s)); !offset.empty()) {
    warnings_.add(std::move(offset));
  }
  const fs::path imu = directory_ / "imu.txt";
  const fs::path wheels = directory_ / "wheel_odometry.txt";
  if (is_there(imu)) imu_ = read_imu(imu);
  if (is_there(wheels)) wheels_ = read_wheel_odometry(wheels);
}

void TumReader::read_rig(const OpenOptions& options) {
  Rig& rig = info_.rig;
  const fs::path camera_info = directory_ / "camera_info.yaml";
  const fs::path extrinsics = directory_ / "extrinsics.yaml";
  const fs::path simulation = directory_ / "simulation.yaml";
  if (options.camera_info) {
    rig.camera = read_camera_info(*options.camera_info);
  } else if (is_there(camera_info)) {
    rig.camera = read_camera_info(camera_info);
  } else if (const auto camera = tum_camera_by_name(info_.name)) {
    rig.camera = *camera;
    rig.rolling_shutter_s = tum_rolling_shutter_by_name(info_.name);
  } else {
    throw maps::InputError(directory_.string() +
                           ": the camera's calibration is unknown: there is no camera_info.yaml "
                           "and the folder's name is none of TUM's (freiburg1, 2, 3); give "
                           "--camera-info FILE");
  }
  rig.has_extrinsics = is_there(extrinsics);
  rig.base_from_camera =
      rig.has_extrinsics ? read_extrinsics(extrinsics) : base_from_optical(mrpt::poses::CPose3D());
  rig.has_imu = !imu_.empty();
  rig.has_wheels = !wheels_.empty();
  if (is_there(simulation)) info_.simulation = read_simulation(simulation);
}

void TumReader::require_a_readable_frame() const {
  std::string first_problem;
  for (const RgbdEntry& frame : frames_) {
    std::string problem;
    if (read_frame(frame, problem)) return;
    if (first_problem.empty()) first_problem = problem;
  }
  throw maps::InputError(directory_.string() + ": none of its " + std::to_string(frames_.size()) +
                         " camera frames can be read; the first: " + first_problem);
}

mrpt::obs::CObservation3DRangeScan::Ptr TumReader::read_frame(const RgbdEntry& frame,
                                                              std::string& problem) const {
  const Rig& rig = info_.rig;
  auto scan = make_rgbd_observation(frame.time_s, rig, kMetresPerUnit);
  fs::path path = directory_ / frame.color;
  cv::Mat color;
  try {
    color = decode_color(read_image(path), problem);
    if (problem.empty()) {
      path = directory_ / frame.depth;
      decode_depth(read_image(path), scan->rangeImage, problem);
    }
  } catch (const maps::InputError& error) {
    problem = error.what();
    return nullptr;
  }
  const auto columns = static_cast<int>(rig.camera.ncols);
  const auto rows = static_cast<int>(rig.camera.nrows);
  const bool fits = color.cols == columns && color.rows == rows &&
                    scan->rangeImage.cols() == columns && scan->rangeImage.rows() == rows;
  if (problem.empty() && !fits) {
    problem = "not " + std::to_string(columns) + " x " + std::to_string(rows) +
              " pixels, as the camera's calibration says";
  }
  if (!problem.empty()) {
    problem = path.string() + ": " + problem;
    return nullptr;
  }
  scan->hasRangeImage = true;
  scan->hasIntensityImage = true;
  scan->intensityImage = mrpt::img::CImage(color, mrpt::img::SHALLOW_COPY);
  return scan;
}

mrpt::obs::CObservation::Ptr TumReader::next() {
  constexpr double kNever = 1e300;
  while (true) {
    const double wheel_s = next_wheel_ < wheels_.size() ? wheels_[next_wheel_].time_s : kNever;
    const double imu_s = next_imu_ < imu_.size() ? imu_[next_imu_].time_s : kNever;
    const double frame_s = next_frame_ < frames_.size() ? frames_[next_frame_].time_s : kNever;
    // At equal times the frame comes last, so that everything up to it is known.
    if (wheel_s < kNever && wheel_s <= imu_s && wheel_s <= frame_s) {
      std::optional<WheelSample> previous;
      if (next_wheel_ > 0) previous = wheels_[next_wheel_ - 1];
      return make_odometry_observation(wheels_[next_wheel_++], previous);
    }
    if (imu_s < kNever && imu_s <= frame_s) return make_imu_observation(imu_[next_imu_++]);
    if (frame_s == kNever) return nullptr;
    std::string problem;
    if (auto scan = read_frame(frames_[next_frame_++], problem)) return scan;
    ++skipped_;
    warnings_.add("A camera frame is left out: " + problem + ".");
  }
}

double TumReader::progress() const {
  return static_cast<double>(next_frame_) / static_cast<double>(frames_.size());
}

}  // namespace

std::unique_ptr<RecordingReader> open_tum_directory(const fs::path& directory,
                                                    const OpenOptions& options) {
  return std::make_unique<TumReader>(directory, options);
}

}  // namespace rovigo::slam
