#include "slam/keyframe_codec.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "maps/error.h"

namespace rovigo::slam {
namespace {

std::vector<StoredFeature> some_features(int n) {
  std::mt19937_64 random(3);
  std::vector<StoredFeature> out;
  for (int i = 0; i < n; ++i) {
    StoredFeature f;
    f.pixel_u = static_cast<float>(random() % 640);
    f.pixel_v = static_cast<float>(random() % 480);
    f.angle_rad = 0.5f;
    f.depth_m = static_cast<float>(random() % 5);
    f.octave = static_cast<std::uint8_t>(random() % 6);
    f.landmark = static_cast<int>(random() % 1000);
    f.point_x = 1.5f;
    f.point_z = 2.5f;
    f.sigma_m = 0.01f;
    f.descriptor = {random(), random(), random(), random()};
    out.push_back(f);
  }
  return out;
}

TEST(KeyframeCodec, FeaturesComeBackAsTheyWere) {
  for (const int n : {0, 1, 500}) {
    const auto features = some_features(n);
    EXPECT_EQ(decode_features(encode_features(features)), features);
  }
}

TEST(KeyframeCodec, EveryTruncationIsRefused) {
  const maps::Blob whole = encode_features(some_features(3));
  for (std::size_t n = 0; n < whole.size(); ++n) {
    EXPECT_THROW(decode_features(maps::Blob(whole.begin(), whole.begin() + static_cast<long>(n))),
                 maps::InputError)
        << n << " bytes";
  }
}

TEST(KeyframeCodec, FlippedBytesAreRefusedOrReadAsFiniteFeatures) {
  const maps::Blob whole = encode_features(some_features(3));
  std::mt19937_64 random(4);
  for (int i = 0; i < 3000; ++i) {
    maps::Blob damaged = whole;
    for (int k = 0; k < 4; ++k)
      damaged[random() % damaged.size()] = static_cast<std::uint8_t>(random());
    try {
      for (const StoredFeature& f : decode_features(damaged)) {
        EXPECT_TRUE(std::isfinite(f.point_x) && std::isfinite(f.depth_m));
        EXPECT_GE(f.landmark, -1);
      }
    } catch (const maps::InputError&) {
    }
  }
}

TEST(KeyframeCodec, ACountThatPromisesMoreThanTheBytesHoldIsRefused) {
  maps::Blob blob = encode_features(some_features(2));
  blob[8] = blob[9] = blob[10] = blob[11] = 0xff;
  EXPECT_THROW(decode_features(blob), maps::InputError);
}

TEST(KeyframeCodec, NonFiniteNumbersAreRefused) {
  auto features = some_features(2);
  features[1].point_y = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THROW(decode_features(encode_features(features)), maps::InputError);
}

TEST(KeyframeCodec, DepthIsStoredInMillimetres) {
  CameraFrame frame;
  frame.depth = cv::Mat(48, 64, CV_16UC1, cv::Scalar(10000));
  frame.depth_unit_m = 1.0 / 5000.0;  // TUM's
  const cv::Mat back = decode_depth(encode_depth(frame), frame.depth.size());
  EXPECT_EQ(back.size(), frame.depth.size());
  EXPECT_EQ(back.at<std::uint16_t>(10, 10), 2000);
}

TEST(KeyframeCodec, EverySecondPixelOfADepthImageIsKept) {
  CameraFrame frame;
  frame.depth.create(5, 7, CV_16UC1);
  for (int i = 0; i < 35; ++i)
    frame.depth.at<std::uint16_t>(i / 7, i % 7) = static_cast<std::uint16_t>(100 + i);
  const cv::Mat back = decode_depth(encode_depth(frame), {8, 6});
  for (int v = 0; v < 6; v += 2) {
    for (int u = 0; u < 8; u += 2) {
      EXPECT_EQ(back.at<std::uint16_t>(v, u), 100 + 7 * v + u);
    }
  }
}

TEST(KeyframeCodec, ADepthImageThatIsNoPngIsRefused) {
  EXPECT_THROW(decode_depth({1, 2, 3}, {8, 6}), maps::InputError);
  EXPECT_THROW(decode_depth({}, {8, 6}), maps::InputError);
}

}  // namespace
}  // namespace rovigo::slam
