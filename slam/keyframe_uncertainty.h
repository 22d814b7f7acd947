#pragma once
// How well a keyframe is known against the map's first one.

#include "slam/landmark_map.h"
#include "slam/motion_model.h"

namespace rovigo::slam {

// Of a pose found by recognising the place.
inline constexpr double kFoundSigmaM = 0.05;
inline constexpr double kFoundSigmaRad = 0.03;

/// A keyframe is known against the map's first one as well as its parent, and a little worse.
/// `blind`: nothing but dead reckoning (`now`) ties the two.
void spread_uncertainty(const Keyframe& parent, const MotionPrediction& now, bool blind,
                        Keyframe& child);

/// A loop was closed: `now` is known about as well as the place it was seen from before.
void share_certainty(const Keyframe& seen_before, Keyframe& now);

}  // namespace rovigo::slam
