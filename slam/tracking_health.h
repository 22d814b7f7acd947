#pragma once
// Whether the pose may be trusted: tracked, dead-reckoned, or contradicted by what the camera sees.

namespace rovigo::slam {

/// What the depth image says of the landmarks that should be in view, where features said nothing.
enum class ViewVerdict {
  kSilent,       ///< too few to judge: a place or a direction that is not mapped
  kAgrees,       ///< they are where they should be: blur, or a change of light
  kHidden,       ///< something stands before them
  kContradicts,  ///< the camera looks through them: this is another place
};

/// What one camera frame says about the pose believed.
struct FrameEvidence {
  double time_s = 0.0;
  bool tracked = false;
  ViewVerdict verdict = ViewVerdict::kSilent;  ///< unless tracked
  bool carried = false;                        ///< the body turned while its wheels stood
  /// Its depth goes on from the last frame's (ViewContinuity): nobody carried the rover in between.
  bool continuous = false;
};

enum class TrackingState {
  kTracking,    ///< the camera agrees with the map
  kReckoning,   ///< wheels and gyro carry on; nothing speaks against them
  kLost,        ///< the camera sees something else than it must from here: carried elsewhere
  kConfirming,  ///< a place was recognised; the next frames have to agree
};

class TrackingHealth {
 public:
  TrackingState state() const { return state_; }
  /// Takes in one frame; `tracked` means against the map around the believed pose.
  void update(const FrameEvidence& frame);
  /// The place was recognised far from the believed pose: some frames have to agree.
  void found_elsewhere();
  /// Several views have shown already that it is this place: one more is enough.
  void found_for_sure();
  /// Dead reckoning has become worthless.
  void give_up() { state_ = TrackingState::kLost; }

  /// Dead reckoning may be built upon: nothing speaks against it.
  bool is_trusted() const {
    return state_ == TrackingState::kTracking ||
           (state_ == TrackingState::kReckoning && doubts_ == 0);
  }
  /// When the camera first failed to agree; meaningful unless tracking.
  double doubted_since_s() const { return doubted_since_s_; }

 private:
  TrackingState state_ = TrackingState::kReckoning;
  bool broken_ = false;  ///< the view jumped since it was last known to be right
  int doubts_ = 0;       ///< frames since then that hide or contradict what should be seen
  int contradictions_ = 0;
  double hidden_since_s_ = 0.0, contradicted_since_s_ = 0.0;
  double doubted_since_s_ = 0.0;
  int confirmations_ = 0;
};

}  // namespace rovigo::slam
