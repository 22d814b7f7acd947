#pragma once
// The map slam works on: keyframes, landmarks, and which saw which.

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "maps/map_file.h"
#include "slam/features.h"
#include "slam/se3.h"
#include "slam/wall_match.h"

namespace rovigo::slam {

struct Keyframe {
  int id = 0;
  double time_s = 0.0;
  Se3 map_from_base;
  FeatureSet features;
  std::vector<int> landmark_of;  ///< per feature; -1: none
  maps::Blob color_jpeg;
  maps::Blob depth_png;
  WallScan walls;  ///< empty unless on a floor
  /// Of (x, y, yaw) in the map frame, against the map's first keyframe.
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();

  /// A culled keyframe holds nothing any more but its place against another one, so that poses and
  /// evidence that hang on it follow the map.
  int host = -1;
  Se3 host_from_base;
  bool culled() const { return host >= 0; }
};

struct Sighting {
  int keyframe = 0;
  int feature = 0;
};

/// There are a hundred thousand: what need not be exact is in single precision.
struct Landmark {
  Eigen::Vector3d position_map = Eigen::Vector3d::Zero();
  Descriptor descriptor{};  ///< as last seen by a keyframe
  std::vector<Sighting> sightings;
  Eigen::Matrix3f covariance = Eigen::Matrix3f::Identity();
  Eigen::Vector3f direction_map = Eigen::Vector3f::Zero();  ///< unit, from it to that camera
  float distance_m = 0.0f;                                  ///< to that camera
  int predicted = 0;                                        ///< frames that should have seen it
  int tracked = 0;                                          ///< frames that did
  std::uint8_t octave = 0;                                  ///< in that view
  bool alive = true;
};

/// How measurements of one feature spread: pixel and depth noise.
struct MeasurementNoise {
  double pixel_sigma = 1.0;
  double depth_sigma_m = 0.01;
};
MeasurementNoise noise_of(const Feature& feature, const SlamConfig& config);

class LandmarkMap {
 public:
  LandmarkMap(const SlamConfig& config, const CameraModel& camera, const Se3& base_from_camera);

  const std::vector<Keyframe>& keyframes() const { return keyframes_; }
  const std::vector<Landmark>& landmarks() const { return landmarks_; }
  Keyframe& keyframe(int id) { return keyframes_[static_cast<std::size_t>(id)]; }
  const Keyframe& keyframe(int id) const { return keyframes_[static_cast<std::size_t>(id)]; }
  Landmark& landmark(int id) { return landmarks_[static_cast<std::size_t>(id)]; }
  const Landmark& landmark(int id) const { return landmarks_[static_cast<std::size_t>(id)]; }
  const CameraModel& camera() const { return camera_; }
  const Se3& base_from_camera() const { return base_from_camera_; }
  const SlamConfig& config() const { return config_; }

  /// Stores a view. Features matched to landmarks (`landmark_of`) sharpen those; the other
  /// features with depth become new landmarks. Returns the keyframe's id.
  int add_keyframe(Keyframe keyframe);

  /// Lets go of what a keyframe saw and no landmark came of; nothing asks for it later.
  void forget_unmatched(int keyframe);

  /// Lets go of all that a keyframe holds: its place follows `host` from now on.
  void cull_keyframe(int keyframe, int host);

  /// Replaces everything by what a map file held.
  void restore(std::vector<Keyframe> keyframes, std::vector<Landmark> landmarks) {
    keyframes_ = std::move(keyframes);
    landmarks_ = std::move(landmarks);
  }

  /// Notes that `keyframe` sees `landmark` at `feature`, unless it sees it elsewhere already.
  void add_sighting(int landmark, int keyframe, int feature);
  /// Takes a sighting out; a landmark without sightings is gone.
  void remove_sighting(int landmark, int index);

  /// Everything `from` was seen as becomes a sighting of `into`; `from` is gone.
  void merge_landmarks(int from, int into);

  /// Keyframes that were not culled.
  int living_keyframes() const;

  /// Keyframes that see at least `min_shared` of this one's landmarks, most shared first.
  std::vector<std::pair<int, int>> covisible(int keyframe, int min_shared) const;

  /// Keyframes ranked by how many of these landmarks they see.
  std::vector<std::pair<int, int>> observers(const std::vector<int>& landmarks) const;

  /// Living landmarks seen by any of these keyframes, each once, in ascending order.
  std::vector<int> landmarks_of(const std::vector<int>& keyframes) const;

  /// New poses for all keyframes; landmarks follow the keyframe that saw them first.
  void move_keyframes(const std::vector<Se3>& map_from_base);

  /// Landmarks that frames fail to find again are taken out.
  void cull(const std::vector<int>& candidates);

 private:
  void sight(int landmark, int keyframe, int feature);
  int new_landmark();
  void release(int landmark);
  Eigen::Vector3d measured_point(const Keyframe& k, int feature, Eigen::Matrix3d& covariance) const;

  SlamConfig config_;
  CameraModel camera_;
  Se3 base_from_camera_;
  std::vector<Keyframe> keyframes_;
  std::vector<Landmark> landmarks_;
  std::vector<int> free_landmarks_;  ///< dead ones, whose numbers serve again
};

}  // namespace rovigo::slam
