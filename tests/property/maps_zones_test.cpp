// No-go zones on random polygons: no point of a zone lies in a cell that is not blocked, and no
// cell is blocked that the zone does not touch.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

#include "maps/zones.h"

namespace rovigo::maps {
namespace {

bool is_inside(const std::vector<TPoint2D>& polygon, const TPoint2D& p) {
  bool inside = false;
  for (std::size_t i = 0, j = polygon.size() - 1; i < polygon.size(); j = i++) {
    const TPoint2D& a = polygon[i];
    const TPoint2D& b = polygon[j];
    if ((a.y > p.y) == (b.y > p.y)) continue;
    if (p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x)) inside = !inside;
  }
  return inside;
}

/// Does the segment touch the box, grown by a hair? (Liang & Barsky's clipping)
bool touches(const TPoint2D& a, const TPoint2D& b, TPoint2D low, TPoint2D high) {
  double from = 0.0;
  double to = 1.0;
  const auto clip = [&](double start, double step, double least, double most) {
    if (step == 0.0) return start >= least && start <= most;
    const double t0 = (least - start) / step;
    const double t1 = (most - start) / step;
    from = std::max(from, std::min(t0, t1));
    to = std::min(to, std::max(t0, t1));
    return true;
  };
  const double hair = 1e-9;
  return clip(a.x, b.x - a.x, low.x - hair, high.x + hair) &&
         clip(a.y, b.y - a.y, low.y - hair, high.y + hair) && from <= to;
}

struct Case {
  std::mt19937_64 rng;
  NoGoZone zone;
  OccupancyGrid mask;
};

Case random_case(std::uint64_t seed) {
  Case c{std::mt19937_64(seed), {"zone", {}}, {}};
  std::uniform_real_distribution<double> at(-1.0, 4.0);
  const std::size_t corners = 1 + c.rng() % 8;
  for (std::size_t i = 0; i < corners; ++i) c.zone.corners.emplace_back(at(c.rng), at(c.rng));
  if (seed % 3 == 0) {  // corners and edges right on cell borders
    for (TPoint2D& p : c.zone.corners) {
      p = {0.1 * std::floor(10 * p.x), 0.1 * std::floor(10 * p.y)};
    }
  }
  c.mask = keepout_mask({0.1, {0.0, 0.0}, 30, 25}, {c.zone});
  return c;
}

/// Runs `check` on random zones; failures name the seed.
template <class Check>
void on_random_zones(Check check) {
  for (std::uint64_t seed = 1; seed <= 120; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Case c = random_case(seed);
    check(c.rng, c.zone, c.mask);
  }
}

TEST(RandomZones, NoPointOfTheZoneIsLeftOpen) {
  on_random_zones([](std::mt19937_64& rng, const NoGoZone& zone, const OccupancyGrid& mask) {
    std::uniform_real_distribution<double> at(0.0, 3.0);
    std::uniform_real_distribution<double> share(0.0, 1.0);
    const auto expect_blocked = [&](const TPoint2D& p) {
      const Cell c = mask.geometry.cell_at(p);
      if (!mask.geometry.contains(c)) return;
      EXPECT_TRUE(OccupancyGrid::is_occupied(mask.at(c))) << p.x << ", " << p.y;
    };
    for (int i = 0; i < 500; ++i) {
      const TPoint2D p{at(rng), at(rng)};
      if (is_inside(zone.corners, p)) expect_blocked(p);
      const TPoint2D& a = zone.corners[static_cast<std::size_t>(i) % zone.corners.size()];
      const TPoint2D& b = zone.corners[static_cast<std::size_t>(i + 1) % zone.corners.size()];
      const double t = share(rng);
      expect_blocked({a.x + t * (b.x - a.x), a.y + t * (b.y - a.y)});
    }
  });
}

TEST(RandomZones, NoCellIsBlockedThatTheZoneDoesNotTouch) {
  on_random_zones([](std::mt19937_64&, const NoGoZone& zone, const OccupancyGrid& mask) {
    for (std::size_t i = 0; i < mask.cells.size(); ++i) {
      if (!OccupancyGrid::is_occupied(mask.cells[i])) continue;
      const TPoint2D center = mask.geometry.center_of(mask.geometry.cell_of(i));
      const TPoint2D low{center.x - 0.05, center.y - 0.05};
      const TPoint2D high{center.x + 0.05, center.y + 0.05};
      bool touched = is_inside(zone.corners, center);
      for (std::size_t k = 0; k < zone.corners.size(); ++k) {
        touched |= touches(zone.corners[k], zone.corners[(k + 1) % zone.corners.size()], low, high);
      }
      EXPECT_TRUE(touched) << "cell at " << center.x << ", " << center.y;
    }
  });
}

}  // namespace
}  // namespace rovigo::maps
