#include "slam/recording/rawlog_reader.h"

#include <mrpt/img/CImage.h>
#include <mrpt/obs/CObservationIMU.h>
#include <mrpt/obs/CObservationOdometry.h>

#include <algorithm>
#include <map>
#include <utility>

#include "maps/error.h"
#include "slam/recording/observations.h"
#include "slam/recording/rawlog_stream.h"
#include "slam/recording/rig_yaml.h"

namespace rovigo::slam {
namespace {

namespace fs = std::filesystem;
using mrpt::obs::CObservation;
using mrpt::obs::CObservation3DRangeScan;

/// Puts observations that are a little out of order back into it; at equal times the order of the
/// file stays.
class TimeOrder {
 public:
  bool is_full() const { return waiting_.size() >= kLookAhead; }
  bool empty() const { return waiting_.empty(); }
  void push(CObservation::Ptr observation) {
    waiting_.emplace(observation->timestamp, std::move(observation));  // after its equals
  }
  CObservation::Ptr pop() {
    CObservation::Ptr first = std::move(waiting_.begin()->second);
    waiting_.erase(waiting_.begin());
    return first;
  }

 private:
  static constexpr std::size_t kLookAhead = 12;
  std::multimap<mrpt::Clock::time_point, CObservation::Ptr> waiting_;
};

/// The folder of a rawlog's external images, by MRPT's naming habits. (MRPT's own search loses a
/// slash when the rawlog is given with a folder.)
std::string images_folder(const fs::path& rawlog) {
  std::error_code error;
  const fs::path stem = rawlog.parent_path() / rawlog.stem();
  for (const char* ending : {"_Images", "_images", "_IMAGES"}) {
    const fs::path folder = stem.string() + ending;
    if (fs::is_directory(folder, error)) return (folder / "").string();
  }
  return (rawlog.parent_path() / "Images" / "").string();
}

class RawlogReader final : public RecordingReader {
 public:
  RawlogReader(fs::path path, const OpenOptions& options);

  const RecordingInfo& info() const override { return info_; }
  CObservation::Ptr next() override;
  double progress() const override;
  int skipped() const override { return stream_->skipped_frames(); }
  std::vector<std::string> warnings() const override { return stream_->warnings().sentences(); }

 private:
  void read_ahead(const OpenOptions& options);
  void learn_from_first_frame(const CObservation3DRangeScan& scan, const OpenOptions& options);
  /// False when the frame cannot belong to the rig.
  bool fit_to_rig(CObservation3DRangeScan& scan);

