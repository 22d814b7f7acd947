#include "slam/recording/frame_tree.h"

#include <array>
#include <string_view>

namespace rovigo::slam {
namespace {

/// Between the rover and these frames lies its motion, not its build.
bool is_fixed_to_the_floor(std::string_view frame) {
  constexpr std::array<std::string_view, 4> kFloor = {"odom", "map", "world", "earth"};
  for (const std::string_view name : kFloor) {
    if (frame == name || frame.ends_with("/" + std::string(name))) return true;
  }
  return false;
}

}  // namespace

void FrameTree::add(const std::string& parent, const std::string& child,
                    const mrpt::poses::CPose3D& parent_from_child) {
  if (is_fixed_to_the_floor(parent) || parent == child) return;
  links_.try_emplace(child, Link{parent, parent_from_child});
}

bool FrameTree::contains(const std::string& frame) const {
  if (links_.contains(frame)) return true;
  for (const auto& [child, link] : links_) {
    if (link.parent == frame) return true;
  }
  return false;
}

std::map<std::string, mrpt::poses::CPose3D> FrameTree::ancestors(const std::string& frame) const {
  std::map<std::string, mrpt::poses::CPose3D> found;
  std::string at = frame;
  mrpt::poses::CPose3D at_from_frame;
  while (found.emplace(at, at_from_frame).second) {
    const auto link = links_.find(at);
    if (link == links_.end()) break;
    at_from_frame = link->second.parent_from_child + at_from_frame;
    at = link->second.parent;
  }
  return found;
}

std::optional<mrpt::poses::CPose3D> FrameTree::find(const std::string& target,
                                                    const std::string& source) const {
  const auto above_target = ancestors(target);
  // The common ancestor may be any: all give the same pose.
  for (const auto& [frame, frame_from_source] : ancestors(source)) {
    const auto met = above_target.find(frame);
    if (met != above_target.end()) return -met->second + frame_from_source;
  }
  return std::nullopt;
}

}  // namespace rovigo::slam
