#include "slam/recording/rawlog_objects.h"

#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationComment.h>
#include <mrpt/obs/CObservationIMU.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CSensoryFrame.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <exception>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "slam/recording/images.h"

// Layouts: serializeTo of the classes in MRPT 2.5.8. Numbers are little-endian; an object is its
// class name (length | 0x80, characters), a version byte, its fields, and 0x88.

namespace rovigo::slam {
namespace {

using mrpt::serialization::CSerializable;

constexpr std::uint32_t kMaxText = 1u << 20;
constexpr std::uint32_t kMaxImageBytes = 64u << 20;
constexpr std::uint32_t kMaxSide_px = 8192;
constexpr std::uint32_t kMaxPoints = kMaxSide_px * kMaxSide_px / 4;
constexpr std::uint32_t kMaxFrameSize = 1000;  // observations in a sensory frame

/// Not damage: a kind or version that only MRPT knows.
struct LeaveItToMrpt : std::exception {};

[[noreturn]] void damaged(const char* what) { throw std::runtime_error(what); }

struct Header {
  std::string name;  ///< without its namespace
  int version = 0;
};

class ObjectReader {
 public:
  explicit ObjectReader(GzReadArchive& archive) : archive_(archive) {}

  CSerializable::Ptr object(int depth = 0);

 private:
  template <class T>
  T number() {
    T value{};
    bytes(&value, sizeof value);
    return value;
  }
  bool flag() { return number<std::uint8_t>() != 0; }
  std::uint32_t count(std::uint32_t most) {
    const auto n = number<std::uint32_t>();
    if (n > most) damaged("an impossible length");
    return n;
  }
  void bytes(void* into, std::size_t length) {
    if (length > 0) archive_.ReadBuffer(into, length);
  }
  void skip(std::size_t length);
  std::string text();
  Header header();
  void require(const char* name, int first_version, int last_version, int* version = nullptr);
  void end() {
    if (number<std::uint8_t>() != 0x88) damaged("an object without its end");
  }

  mrpt::Clock::time_point time() {
    return mrpt::Clock::time_point(mrpt::Clock::duration(number<std::int64_t>()));
  }
  mrpt::poses::CPose3D pose3d();
  mrpt::poses::CPose2D pose2d();
  mrpt::img::TCamera camera();
  void image(mrpt::img::CImage& image);
  void color_image(mrpt::img::CImage& image);
  void grey_image(mrpt::img::CImage& image, int version);
  void range_image(mrpt::math::CMatrix_u16& image);

  CSerializable::Ptr rgbd(int version);
  CSerializable::Ptr imu();
  CSerializable::Ptr odometry();
  CSerializable::Ptr comment();
  CSerializable::Ptr sensory_frame(int depth);

  GzReadArchive& archive_;
};

void ObjectReader::skip(std::size_t length) {
  std::array<char, 4096> unused{};
  while (length > 0) {
    const std::size_t step = std::min(length, unused.size());
    bytes(unused.data(), step);
    length -= step;
  }
}

std::string ObjectReader::text() {
  std::string value(count(kMaxText), '\0');
  bytes(value.data(), value.size());
  return value;
}

Header ObjectReader::header() {
  const auto length = number<std::uint8_t>();
  if ((length & 0x80) == 0) throw LeaveItToMrpt();  // before MRPT 0.5.5
  std::string name(length & 0x7F, '\0');
  bytes(name.data(), name.size());
  const std::size_t last_colon = name.rfind(':');
  if (last_colon != std::string::npos) name.erase(0, last_colon + 1);
  if (name == "nullptr") throw LeaveItToMrpt();
  return {name, number<std::int8_t>()};
}

void ObjectReader::require(const char* name, int first_version, int last_version, int* version) {
  const Header found = header();
  if (found.name != name) damaged("another object than expected");
  if (found.version < first_version || found.version > last_version) throw LeaveItToMrpt();
  if (version != nullptr) *version = found.version;
}

mrpt::poses::CPose3D ObjectReader::pose3d() {
  require("CPose3D", 3, 3);
  mrpt::math::CMatrixDouble44 matrix;
  matrix.setIdentity();
  for (int i = 0; i < 3; ++i) matrix(i, 3) = number<double>();
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) matrix(r, c) = number<double>();
  }
  end();
  return mrpt::poses::CPose3D(matrix);
}

