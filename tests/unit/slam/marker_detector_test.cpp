#include "slam/marker_detector.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <opencv2/aruco.hpp>
#include <opencv2/imgproc.hpp>
#include <random>

#include "maps/geometry.h"
#include "tests/support/pinhole.h"

namespace rovigo::slam {
namespace {

using mrpt::poses::CPose3D;

constexpr double kSideM = 0.18;
constexpr int kPrintCells = 8;  // the marker's six and a white one on either side

/// A marker `x` m beside the optical axis, `y` m below it and `z` m ahead, facing the camera but
/// for a turn about the vertical.
CPose3D marker_at(double x, double y, double z, double turn) {
  mrpt::math::CMatrixDouble44 m;
  m.setIdentity();
  const double c = std::cos(turn), s = std::sin(turn);
  // The marker's x is the camera's x, its y is up, its z comes back to the camera.
  m(0, 0) = c, m(0, 1) = 0.0, m(0, 2) = s;
  m(1, 0) = 0.0, m(1, 1) = -1.0, m(1, 2) = 0.0;
  m(2, 0) = s, m(2, 1) = 0.0, m(2, 2) = -c;
  m(0, 3) = x, m(1, 3) = y, m(2, 3) = z;
  return CPose3D(m);
}

/// Draws the print by projecting its corners: a plane's image is a homography.
void draw(cv::Mat& image, int id, const CPose3D& camera_from_marker) {
  constexpr int kFiner = 8, kCellPx = 40, kPx = kPrintCells * kCellPx;
  cv::Mat print(kPx, kPx, CV_8UC1, cv::Scalar(235)), marker;
  cv::aruco::getPredefinedDictionary(cv::aruco::DICT_4X4_50)
      ->drawMarker(id, 6 * kCellPx, marker, 1);
  marker.copyTo(print(cv::Rect(kCellPx, kCellPx, 6 * kCellPx, 6 * kCellPx)));
  const double half = kSideM / 6.0 * kPrintCells / 2.0;
  std::vector<cv::Point2f> seen;
  for (const auto& [x, y] : {std::pair{-half, half}, {half, half}, {half, -half}, {-half, -half}}) {
    double cx = 0.0, cy = 0.0, cz = 0.0;
    camera_from_marker.composePoint(x, y, 0.0, cx, cy, cz);
    seen.emplace_back(static_cast<float>(kFiner * (460.0 * cx / cz + 320.0) - 0.5),
                      static_cast<float>(kFiner * (460.0 * cy / cz + 240.0) - 0.5));
  }
  const float edge = kPx - 0.5F;
  const std::vector<cv::Point2f> corners{
      {-0.5F, -0.5F}, {edge, -0.5F}, {edge, edge}, {-0.5F, edge}};
  cv::Mat fine;
  cv::resize(image, fine, {}, kFiner, kFiner, cv::INTER_NEAREST);
  cv::warpPerspective(print, fine, cv::getPerspectiveTransform(corners, seen), fine.size(),
                      cv::INTER_LINEAR, cv::BORDER_TRANSPARENT);
  cv::resize(fine, image, image.size(), 0, 0, cv::INTER_AREA);  // a pixel is a mean
}

cv::Mat empty_view() {
  cv::Mat image(480, 640, CV_8UC1);
  cv::theRNG().state = 7;
  cv::randn(image, 140.0, 6.0);
  return image;
}

double angle_between(const CPose3D& a, const CPose3D& b) {
  const auto r = (a - b).getRotationMatrix();
  return std::acos(std::clamp((r(0, 0) + r(1, 1) + r(2, 2) - 1.0) / 2.0, -1.0, 1.0));
}

TEST(MarkerDetector, FindsThePoseOfARenderedMarkerFromNearAndFarAndAside) {
  struct Case {
    double x, y, z, turn, position_m, angle_rad;
  };
  for (const Case& c :
       {Case{0.0, 0.0, 0.5, 0.3, 0.003, 0.02}, Case{0.1, 0.05, 0.8, -0.4, 0.006, 0.03},
        Case{-0.4, -0.1, 1.2, 0.6, 0.012, 0.04}, Case{0.5, 0.1, 1.8, -0.7, 0.03, 0.08}}) {
    SCOPED_TRACE(c.z);
    cv::Mat image = empty_view();
    const CPose3D truth = marker_at(c.x, c.y, c.z, c.turn);
    draw(image, 7, truth);
    const auto found = find_markers(image, test::pinhole(), kSideM);
    ASSERT_EQ(found.size(), 1U);
    EXPECT_EQ(found[0].id, 7);
    EXPECT_LE((found[0].camera_from_marker - truth).norm(), c.position_m);
    EXPECT_LE(angle_between(found[0].camera_from_marker, truth), c.angle_rad);
    EXPECT_LE(found[0].reprojection_rms_px, found[0].other_reprojection_rms_px);
  }
}

TEST(MarkerDetector, FarAwayOneOfTheTwoPosesIsTheTrueOne) {
  int mistaken = 0;
  for (int i = 0; i < 12; ++i) {
    cv::Mat image = empty_view();
    const double turn = -0.45 + 0.08 * i;
    const CPose3D truth = marker_at(0.03 * i, 0.05, 2.8, turn);
    draw(image, 3, truth);
    const auto found = find_markers(image, test::pinhole(), kSideM);
    ASSERT_EQ(found.size(), 1U) << turn;
    const double one = angle_between(found[0].camera_from_marker, truth);
    const double other = angle_between(found[0].other_camera_from_marker, truth);
    EXPECT_LE(std::min(one, other), 0.25) << turn;
    mistaken += other < one ? 1 : 0;
    EXPECT_NEAR(found[0].camera_from_marker.z(), 2.8, 0.12);
  }
  EXPECT_LE(mistaken, 2);  // a guess would be mistaken in 6 of 12
}

TEST(MarkerDetector, ShownWithAWrongSideItScalesTheDistanceByAsMuch) {
  cv::Mat image = empty_view();
  draw(image, 7, marker_at(0.05, 0.02, 1.0, 0.3));
  const auto right = find_markers(image, test::pinhole(), kSideM);
  const auto wrong = find_markers(image, test::pinhole(), 1.5 * kSideM);
  ASSERT_EQ(right.size(), 1U);
  ASSERT_EQ(wrong.size(), 1U);
  EXPECT_NEAR(wrong[0].camera_from_marker.z(), 1.5 * right[0].camera_from_marker.z(), 0.002);
}

TEST(MarkerDetector, TellsTwoMarkersApart) {
  cv::Mat image = empty_view();
  draw(image, 7, marker_at(-0.3, 0.0, 1.2, 0.2));
  draw(image, 12, marker_at(0.3, 0.0, 1.0, -0.2));
  const auto found = find_markers(image, test::pinhole(), kSideM);
  ASSERT_EQ(found.size(), 2U);
  for (const auto& s : found) {
    EXPECT_TRUE(s.id == 7 || s.id == 12);
    EXPECT_NEAR(s.camera_from_marker.x(), s.id == 7 ? -0.3 : 0.3, 0.01);
  }
}

TEST(MarkerDetector, SeesNothingWhereNoMarkerIsOrItIsCutOffByTheImagesEdgeOrHidden) {
  EXPECT_TRUE(find_markers(empty_view(), test::pinhole(), kSideM).empty());
  cv::Mat cut = empty_view();
  draw(cut, 7, marker_at(0.68, 0.0, 1.0, 0.0));  // its right quarter is outside
  EXPECT_TRUE(find_markers(cut, test::pinhole(), kSideM).empty());
  cv::Mat hidden = empty_view();
  draw(hidden, 7, marker_at(0.0, 0.0, 1.0, 0.0));
  cv::rectangle(hidden, cv::Rect(300, 200, 20, 80), cv::Scalar(128), cv::FILLED);
  EXPECT_TRUE(find_markers(hidden, test::pinhole(), kSideM).empty());
}

TEST(MarkerDetector, BearsWithWhatIsNoImageAndNoSize) {
  EXPECT_TRUE(find_markers(cv::Mat(), test::pinhole(), kSideM).empty());
  cv::Mat image = empty_view();
  draw(image, 7, marker_at(0.0, 0.0, 1.0, 0.0));
  for (const double side : {0.0, -1.0, std::numeric_limits<double>::infinity(),
                            std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_TRUE(find_markers(image, test::pinhole(), side).empty()) << side;
  }
  cv::Mat noise(480, 640, CV_8UC1);
  cv::theRNG().state = 11;
  cv::randu(noise, 0, 256);
  for (const auto& s : find_markers(noise, test::pinhole(), kSideM)) {
    EXPECT_TRUE(std::isfinite(s.camera_from_marker.norm()));
  }
}

}  // namespace
}  // namespace rovigo::slam
