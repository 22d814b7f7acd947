#pragma once
// Every setting of slam, with its unit; defaults suit the Leo-like rover and a D455-like camera.

#include "maps/settings.h"
#include "slam/depth_filter_config.h"

namespace rovigo::slam {

struct FeatureConfig {
  int features_per_frame = 1000;  ///< ORB keypoints spread over the image
  int pyramid_levels = 6;
  double pyramid_scale = 1.2;
  int corner_threshold = 20;      ///< FAST contrast, grey levels
  int weak_corner_threshold = 7;  ///< tried again where a cell of the image stays empty

  void describe(maps::SettingsVisitor& v);
};

struct DepthConfig {
  double min_depth_m = 0.3;
  double max_depth_m = 6.0;       ///< returns beyond it are not used at all
  double sigma_at_1m_m = 0.0022;  ///< depth noise grows with the square of the depth

  void describe(maps::SettingsVisitor& v);
};

struct DeadReckoningConfig {
  double gyro_sigma_rad_s = 0.004;        ///< of one sample
  double gyro_bias_sigma_rad_s = 0.02;    ///< before anything is known
  double gyro_bias_walk_rad_s2 = 1.0e-4;  ///< per square root of a second
  double gyro_delay_s = 0.005;            ///< a sample is the mean of some time before its stamp
  double gyro_delay_sigma_s = 0.005;      ///< filters and clocks differ; looks at the world show it
  double wheel_speed_scale_sigma = 0.05;  ///< nominal wheel radius may be off by this share
  double wheel_turn_scale_sigma = 0.08;   ///< nominal track may be off by this share
  double wheel_speed_sigma_m_s = 0.02;    ///< of one wheel-speed reading
  double wheel_turn_sigma_rad_s = 0.03;
  double slip_gate = 4.0;  ///< wheels and gyro apart by so many sigmas: the wheels slip

  void describe(maps::SettingsVisitor& v);
};

struct TrackingConfig {
  int min_inliers = 15;                 ///< fewer matches that agree: the frame is not trusted
  double search_radius_px = 14.0;       ///< around the predicted place of a landmark
  int max_descriptor_distance = 64;     ///< of 256 bits
  double pixel_sigma = 0.8;             ///< of a keypoint on the finest pyramid level
  double smear_s = 0.003;               ///< exposure and rolling shutter: turning blurs and shears
  double rolling_shutter_s = 0.0;       ///< first row to last, where the recording does not tell
  double free_motion_sigma_m = 0.002;   ///< a hand-held camera's departure from constant velocity
  double plane_height_sigma_m = 0.006;  ///< a rover stays on the floor
  double plane_tilt_sigma_rad = 0.006;
  double keyframe_distance_m = 0.40;
  double keyframe_angle_rad = 0.25;
  double keyframe_min_overlap = 0.55;  ///< share of the reference's landmarks still tracked

  void describe(maps::SettingsVisitor& v);
};

struct LoopConfig {
  bool loop_closure = true;
  int min_loop_inliers = 25;
  double loop_search_radius_m = 3.0;  ///< beyond the predicted uncertainty

  void describe(maps::SettingsVisitor& v);
};

struct GridConfig {
  double grid_resolution_m = 0.05;
  double obstacle_min_height_m = 0.05;  ///< lower surfaces are floor
  double obstacle_max_height_m = 0.50;  ///< higher surfaces can be driven under
  double mapping_range_m = 6.0;         ///< depth beyond it is too noisy to mark obstacles

  void describe(maps::SettingsVisitor& v);
};

struct LocalizerConfig {
  int relocalization_inliers = 30;  ///< matches that must agree before a place is believed
  int confirmation_frames = 3;      ///< frames in a row that must agree with it
  double degraded_after_s = 0.4;    ///< without a correction
  double lost_sigma_m = 0.15;       ///< dead-reckoned beyond this: lost

  void describe(maps::SettingsVisitor& v);
};

/// All settings of slam; the parts group what one component reads.
struct SlamConfig {
  FeatureConfig features;
  DepthConfig depth;
  DepthFilterConfig depth_filter;
  DeadReckoningConfig dead_reckoning;
  TrackingConfig tracking;
  LoopConfig loop;
  GridConfig grid;
  LocalizerConfig localizer;

  void describe(maps::SettingsVisitor& v);
};

}  // namespace rovigo::slam