mrpt::poses::CPose2D ObjectReader::pose2d() {
  require("CPose2D", 1, 1);
  mrpt::poses::CPose2D pose;  // its constructor would wrap the angle and lose its last bit
  pose.x(number<double>());
  pose.y(number<double>());
  pose.phi(number<double>());
  end();
  return pose;
}

mrpt::img::TCamera ObjectReader::camera() {
  int version = 0;
  require("TCamera", 4, 6, &version);
  mrpt::img::TCamera camera;
  camera.focalLengthMeters = number<double>();
  for (double& k : camera.dist) k = number<double>();
  const auto fx = number<double>();
  const auto fy = number<double>();
  const auto cx = number<double>();
  const auto cy = number<double>();
  camera.setIntrinsicParamsFromValues(fx, fy, cx, cy);
  camera.nrows = number<std::uint32_t>();
  camera.ncols = number<std::uint32_t>();
  if (version >= 5) camera.cameraName = text();
  camera.distortion = mrpt::img::DistortionModel::plumb_bob;
  if (version >= 6) {
    const auto model = number<std::uint8_t>();
    if (model > 2) damaged("an unknown distortion model");
    camera.distortion = static_cast<mrpt::img::DistortionModel>(model);
  }
  end();
  return camera;
}

void ObjectReader::image(mrpt::img::CImage& image) {
  int version = 0;
  require("CImage", 8, 9, &version);
  if (flag()) {
    image.setExternalStorage(text());
  } else if (flag()) {
    color_image(image);
  } else {
    grey_image(image, version);
  }
  end();
}

/// JPEG, or raw rows where width and height are negative.
void ObjectReader::color_image(mrpt::img::CImage& image) {
  const auto width = number<std::int32_t>();
  const auto height = number<std::int32_t>();
  constexpr int kMost = static_cast<int>(kMaxSide_px);
  if (width > 0 && height > 0) {
    std::string jpeg(count(kMaxImageBytes), '\0');
    bytes(jpeg.data(), jpeg.size());
    std::string problem;
    const cv::Mat pixels = decode_color(jpeg, problem);
    if (problem.empty()) image = mrpt::img::CImage(pixels, mrpt::img::SHALLOW_COPY);
  } else if (width < 0 && height < 0) {
    if (width < -kMost || height < -kMost) damaged("an impossible image size");
    cv::Mat pixels(-height, -width, CV_8UC3);
    bytes(pixels.data, pixels.total() * pixels.elemSize());
    image = mrpt::img::CImage(pixels, mrpt::img::SHALLOW_COPY);
  }
}

void ObjectReader::grey_image(mrpt::img::CImage& image, int version) {
  const auto width = number<std::int32_t>();
  const auto height = number<std::int32_t>();
  number<std::int32_t>();  // origin, unused
  const std::uint32_t size = count(kMaxImageBytes);
  const bool is_8_bit = version < 9 || number<std::int32_t>() == 0;
  if (flag()) throw LeaveItToMrpt();  // zipped
  if (width <= 0 || height <= 0 || !is_8_bit ||
      std::uint64_t{size} !=
          static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height)) {
    skip(size);  // 16-bit or padded rows: not an image Rovigo uses
    return;
  }
  cv::Mat pixels(height, width, CV_8UC1);
  bytes(pixels.data, size);
  image = mrpt::img::CImage(pixels, mrpt::img::SHALLOW_COPY);
}

void ObjectReader::range_image(mrpt::math::CMatrix_u16& image) {
  const std::uint32_t rows = count(kMaxSide_px);
  const std::uint32_t columns = count(kMaxSide_px);
  image.resize(static_cast<int>(rows), static_cast<int>(columns));
  bytes(image.data(), std::size_t{2} * rows * columns);
}

