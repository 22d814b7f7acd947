// A picture of a map for people.

#include <algorithm>
#include <cmath>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "maps/error.h"
#include "maps/export.h"

namespace rovigo::maps {
namespace {

constexpr int kMarginCells = 4;
constexpr int kWantedPixels = 1600;  // longer side
constexpr int kMaxScale = 12;
constexpr int kFooter = 36;  // pixels below the map, for the scale bar

const cv::Scalar kFree(252, 252, 252);
const cv::Scalar kUnknown(214, 210, 206);
const cv::Scalar kOccupied(52, 44, 40);
const cv::Scalar kRoute(200, 110, 30);
const cv::Scalar kStart(80, 160, 60);
const cv::Scalar kZone(60, 60, 220);
const cv::Scalar kPlace(30, 120, 230);
const cv::Scalar kInk(60, 60, 60);

/// The part of the grid worth showing, and how large a cell becomes.
struct Frame {
  Cell low;
  Cell high;  ///< inclusive
  int scale = 1;

  int width() const { return (high.x - low.x + 1) * scale; }
  int height() const { return (high.y - low.y + 1) * scale; }
};

Frame choose_frame(const OccupancyGrid& grid) {
  const GridGeometry& g = grid.geometry;
  Frame frame{{g.width, g.height}, {-1, -1}};
  for (std::size_t i = 0; i < grid.cells.size(); ++i) {
    if (OccupancyGrid::is_unknown(grid.cells[i])) continue;
    const Cell c = g.cell_of(i);
    frame.low = {std::min(frame.low.x, c.x), std::min(frame.low.y, c.y)};
    frame.high = {std::max(frame.high.x, c.x), std::max(frame.high.y, c.y)};
  }
  if (frame.high.x < 0) frame = {{0, 0}, {g.width - 1, g.height - 1}};
  frame.low = {std::max(frame.low.x - kMarginCells, 0), std::max(frame.low.y - kMarginCells, 0)};
  frame.high = {std::min(frame.high.x + kMarginCells, g.width - 1),
                std::min(frame.high.y + kMarginCells, g.height - 1)};
  frame.scale = std::clamp(kWantedPixels / std::max(frame.width(), frame.height()), 1, kMaxScale);
  return frame;
}

class Picture {
 public:
  explicit Picture(const OccupancyGrid& grid) : grid_(grid), frame_(choose_frame(grid)) {
    image_ = cv::Mat(frame_.height() + kFooter, frame_.width(), CV_8UC3, cv::Scalar::all(255));
    draw_cells();
  }
  cv::Mat& image() { return image_; }

