// The reference inflation's blur against SciPy: our own small golden file, and every integer figure
// of the shared golden file where that is at hand.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <sstream>

#include "maps/gaussian_blur.h"
#include "tests/unit/maps/test_support.h"

namespace rovigo::maps {
namespace {

TEST(GoldenBlur, EqualsSciPyOnSmallGrids) {
  std::ifstream file(ROVIGO_SOURCE_DIR "/tests/golden/maps_blur.txt");
  ASSERT_TRUE(file) << "tests/golden/maps_blur.txt is missing";
  std::string word;
  int cases = 0;
  int width = 0;
  int height = 0;
  double sigma = 0.0;
  while (file >> word >> width >> height >> sigma) {
    ASSERT_EQ(word, "case");
    ++cases;
    std::vector<std::uint8_t> image;
    std::string row;
    for (int y = 0; y < height; ++y) {
      file >> row;
      for (const char c : row) image.push_back(c == '#');
    }
    std::vector<int> expected(image.size());
    for (int& v : expected) file >> v;
    const auto blurred = blur_like_scipy(image, width, height, sigma);
    EXPECT_EQ(std::vector<int>(blurred.begin(), blurred.end()), expected)
        << width << " x " << height << ", sigma " << sigma;
  }
  EXPECT_EQ(cases, 35);
}

constexpr int kSide = 101;
constexpr int kMiddle = 50;

/// The pictures the shared golden script draws, blurred.
class Picture {
 public:
  template <class IsObstacle>
  Picture(double sigma, IsObstacle is_obstacle) {
    std::vector<std::uint8_t> image;
    for (int y = 0; y < kSide; ++y) {
      for (int x = 0; x < kSide; ++x) image.push_back(is_obstacle(x, y));
    }
    blurred_ = blur_like_scipy(image, kSide, kSide, sigma);
  }
  int at(int x, int y) const { return blurred_[static_cast<std::size_t>(y * kSide + x)]; }
  int count_row(int y, int first_x) const {
    int n = 0;
    for (int x = first_x; x < kSide; ++x) n += at(x, y) > 0;
    return n;
  }
  /// Lethal cells on the diagonal beyond the corner.
  int diagonal() const {
    int n = 0;
    while (at(kMiddle + 1 + n, kMiddle + 1 + n) > 0) ++n;
    return n;
  }

 private:
  std::vector<std::uint8_t> blurred_;
};

/// One line of the shared golden file, from our blur.
std::string figures(int s) {
  const int c = kMiddle;
  const Picture lone(s, [&](int x, int y) { return x == c && y == c; });
  const Picture wall(s, [&](int x, int) { return x == c; });
  const Picture two(s, [&](int x, int) { return x == c || x == c + 1; });
  const Picture half(s, [&](int x, int) { return x <= c; });
  const Picture corner(s, [&](int x, int y) { return x <= c && y <= c; });
  const Picture angle(s, [&](int x, int y) { return (x == c && y <= c) || (y == c && x <= c); });
  int area = 0;
  int farthest = -1;
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      if (lone.at(x, y) == 0) continue;
      ++area;
      farthest = std::max(farthest, (x - c) * (x - c) + (y - c) * (y - c));
    }
  }
  const int radius = lone.at(c, c) > 0 ? (lone.count_row(c, 0) - 1) / 2 : -1;
  std::string first;
  for (int i = 1; i <= 6; ++i) first += (i > 1 ? ", " : "") + std::to_string(half.at(c + i, c));
  char text[400];
  std::snprintf(text, sizeof text,
                "sigma %d iso: centre value %d radius(axis) %d maxd %.2f area %d | 1-cell wall: "
                "peak %d r %d | 2-cell wall r %d | half-plane r %d first free-side vals [%s] | "
                "convex corner diag cells %d | thin L outer diag %d",
                s, lone.at(c, c), radius, farthest >= 0 ? std::sqrt(farthest) : -1.0, area,
                wall.at(c, c), (wall.count_row(c, 0) - 1) / 2, two.count_row(c, c + 2),
                half.count_row(c, c + 1), first.c_str(), corner.diagonal(), angle.diagonal());
  return text;
}

TEST(GoldenBlur, ReproducesEveryFigureOfTheSharedFile) {
  const auto path = test::shared_data() / "golden/gaussian_inflation.txt";
  std::ifstream file(path);
  if (!file) GTEST_SKIP() << path << " is not here";
  int lines = 0;
  for (std::string line; std::getline(file, line);) {
    const std::size_t at = line.find(" sigma ");
    if (line.rfind("int", 0) != 0 && line.rfind("uint", 0) != 0) continue;
    ASSERT_NE(at, std::string::npos);
    EXPECT_EQ(line.substr(at + 1), figures(line[at + 7] - '0'));
    ++lines;
  }
  EXPECT_EQ(lines, 12);
}

TEST(GoldenBlur, ReproducesTheSharedBlockAndTheTwoCells) {
  const auto path = test::shared_data() / "golden/gaussian_inflation.txt";
  std::ifstream file(path);
  if (!file) GTEST_SKIP() << path << " is not here";
  std::stringstream text;
  text << file.rdbuf();

  std::vector<std::uint8_t> lone(81);
  lone[40] = 1;
  std::string expected = text.str().substr(text.str().find(" [["));
  expected.resize(expected.find("]]"));
  std::erase_if(expected, [](char ch) { return ch == '[' || ch == ']'; });
  std::istringstream theirs(expected);
  for (const int ours : blur_like_scipy(lone, 9, 9, 2.0)) {
    int value = -1;
    theirs >> value;
    EXPECT_EQ(ours, value);
  }

  std::vector<std::uint8_t> two(41 * 41);
  two[20 * 41 + 20] = two[20 * 41 + 22] = 1;
  int area = 0;
  for (const int v : blur_like_scipy(two, 41, 41, 2.0)) area += v > 0;
  EXPECT_NE(text.str().find("two cells s=2 nonzero area " + std::to_string(area) + " "),
            std::string::npos);
}

}  // namespace
}  // namespace rovigo::maps
