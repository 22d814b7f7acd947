#include <fstream>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <stdexcept>
#include <utility>

#include "maps/atomic_file.h"
#include "maps/error.h"
#include "slam/recording/images.h"
#include "slam/recording/observations.h"
#include "slam/recording/pending_path.h"
#include "slam/recording/pose_numbers.h"
#include "slam/recording/recording.h"
#include "slam/recording/rig_yaml.h"

namespace rovigo::slam {
namespace {

namespace fs = std::filesystem;

constexpr double kUnitsPerMetre = 5000.0;

/// A folder that is about to be replaced must be a recording or empty, not somebody's work.
void require_replaceable(const fs::path& directory) {
  std::error_code error;
  if (!fs::exists(directory, error)) return;
  if (!fs::is_directory(directory, error)) {
    throw maps::InputError("cannot write " + directory.string() + ": a file of that name exists");
  }
  if (!fs::is_empty(directory, error) && !fs::exists(directory / "rgb.txt", error)) {
    throw maps::InputError("cannot write " + directory.string() +
                           ": the folder exists and is no recording; choose another name");
  }
}

class TumWriter final : public RecordingWriter {
 public:
  TumWriter(const fs::path& directory, RecordingInfo info);

  void write(const mrpt::obs::CObservation& observation) override;
  void finish() override;

 private:
  void write_frame(const mrpt::obs::CObservation3DRangeScan& scan);
  void write_imu(const mrpt::obs::CObservationIMU& imu);
  void write_odometry(const mrpt::obs::CObservationOdometry& odometry);
  void write_image(const fs::path& relative, const cv::Mat& image, const std::vector<int>& how);
  void write_text(const char* name, const std::string& text) const;

  RecordingInfo info_;
  PendingPath pending_;
  std::string rgb_ = "# colour images\n# timestamp filename\n";
  std::string depth_ = "# depth images, 5000 units per metre\n# timestamp filename\n";
  std::string associations_;
  std::string imu_ = "# t wx wy wz ax ay az, base_link; rad/s, m/s^2 (specific force)\n";
  std::string odometry_ = "# odom_from_base_link\n# timestamp tx ty tz qx qy qz qw\n";
  bool has_imu_ = false;
  bool has_odometry_ = false;
  bool is_finished_ = false;
};

TumWriter::TumWriter(const fs::path& directory, RecordingInfo info)
    : info_(std::move(info)), pending_(directory) {
  require_replaceable(pending_.target());
  std::error_code error;
  fs::create_directories(pending_.temporary() / "rgb", error);
  fs::create_directories(pending_.temporary() / "depth", error);
  if (error) {
    throw maps::InputError("cannot write " + directory.string() + ": " + error.message());
  }
}

void TumWriter::write(const mrpt::obs::CObservation& observation) {
  if (is_finished_) throw std::logic_error("a finished recording was written to");
  if (const auto* scan = dynamic_cast<const mrpt::obs::CObservation3DRangeScan*>(&observation)) {
    write_frame(*scan);
  } else if (const auto* imu = dynamic_cast<const mrpt::obs::CObservationIMU*>(&observation)) {
    write_imu(*imu);
  } else if (const auto* odometry =
                 dynamic_cast<const mrpt::obs::CObservationOdometry*>(&observation)) {
    write_odometry(*odometry);
  }
}

void TumWriter::write_frame(const mrpt::obs::CObservation3DRangeScan& scan) {
  const cv::Mat color = color_view(scan);
  cv::Mat depth = depth_view(scan);
  if (color.empty() || depth.empty()) return;
  const double units_to_tum = scan.rangeUnits * kUnitsPerMetre;
  constexpr double kSameUnit = 1e-6;
  if (std::abs(units_to_tum - 1.0) > kSameUnit) {
    cv::Mat scaled;
    depth.convertTo(scaled, CV_16UC1, units_to_tum);
    scaled.setTo(0, depth > 65535.0 / units_to_tum);  // beyond 13.1 m: no return, not 13.1 m
    depth = scaled;
  }
  const std::string time = time_text(scan);
  const std::string color_path = "rgb/" + time + ".jpg";
  const std::string depth_path = "depth/" + time + ".png";
  write_image(color_path, color, {cv::IMWRITE_JPEG_QUALITY, 95});
  // Run-length matching: on noisy depth 8 ms and 262 kB, against 11 ms and 278 kB by default.
  write_image(
      depth_path, depth,
      {cv::IMWRITE_PNG_COMPRESSION, 1, cv::IMWRITE_PNG_STRATEGY, cv::IMWRITE_PNG_STRATEGY_RLE});
  rgb_ += time + ' ' + color_path + '\n';
  depth_ += time + ' ' + depth_path + '\n';
  associations_ += time + ' ' + color_path + ' ' + time + ' ' + depth_path + '\n';
}

void TumWriter::write_imu(const mrpt::obs::CObservationIMU& imu) {
  const auto sample = imu_sample_of(imu);
  if (!sample) return;
  has_imu_ = true;
  imu_ += time_text(imu);
  for (const double rate : sample->angular_rate_rad_s) imu_ += ' ' + shortest(rate);
  for (const double force : sample->specific_force_m_s2) imu_ += ' ' + shortest(force);
  imu_ += '\n';
}

void TumWriter::write_odometry(const mrpt::obs::CObservationOdometry& odometry) {
  has_odometry_ = true;
  odometry_ += time_text(odometry);
  const mrpt::poses::CPose3D pose(odometry.odometry);
  for (const double number : numbers_of(pose)) odometry_ += ' ' + shortest(number);
  odometry_ += '\n';
}

void TumWriter::write_image(const fs::path& relative, const cv::Mat& image,
                            const std::vector<int>& how) {
  std::vector<uchar> bytes;
  const bool encoded = cv::imencode(relative.extension().string(), image, bytes, how);
  std::ofstream stream(pending_.temporary() / relative, std::ios::binary);
  stream.write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size()));
  stream.close();
  if (!encoded || !stream) {
    throw maps::InputError("cannot write " + (pending_.target() / relative).string() +
                           ": check the free space");
  }
}

void TumWriter::write_text(const char* name, const std::string& text) const {
  maps::write_file_atomically(pending_.temporary() / name, text);
}

void TumWriter::finish() {
  if (is_finished_) return;
  is_finished_ = true;
  write_text("rgb.txt", rgb_);
  write_text("depth.txt", depth_);
  write_text("associations.txt", associations_);
  if (has_imu_) write_text("imu.txt", imu_);
  if (has_odometry_) write_text("wheel_odometry.txt", odometry_);
  write_text("camera_info.yaml", camera_info_text(info_.rig.camera));
  if (info_.rig.has_extrinsics) {
    write_text("extrinsics.yaml", extrinsics_text(info_.rig.base_from_camera));
  }
  if (info_.simulation) write_text("simulation.yaml", simulation_text(*info_.simulation));
  pending_.commit();
}

}  // namespace

std::unique_ptr<RecordingWriter> create_tum_directory(const fs::path& directory,
                                                      const RecordingInfo& info) {
  return std::make_unique<TumWriter>(directory, info);
}

}  // namespace rovigo::slam
