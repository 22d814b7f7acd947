#pragma once
// Places that appearance and geometry suggested over several frames, each voting for where the
// odometry's frame lies in the map: what a turning rover sees of one place votes together, and a
// look-alike has to survive other views.

#include <optional>
#include <vector>

#include "slam/se3.h"

namespace rovigo::slam {

struct PlaceVote {
  Se3 map_from_odom;    ///< as the last view that voted for it says
  double weight = 0.0;  ///< sum over views, older ones fading
  int views = 0;        ///< that voted for it
  double last_s = 0.0;  ///< when one last did
};

class PlaceVotes {
 public:
  /// One view says the rover is at `map_from_base` while odometry says `odom_from_base`. Agreeing
  /// votes are joined; the heavier pose is not averaged but replaced: views only get better.
  void add(double time_s, const Se3& map_from_base, const Se3& odom_from_base, double weight);

  /// Fades all votes by one frame.
  void fade();

  /// The heaviest; ties go to the older.
  std::optional<PlaceVote> best() const;

  /// Weight of votes for where `map_from_base` is, and of the best vote for elsewhere.
  struct Split {
    double here = 0.0;
    double elsewhere = 0.0;
    int views_here = 0;
  };
  Split split(const Se3& map_from_base, const Se3& odom_from_base) const;

  /// Takes votes for this place out: it was tried and found wanting.
  void refute(const Se3& map_from_base, const Se3& odom_from_base);
  void clear() { votes_.clear(); }

 private:
  std::vector<PlaceVote> votes_;
};

}  // namespace rovigo::slam
