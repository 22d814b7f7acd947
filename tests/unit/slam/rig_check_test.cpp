// Whether the check of a recording's calibration finds what is wrong, and only that.

#include "slam/recording/rig_check.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <random>

#include "slam/recording/observations.h"
#include "tests/support/recordings.h"

namespace rovigo::slam {
namespace {

using ::testing::AnyOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// A level floor under a camera at 0.25 m, a wall at 4 m, and boxes of random colours in front.
class RandomRoom {
 public:
  explicit RandomRoom(unsigned seed) : generator_(seed) {
    rig_.camera.ncols = 320;
    rig_.camera.nrows = 240;
    rig_.camera.setIntrinsicParamsFromValues(260, 260, 160, 120);
    rig_.base_from_camera = base_from_optical(mrpt::poses::CPose3D(0.1, 0, 0.25, 0, 0, 0));
    rig_.has_extrinsics = true;
  }

  const Rig& rig() const { return rig_; }

  /// Colour shifted to the right against depth, depth in other units than it says.
  mrpt::obs::CObservation3DRangeScan::Ptr frame(double time_s, int shift_px, double scale) {
    constexpr float kUnits_m = 1.0F / 5000;
    auto scan = make_rgbd_observation(time_s, rig_, kUnits_m);
    cv::Mat color(240, 320, CV_8UC3, cv::Scalar(90, 90, 90));
    cv::Mat depth_m(240, 320, CV_32FC1, cv::Scalar(4.0));
    for (int v = 137; v < 240; ++v) {
      depth_m.row(v).setTo(0.25 * 260.0 / (v - 120.0));
      color.row(v).setTo(cv::Scalar(60, 100, 120));
    }
    for (int box = 0; box < 7; ++box) {
      const double z_m = real(1.2, 3.5);
      const cv::Rect area(whole(0, 260), whole(20, 110), whole(20, 60), whole(20, 60));
      cv::rectangle(color, area, cv::Scalar(whole(0, 255), whole(0, 255), whole(0, 255)), -1);
      cv::rectangle(depth_m, area, cv::Scalar(z_m), -1);
    }
    cv::Mat shifted = cv::Mat::zeros(color.size(), color.type());
    const cv::Rect kept(0, 0, 320 - shift_px, 240);
    color(kept).copyTo(shifted(kept + cv::Point(shift_px, 0)));
    scan->rangeImage.resize(240, 320);
    for (int v = 0; v < 240; ++v) {
      for (int u = 0; u < 320; ++u) {
        const double units = scale * depth_m.at<float>(v, u) / kUnits_m;
        scan->rangeImage(v, u) =
            units < 65535.0 ? static_cast<std::uint16_t>(std::lround(units)) : 0;
      }
    }
    scan->intensityImage = mrpt::img::CImage(shifted, mrpt::img::SHALLOW_COPY);
    scan->hasRangeImage = scan->hasIntensityImage = true;
    return scan;
  }

 private:
  double real(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(generator_);
  }
  int whole(int low, int high) { return std::uniform_int_distribution<int>(low, high)(generator_); }

  std::mt19937 generator_;
  Rig rig_;
};

std::vector<std::string> warnings_of(unsigned seed, int shift_px, double scale) {
  RandomRoom room(seed);
  RigCheck check(room.rig());
  for (int i = 0; i < 10; ++i) check.add(*room.frame(i, shift_px, scale));
  return check.warnings();
}

class RigCheckOfARoom : public ::testing::TestWithParam<unsigned> {};

TEST_P(RigCheckOfARoom, SaysNothingWhenAllIsWell) {
  EXPECT_THAT(warnings_of(GetParam(), 0, 1.0), IsEmpty());
  EXPECT_THAT(warnings_of(GetParam(), 2, 1.02), IsEmpty());
}

TEST_P(RigCheckOfARoom, FindsDepthBesideColour) {
  EXPECT_THAT(warnings_of(GetParam(), 12, 1.0),
              ElementsAre(AnyOf(HasSubstr("about 11 pixels"), HasSubstr("about 12 pixels"),
                                HasSubstr("about 13 pixels"))));
}

TEST_P(RigCheckOfARoom, FindsAWrongDepthUnitByTheFloor) {
  EXPECT_THAT(warnings_of(GetParam(), 0, 0.2), ElementsAre(HasSubstr("factor of 5.0")));
  EXPECT_THAT(warnings_of(GetParam(), 0, 2.0), ElementsAre(HasSubstr("factor of 2.0")));
}

INSTANTIATE_TEST_SUITE_P(Seeds, RigCheckOfARoom, ::testing::Range(1U, 7U));

TEST(RigCheckOfIntrinsics, FindsACalibrationForAnotherResolution) {
  mrpt::img::TCamera camera = test::test_rig().camera;
  EXPECT_THAT(intrinsics_warning(camera), IsEmpty());
  camera.ncols *= 2;
  camera.nrows *= 2;
  EXPECT_THAT(intrinsics_warning(camera), HasSubstr("principal point"));
  camera.setIntrinsicParamsFromValues(2000, 2000, 64, 48);
  EXPECT_THAT(intrinsics_warning(camera), HasSubstr("focal length"));
  camera.setIntrinsicParamsFromValues(110, 70, 64, 48);
  EXPECT_THAT(intrinsics_warning(camera), HasSubstr("focal lengths"));
}

/// Two seconds of samples, the rover at rest unless it turns.
std::vector<std::string> imu_warnings(const Eigen::Vector3d& force, double rate_rad_s) {
  RigCheck check(test::test_rig());
  for (int i = 0; i < 200; ++i) {
    check.add(*make_imu_observation({10.0 + 0.01 * i, {0, 0, rate_rad_s}, force}));
  }
  return check.warnings();
}

TEST(RigCheckOfTheImu, FindsGravityAlongAnotherAxisOrInOtherUnits) {
  EXPECT_THAT(imu_warnings({0.3, -0.2, 9.8}, 0.0), IsEmpty());
  EXPECT_THAT(imu_warnings({0.0, -9.8, 0.1}, 0.0), ElementsAre(HasSubstr("base_link")));
  EXPECT_THAT(imu_warnings({0.0, 0.0, -9.8}, 0.0), ElementsAre(HasSubstr("180 degrees")));
  EXPECT_THAT(imu_warnings({0.0, 0.0, 1.0}, 0.0), ElementsAre(HasSubstr("other units")));
  EXPECT_THAT(imu_warnings({0.0, -9.8, 0.1}, 0.5), IsEmpty()) << "it is not at rest";
}

}  // namespace
}  // namespace rovigo::slam