  fs::path path_;
  std::uintmax_t file_bytes_ = 0;
  RecordingInfo info_;
  bool overrides_camera_ = false;
  std::unique_ptr<RawlogStream> stream_;
  TimeOrder order_;
  mrpt::Clock::time_point last_time_{};
};

RawlogReader::RawlogReader(fs::path path, const OpenOptions& options) : path_(std::move(path)) {
  std::error_code error;
  file_bytes_ = fs::file_size(path_, error);
  if (error) throw maps::InputError("cannot read " + path_.string() + ": " + error.message());
  if (file_bytes_ == 0) throw maps::InputError(path_.string() + ": the file is empty");
  info_.name = path_.stem().string();
  info_.format = "rawlog";
  mrpt::img::CImage::setImagesPathBase(images_folder(path_));
  read_ahead(options);
  stream_ = std::make_unique<RawlogStream>(path_);
}

/// Our own header says what sensors there are; in a foreign rawlog those that speak within the
/// first two seconds count.
void RawlogReader::read_ahead(const OpenOptions& options) {
  constexpr double kLookAhead_s = 2.0;
  RawlogStream stream(path_);
  bool has_frame = false;
  double first_s = 0.0;
  bool is_first = true;
  while (const CObservation::Ptr observation = stream.next()) {
    if (std::exchange(is_first, false)) first_s = seconds_of(*observation);
    const bool enough =
        stream.header() || std::abs(seconds_of(*observation) - first_s) > kLookAhead_s;
    if (has_frame && enough) break;
    if (const auto* scan = dynamic_cast<const CObservation3DRangeScan*>(observation.get())) {
      if (!std::exchange(has_frame, true)) learn_from_first_frame(*scan, options);
    } else if (dynamic_cast<const mrpt::obs::CObservationIMU*>(observation.get()) != nullptr) {
      info_.rig.has_imu = true;
    } else {
      info_.rig.has_wheels = true;
    }
  }
  if (!has_frame) {
    const std::string& why = stream.first_frame_problem();
    throw maps::InputError(path_.string() +
                           (why.empty()
                                ? ": it holds no RGB-D frames, so there is nothing to map"
                                : ": none of its camera frames can be used; of the first, " + why));
  }
  if (const auto& header = stream.header()) {
    info_.rig.has_extrinsics = header->has_extrinsics;
    info_.rig.has_wheels = header->has_wheels;
    info_.rig.has_imu = header->has_imu;
    info_.simulation = header->simulation;
  }
  if (!info_.rig.has_extrinsics) {
    info_.rig.base_from_camera = base_from_optical(mrpt::poses::CPose3D());
  }
}

void RawlogReader::learn_from_first_frame(const CObservation3DRangeScan& scan,
                                          const OpenOptions& options) {
  Rig& rig = info_.rig;
  rig.camera = scan.cameraParams;
  if (options.camera_info) {
    rig.camera = read_camera_info(*options.camera_info);
    overrides_camera_ = true;
  }
  rig.base_from_camera = base_from_optical(scan.sensorPose);
  // Programs that do not know where the camera sits leave it at the origin.
  constexpr double kAtOrigin = 0.05;
  const auto p = scan.sensorPose.asTPose();
  rig.has_extrinsics = scan.sensorPose.norm() > kAtOrigin || std::abs(p.yaw) > kAtOrigin ||
                       std::abs(p.pitch) > kAtOrigin || std::abs(p.roll) > kAtOrigin;
}

bool RawlogReader::fit_to_rig(CObservation3DRangeScan& scan) {
  const Rig& rig = info_.rig;
  if (overrides_camera_) scan.cameraParams = scan.cameraParamsIntensity = rig.camera;
  if (!rig.has_extrinsics) scan.sensorPose = mrpt::poses::CPose3D();
  if (scan.rangeImage.cols() != static_cast<int>(rig.camera.ncols) ||
      scan.rangeImage.rows() != static_cast<int>(rig.camera.nrows)) {
    stream_->skip_frame("it is not " + std::to_string(rig.camera.ncols) + " x " +
                        std::to_string(rig.camera.nrows) +
                        " pixels, as the camera's calibration says");
    return false;
  }
  return true;
}

CObservation::Ptr RawlogReader::next() {
  while (true) {
    while (!order_.is_full()) {
      CObservation::Ptr observation = stream_->next();
      if (!observation) break;
      order_.push(std::move(observation));
    }
    if (order_.empty()) return nullptr;
    CObservation::Ptr observation = order_.pop();
    auto* const scan = dynamic_cast<CObservation3DRangeScan*>(observation.get());
    if (observation->timestamp < last_time_) {
      if (scan != nullptr) stream_->skip_frame("its time lies before frames already read");
      continue;
    }
    if (scan != nullptr && !fit_to_rig(*scan)) continue;
    last_time_ = observation->timestamp;
    return observation;
  }
}

double RawlogReader::progress() const {
  return std::min(1.0,
                  static_cast<double>(stream_->bytes_read()) / static_cast<double>(file_bytes_));
}

}  // namespace

std::unique_ptr<RecordingReader> open_rawlog(const fs::path& path, const OpenOptions& options) {
  return std::make_unique<RawlogReader>(path, options);
}

}  // namespace rovigo::slam