  /// Sub-pixel place (in 1/16 pixel) of a point of the map frame.
  cv::Point at(const TPoint2D& p) const {
    const GridGeometry& g = grid_.geometry;
    const double x = ((p.x - g.origin.x) / g.resolution_m - frame_.low.x) * frame_.scale - 0.5;
    const double y = (frame_.high.y + 1 - (p.y - g.origin.y) / g.resolution_m) * frame_.scale - 0.5;
    const auto fixed = [](double v) { return static_cast<int>(std::clamp(v * 16.0, -1e6, 1e6)); };
    return {fixed(x), fixed(y)};
  }
  void dot(const TPoint2D& p, double radius_px, const cv::Scalar& color) {
    cv::circle(image_, at(p), static_cast<int>(16 * radius_px), color, cv::FILLED, cv::LINE_AA, 4);
  }
  void line(const std::vector<TPoint2D>& points, const cv::Scalar& color, int thickness) {
    std::vector<cv::Point> pixels;
    for (const TPoint2D& p : points) pixels.push_back(at(p));
    cv::polylines(image_, pixels, false, color, thickness, cv::LINE_AA, 4);
  }
  void zone(const std::vector<TPoint2D>& corners) {
    if (corners.empty()) return;
    std::vector<cv::Point> pixels;
    for (const TPoint2D& p : corners) pixels.push_back(at(p));
    cv::Mat tinted = image_.clone();
    cv::fillPoly(tinted, std::vector{pixels}, kZone, cv::LINE_AA, 4);
    cv::addWeighted(tinted, 0.25, image_, 0.75, 0.0, image_);
    cv::polylines(image_, pixels, true, kZone, 2, cv::LINE_AA, 4);
  }
  void label(const TPoint2D& p, const std::string& text) {
    const cv::Point pixel = at(p);
    write(text, {pixel.x / 16 + 8, pixel.y / 16 - 6});
  }
  /// A round length of about a quarter of the picture.
  void scale_bar() {
    const double pixels_per_m = frame_.scale / grid_.geometry.resolution_m;
    const double wanted_m = 0.25 * frame_.width() / pixels_per_m;
    const double power = std::pow(10.0, std::floor(std::log10(wanted_m)));
    const double meters = wanted_m >= 5.0 * power   ? 5.0 * power
                          : wanted_m >= 2.0 * power ? 2.0 * power
                                                    : power;
    const int y = frame_.height() + kFooter - 12;
    const int x = 8;
    const int end = x + static_cast<int>(std::lround(meters * pixels_per_m));
    cv::line(image_, {x, y}, {end, y}, kInk, 2);
    for (const int tick : {x, end}) cv::line(image_, {tick, y - 5}, {tick, y + 5}, kInk, 2);
    char text[32];
    std::snprintf(text, sizeof text, "%g m", meters);
    write(text, {end + 8, y + 5});
  }

 private:
  void write(const std::string& text, cv::Point where) {
    cv::putText(image_, text, where, cv::FONT_HERSHEY_SIMPLEX, 0.5, kInk, 1, cv::LINE_AA);
  }
  void draw_cells() {
    cv::Mat cells(frame_.high.y - frame_.low.y + 1, frame_.high.x - frame_.low.x + 1, CV_8UC3);
    for (int y = frame_.low.y; y <= frame_.high.y; ++y) {
      for (int x = frame_.low.x; x <= frame_.high.x; ++x) {
        const std::int8_t value = grid_.at({x, y});
        const cv::Scalar& color = OccupancyGrid::is_unknown(value)    ? kUnknown
                                  : OccupancyGrid::is_occupied(value) ? kOccupied
                                                                      : kFree;
        cells.at<cv::Vec3b>(frame_.high.y - y, x - frame_.low.x) =
            cv::Vec3b(static_cast<std::uint8_t>(color[0]), static_cast<std::uint8_t>(color[1]),
                      static_cast<std::uint8_t>(color[2]));
      }
    }
    cv::Mat top = image_.rowRange(0, frame_.height());
    cv::resize(cells, top, top.size(), 0.0, 0.0, cv::INTER_NEAREST);
  }

  const OccupancyGrid& grid_;
  Frame frame_;
  cv::Mat image_;
};

}  // namespace

Blob draw_map_png(const SavedMap& map) {
  if (map.grid.cells.empty()) throw InputError("the map's grid is empty: there is nothing to draw");
  Picture picture(map.grid);
  for (const NoGoZone& zone : map.zones) picture.zone(zone.corners);
  std::vector<TPoint2D> route;
  for (const StoredPose& p : map.trajectory) {
    route.emplace_back(p.map_from_base.x(), p.map_from_base.y());
  }
  picture.line(route, kRoute, 2);
  if (!route.empty()) picture.dot(route.front(), 5.0, kStart);
  for (const NamedPlace& place : map.places) {
    const TPoint2D at = position_of(place.pose);
    picture.dot(at, 4.0, kPlace);
    picture.label(at, place.name);
  }
  picture.scale_bar();
  Blob png;
  if (!cv::imencode(".png", picture.image(), png))
    throw InputError("the picture cannot be encoded");
  return png;
}

}  // namespace rovigo::maps
