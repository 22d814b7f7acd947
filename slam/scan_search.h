#pragma once
// Where in a grid does a scan fit? All places, found exactly: correlative scan matching (Olson
// 2009) with branch and bound (Hess et al. 2016). It also says where else the scan fits as well,
// which no local search can.

#include <cstdint>
#include <queue>
#include <vector>

#include "maps/occupancy_grid.h"

namespace rovigo::slam {

struct ScanPlace {
  TPose2D map_from_scan;
  double share = 0.0;  ///< of the points, those on walls; unseen ground counts a little
};

struct ScanSearchResult {
  std::vector<ScanPlace> places;  ///< best first, no two within half a metre and 20 deg
  bool complete = true;           ///< false: too much fits alike, there may be more
};

class ScanSearch {
 public:
  explicit ScanSearch(const maps::OccupancyGrid& grid);

  /// At most `most` places where at least `min_share` of the points fit, and at most `below_best`
  /// less than at the best. `points` in the scan's frame, whose origin the rover stands on: it is
  /// not inside an obstacle.
  ScanSearchResult find(const std::vector<TPoint2D>& points, double min_share, double below_best,
                        std::size_t most) const;

 private:
  static constexpr int kLevels = 6;  ///< windows of 1, 2, .. 32 cells

  struct Node {
    int score = 0;
    int level = 0;
    int heading = 0;
    int x = 0, y = 0;  ///< lowest cell of the origin
    bool operator<(const Node& other) const;
  };
  using Cells = std::vector<maps::Cell>;

  struct Search {
    std::vector<Cells> turned;  ///< the scan's points as cells, by heading
    std::priority_queue<Node> open;
    int least = 0;  ///< score that is good enough
    std::size_t nodes = 0;
  };

  void widen(int level);
  std::vector<Cells> turn(const std::vector<TPoint2D>& points) const;
  void consider(Search& search, int level, int heading, int x, int y) const;
  int window(int level, int x, int y) const;
  int score(const Cells& cells, int level, int x, int y) const;
  bool may_stand(int x, int y) const;

  maps::GridGeometry geometry_;
  int stride_ = 0, rows_ = 0;
  std::vector<std::vector<std::uint8_t>> windows_;  ///< by level: the best score in the window
  std::vector<bool> blocked_;
};

}  // namespace rovigo::slam
