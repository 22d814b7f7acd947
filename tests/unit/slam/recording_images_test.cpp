#include "slam/recording/images.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "tests/support/recordings.h"

namespace rovigo::slam {
namespace {

using ::testing::HasSubstr;

std::string encoded(const char* extension, const cv::Mat& image) {
  std::vector<uchar> bytes;
  cv::imencode(extension, image, bytes);
  return {bytes.begin(), bytes.end()};
}

cv::Mat noise(int type) {
  cv::Mat image(48, 64, type);
  cv::RNG generator(5);
  generator.fill(image, cv::RNG::UNIFORM, 0, type == CV_16UC1 ? 60000 : 255);
  return image;
}

TEST(ImageViews, ShareTheObservationsMemory) {
  const auto scan = test::test_frame(1.0, test::test_rig());
  const cv::Mat depth = depth_view(*scan);
  const cv::Mat color = color_view(*scan);
  ASSERT_EQ(depth.type(), CV_16UC1);
  ASSERT_EQ(color.type(), CV_8UC3);
  EXPECT_EQ(static_cast<const void*>(depth.data),
            static_cast<const void*>(scan->rangeImage.data()));
  EXPECT_EQ(color.data, scan->intensityImage.asCvMatRef().data);
  EXPECT_EQ(depth.at<std::uint16_t>(7, 9), scan->rangeImage(7, 9));
}

TEST(ImageViews, AreEmptyWhereTheObservationHasNoImage) {
  const mrpt::obs::CObservation3DRangeScan scan;
  EXPECT_TRUE(depth_view(scan).empty());
  EXPECT_TRUE(color_view(scan).empty());
  EXPECT_TRUE(depth_in_metres(scan).empty());
}

TEST(ImageViews, DepthInMetresScalesByTheUnit) {
  const auto scan = test::test_frame(1.0, test::test_rig(), 0.001F);
  EXPECT_NEAR(depth_in_metres(*scan).at<float>(1, 1), scan->rangeImage(1, 1) * 0.001, 1e-6);
}

TEST(InspectImage, KnowsSizeAndDepthWithoutDecoding) {
  const EncodedImage png = inspect_image(encoded(".png", noise(CV_16UC1)));
  EXPECT_EQ(png.problem, "");
  EXPECT_EQ(png.kind, EncodedImage::Kind::kPng);
  EXPECT_EQ(png.width, 64);
  EXPECT_EQ(png.height, 48);
  EXPECT_EQ(png.bits, 16);
  EXPECT_EQ(png.channels, 1);
  const EncodedImage jpeg = inspect_image(encoded(".jpg", noise(CV_8UC3)));
  EXPECT_EQ(jpeg.problem, "");
  EXPECT_EQ(jpeg.kind, EncodedImage::Kind::kJpeg);
  EXPECT_EQ(jpeg.width, 64);
  EXPECT_EQ(jpeg.height, 48);
  EXPECT_EQ(jpeg.bits, 8);
  EXPECT_EQ(jpeg.channels, 3);
}

TEST(InspectImage, EveryTruncationIsNoticed) {
  for (const std::string& whole :
       {encoded(".png", noise(CV_16UC1)), encoded(".png", noise(CV_8UC3)),
        encoded(".jpg", noise(CV_8UC3)), encoded(".jpg", noise(CV_8UC1))}) {
    for (std::size_t length = 0; length < whole.size(); ++length) {
      ASSERT_NE(inspect_image(std::string_view(whole).substr(0, length)).problem, "")
          << length << " of " << whole.size();
    }
  }
}

TEST(InspectImage, EveryFlippedBitOfAPngIsNoticed) {
  std::string bytes = encoded(".png", cv::Mat(4, 4, CV_16UC1, cv::Scalar(1234)));
  for (std::size_t i = 0; i < bytes.size() * 8; ++i) {
    const char old = bytes[i / 8];
    bytes[i / 8] = static_cast<char>(old ^ (1 << i % 8));
    EXPECT_NE(inspect_image(bytes).problem, "") << "bit " << i;
    bytes[i / 8] = old;
  }
}

TEST(InspectImage, RefusesImagesOfAbsurdSize) {
  std::string bytes = encoded(".jpg", noise(CV_8UC1));
  const std::size_t frame = bytes.find("\xFF\xC0");
  ASSERT_NE(frame, std::string::npos);
  bytes.replace(frame + 5, 4, "\xFF\xFF\xFF\xFF");
  EXPECT_THAT(inspect_image(bytes).problem, HasSubstr("8192"));
}

TEST(InspectImage, NamesWhatIsNoImage) {
  EXPECT_THAT(inspect_image("").problem, HasSubstr("empty"));
  EXPECT_THAT(inspect_image("GIF89a...").problem, HasSubstr("neither PNG nor JPEG"));
  EXPECT_NE(inspect_image("\xFF\xD8").problem, "");
  EXPECT_NE(inspect_image("\xFF\xD8\xFF\xD9").problem, "");
}

TEST(DecodeColor, GivesThreeChannelsAlways) {
  std::string problem;
  EXPECT_EQ(decode_color(encoded(".png", noise(CV_8UC1)), problem).type(), CV_8UC3);
  EXPECT_EQ(decode_color(encoded(".png", noise(CV_8UC3)), problem).type(), CV_8UC3);
  EXPECT_EQ(problem, "");
  EXPECT_TRUE(decode_color(encoded(".png", noise(CV_16UC1)), problem).empty());
  EXPECT_THAT(problem, HasSubstr("16 bits"));
}

TEST(DecodeDepth, KeepsEveryBit) {
  const cv::Mat image = noise(CV_16UC1);
  mrpt::math::CMatrix_u16 depth;
  std::string problem;
  ASSERT_TRUE(decode_depth(encoded(".png", image), depth, problem)) << problem;
  const cv::Mat view(48, 64, CV_16UC1, depth.data());
  EXPECT_EQ(cv::norm(view, image, cv::NORM_INF), 0.0);
}

TEST(DecodeDepth, RefusesJpegAndColour) {
  mrpt::math::CMatrix_u16 depth;
  std::string problem;
  EXPECT_FALSE(decode_depth(encoded(".jpg", noise(CV_8UC1)), depth, problem));
  EXPECT_THAT(problem, HasSubstr("16-bit grey PNG"));
  EXPECT_FALSE(decode_depth(encoded(".png", noise(CV_8UC3)), depth, problem));
}

}  // namespace
}  // namespace rovigo::slam
