#pragma once
// Coordinate frames and how they sit on each other, as ROS's tf tells it.

#include <mrpt/poses/CPose3D.h>

#include <map>
#include <optional>
#include <string>

namespace rovigo::slam {

/// A forest of frames. What a rover is bolted together from stands still, so the first pose told
/// for a frame is kept, and frames the rover moves in (odom, map, world) connect nothing.
class FrameTree {
 public:
  void add(const std::string& parent, const std::string& child,
           const mrpt::poses::CPose3D& parent_from_child);
  bool contains(const std::string& frame) const;
  /// target_from_source; empty when nothing connects the two. Loops are no way.
  std::optional<mrpt::poses::CPose3D> find(const std::string& target,
                                           const std::string& source) const;

 private:
  struct Link {
    std::string parent;
    mrpt::poses::CPose3D parent_from_child;
  };
  /// The frames from `frame` up to its root, each with the pose of `frame` in it.
  std::map<std::string, mrpt::poses::CPose3D> ancestors(const std::string& frame) const;

  std::map<std::string, Link> links_;  ///< by child
};

}  // namespace rovigo::slam
