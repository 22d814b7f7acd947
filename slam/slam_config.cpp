#include "slam/slam_config.h"

namespace rovigo::slam {

void FeatureConfig::describe(maps::SettingsVisitor& v) {
  v.integer({.name = "features_per_frame",
             .help = "Keypoints taken from each image.",
             .min = 100,
             .max = 5000,
             .advanced = false},
            features_per_frame);
  v.integer({.name = "pyramid_levels",
             .help = "Image scales searched for keypoints.",
             .min = 1,
             .max = 12},
            pyramid_levels);
  v.real({.name = "pyramid_scale",
          .help = "Ratio between neighbouring image scales.",
          .min = 1.05,
          .max = 2.0},
         pyramid_scale);
  v.integer({.name = "corner_threshold",
             .help = "Contrast in grey levels that makes a corner.",
             .min = 2,
             .max = 100},
            corner_threshold);
  v.integer({.name = "weak_corner_threshold",
             .help = "Contrast tried where a part of the image shows no corner.",
             .min = 2,
             .max = 100},
            weak_corner_threshold);
}

void DepthConfig::describe(maps::SettingsVisitor& v) {
  v.real({.name = "min_depth_m", .help = "Nearest depth used.", .min = 0.05, .max = 2.0},
         min_depth_m);
  v.real({.name = "max_depth_m", .help = "Farthest depth used.", .min = 0.5, .max = 20.0},
         max_depth_m);
  v.real({.name = "depth_sigma_at_1m_m",
          .help = "Depth noise at one metre; it grows with the square of the depth.",
          .min = 0.0001,
          .max = 0.1},
         sigma_at_1m_m);
}

void DeadReckoningConfig::describe(maps::SettingsVisitor& v) {
  v.real({.name = "gyro_sigma_rad_s", .help = "Noise of one gyro sample.", .min = 1e-5, .max = 1.0},
         gyro_sigma_rad_s);
  v.real({.name = "gyro_bias_sigma_rad_s",
          .help = "How large the gyro's bias may be at the start.",
          .min = 0.0,
          .max = 1.0},
         gyro_bias_sigma_rad_s);
  v.real({.name = "gyro_bias_walk_rad_s2",
          .help = "Drift of the gyro's bias per square root of a second.",
          .min = 0.0,
          .max = 0.1},
         gyro_bias_walk_rad_s2);
  v.real({.name = "gyro_delay_s",
          .help = "How late the gyro tells of a turn, as far as known before anything is seen.",
          .min = -0.1,
          .max = 0.1},
         gyro_delay_s);
  v.real({.name = "gyro_delay_sigma_s",
          .help = "How wrong gyro_delay_s may be; the delay is learned while driving.",
          .min = 0.0,
          .max = 0.1},
         gyro_delay_sigma_s);
  v.real({.name = "wheel_speed_scale_sigma",
          .help = "How wrong the nominal wheel radius may be, as a share.",
          .min = 0.0,
          .max = 0.5},
         wheel_speed_scale_sigma);
  v.real({.name = "wheel_turn_scale_sigma",
          .help = "How wrong the nominal track may be, as a share.",
          .min = 0.0,
          .max = 0.5},
         wheel_turn_scale_sigma);
  v.real({.name = "wheel_speed_sigma_m_s",
          .help = "Noise of the speed that the wheels report.",
          .min = 1e-4,
          .max = 1.0},
         wheel_speed_sigma_m_s);
  v.real({.name = "wheel_turn_sigma_rad_s",
          .help = "Noise of the turn rate that the wheels report.",
          .min = 1e-4,
          .max = 1.0},
         wheel_turn_sigma_rad_s);
  v.real({.name = "slip_gate",
          .help = "Disagreement of wheels and gyro, in sigmas, that is taken for slip.",
          .min = 1.0,
          .max = 20.0},
         slip_gate);
}

void TrackingConfig::describe(maps::SettingsVisitor& v) {
  v.integer({.name = "min_inliers",
             .help = "Fewest agreeing matches for a frame's pose to be trusted.",
             .min = 6,
             .max = 500},
            min_inliers);
  v.real({.name = "search_radius_px",
          .help = "Search radius around the predicted place of a landmark.",
          .min = 2.0,
          .max = 100.0},
         search_radius_px);
  v.integer({.name = "max_descriptor_distance",
             .help = "Most of 256 bits that may differ between two views of a landmark.",
             .min = 10,
             .max = 128},
            max_descriptor_distance);
  v.real({.name = "pixel_sigma",
          .help = "Noise of a keypoint on the finest image scale, in pixels.",
          .min = 0.1,
          .max = 5.0},
         pixel_sigma);
  v.real({.name = "smear_s",
          .help = "Share of a frame's time whose turning is taken as error of its keypoints.",
          .min = 0.0,
          .max = 0.1},
         smear_s);
  v.real({.name = "rolling_shutter_s",
          .help = "Time an image takes from its first row to its last, where the recording does "
                  "not tell; 0: all rows at once.",
          .min = 0.0,
          .max = 0.1},
         rolling_shutter_s);
  v.real({.name = "free_motion_sigma_m",
          .help = "How far a hand-held camera departs from constant velocity in one frame.",
          .min = 1e-4,
          .max = 1.0},
         free_motion_sigma_m);
  v.real({.name = "plane_height_sigma_m",
          .help = "How far a rover's base may leave the floor's plane.",
          .min = 1e-4,
          .max = 1.0},
         plane_height_sigma_m);
  v.real({.name = "plane_tilt_sigma_rad",
          .help = "How far a rover's base may pitch and roll on the floor.",
          .min = 1e-4,
          .max = 1.0},
         plane_tilt_sigma_rad);
  v.real({.name = "keyframe_distance_m",
          .help = "Travel after which a new keyframe is made.",
          .min = 0.02,
          .max = 5.0},
         keyframe_distance_m);
  v.real({.name = "keyframe_angle_rad",
          .help = "Turn after which a new keyframe is made.",
          .min = 0.02,
          .max = 2.0},
         keyframe_angle_rad);
  v.real({.name = "keyframe_min_overlap",
          .help = "A new keyframe is made when a smaller share of landmarks is still seen.",
          .min = 0.05,
          .max = 0.95},
         keyframe_min_overlap);
}

void LoopConfig::describe(maps::SettingsVisitor& v) {
  v.flag({.name = "loop_closure",
          .help = "Recognise places seen before and correct the map.",
          .advanced = false},
         loop_closure);
  v.integer({.name = "min_loop_inliers",
             .help = "Fewest agreeing matches for a loop to be believed.",
             .min = 8,
             .max = 500},
            min_loop_inliers);
  v.real({.name = "loop_search_radius_m",
          .help = "Distance within which keyframes are compared for loops, beyond the uncertainty.",
          .min = 0.1,
          .max = 50.0},
         loop_search_radius_m);
}

void GridConfig::describe(maps::SettingsVisitor& v) {
  v.real({.name = "grid_resolution_m",
          .help = "Size of a cell of the map.",
          .min = 0.01,
          .max = 0.5,
          .advanced = false},
         grid_resolution_m);
  v.real({.name = "obstacle_min_height_m",
          .help = "Lower surfaces count as floor.",
          .min = 0.01,
          .max = 1.0,
          .advanced = false},
         obstacle_min_height_m);
  v.real({.name = "obstacle_max_height_m",
          .help = "Higher surfaces can be driven under.",
          .min = 0.05,
          .max = 5.0,
          .advanced = false},
         obstacle_max_height_m);
  v.real({.name = "mapping_range_m",
          .help = "Farther surfaces are not marked as obstacles.",
          .min = 0.5,
          .max = 20.0,
          .advanced = false},
         mapping_range_m);
}

void LocalizerConfig::describe(maps::SettingsVisitor& v) {
  v.integer({.name = "relocalization_inliers",
             .help = "Fewest agreeing matches for a recognised place to be believed.",
             .min = 8,
             .max = 500},
            relocalization_inliers);
  v.integer({.name = "confirmation_frames",
             .help = "Frames in a row that must agree with a recognised place.",
             .min = 1,
             .max = 30},
            confirmation_frames);
  v.real({.name = "degraded_after_s",
          .help = "Time without a correction by the camera after which the pose is degraded.",
          .min = 0.05,
          .max = 10.0},
         degraded_after_s);
  v.real({.name = "lost_sigma_m",
          .help = "Position uncertainty beyond which a dead-reckoned pose is lost.",
          .min = 0.02,
          .max = 2.0},
         lost_sigma_m);
}

void SlamConfig::describe(maps::SettingsVisitor& v) {
  features.describe(v);
  depth.describe(v);
  depth_filter.describe(v);
  dead_reckoning.describe(v);
  tracking.describe(v);
  loop.describe(v);
  grid.describe(v);
  localizer.describe(v);
}

}  // namespace rovigo::slam