CSerializable::Ptr ObjectReader::rgbd(int version) {
  auto scan = mrpt::obs::CObservation3DRangeScan::Create();
  scan->maxRange = number<float>();
  scan->sensorPose = pose3d();
  if (flag()) {  // a point cloud, not needed: x, y, z and two pixel indices
    const std::size_t points = count(kMaxPoints);
    skip(points * (3 * sizeof(float) + 2 * sizeof(std::uint16_t)));
  }
  scan->hasRangeImage = flag();
  scan->rangeUnits = number<float>();
  if (scan->hasRangeImage) range_image(scan->rangeImage);
  scan->hasIntensityImage = flag();
  if (scan->hasIntensityImage) image(scan->intensityImage);
  if (flag()) {
    mrpt::img::CImage confidence;
    image(confidence);
  }
  scan->cameraParams = camera();
  scan->cameraParamsIntensity = camera();
  scan->relativePoseIntensityWRTDepth = pose3d();
  scan->stdError = number<float>();
  scan->timestamp = time();
  scan->sensorLabel = text();
  flag();
  text();                             // an external point cloud, not needed
  if (flag()) throw LeaveItToMrpt();  // external depth: MRPT knows where
  text();
  scan->range_is_depth = flag();
  number<std::int8_t>();              // visible or infrared: both are pictures
  if (flag()) throw LeaveItToMrpt();  // pixel labels
  const int layers = version >= 10 ? number<std::uint8_t>() : 0;
  for (int i = 0; i < layers; ++i) {
    text();
    mrpt::math::CMatrix_u16 unused;
    range_image(unused);
  }
  end();
  return scan;
}

CSerializable::Ptr ObjectReader::imu() {
  auto imu = mrpt::obs::CObservationIMU::Create();
  imu->sensorPose = pose3d();
  for (bool& is_present : imu->dataIsPresent) is_present = flag();
  imu->timestamp = time();
  for (double& value : imu->rawMeasurements) value = number<double>();
  imu->sensorLabel = text();
  end();
  return imu;
}

CSerializable::Ptr ObjectReader::odometry() {
  auto odometry = mrpt::obs::CObservationOdometry::Create();
  odometry->odometry = pose2d();
  odometry->sensorLabel = text();
  odometry->timestamp = time();
  odometry->hasEncodersInfo = flag();
  if (odometry->hasEncodersInfo) {
    odometry->encoderLeftTicks = number<std::int32_t>();
    odometry->encoderRightTicks = number<std::int32_t>();
  }
  odometry->hasVelocities = flag();
  if (odometry->hasVelocities) {
    odometry->velocityLocal.vx = number<double>();
    odometry->velocityLocal.vy = number<double>();
    odometry->velocityLocal.omega = number<double>();
  }
  end();
  return odometry;
}

CSerializable::Ptr ObjectReader::comment() {
  auto comment = mrpt::obs::CObservationComment::Create();
  comment->text = text();
  comment->timestamp = time();
  end();
  return comment;
}

CSerializable::Ptr ObjectReader::sensory_frame(int depth) {
  if (depth > 0) damaged("a sensory frame inside another");
  auto frame = mrpt::obs::CSensoryFrame::Create();
  const std::uint32_t observations = count(kMaxFrameSize);
  for (std::uint32_t i = 0; i < observations; ++i) {
    const CSerializable::Ptr element = object(depth + 1);
    const auto observation = std::dynamic_pointer_cast<mrpt::obs::CObservation>(element);
    if (!observation) damaged("a sensory frame with something else inside");
    frame->insert(observation);
  }
  end();
  return frame;
}

CSerializable::Ptr ObjectReader::object(int depth) {
  const Header is = header();
  if (is.name == "CObservation3DRangeScan" && (is.version == 9 || is.version == 10)) {
    return rgbd(is.version);
  }
  if (is.name == "CObservationIMU" && is.version == 4) return imu();
  if (is.name == "CObservationOdometry" && is.version == 2) return odometry();
  if (is.name == "CObservationComment" && is.version == 0) return comment();
  if (is.name == "CSensoryFrame" && is.version == 2) return sensory_frame(depth);
  throw LeaveItToMrpt();
}

}  // namespace

CSerializable::Ptr read_rawlog_object(GzReadArchive& archive) {
  archive.mark();
  try {
    CSerializable::Ptr object = ObjectReader(archive).object();
    archive.forget_mark();
    return object;
  } catch (const LeaveItToMrpt&) {
    archive.rewind();
    return read_with_mrpt(archive);
  }
}

}  // namespace rovigo::slam
