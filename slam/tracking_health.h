#pragma once
// Whether the pose may be trusted: tracked, dead-reckoned, or contradicted by what the camera sees.

namespace rovigo::slam {

/// What one camera frame says about the pose believed.
struct FrameEvidence {
  double time_s = 0.0;
  bool tracked = false;
  bool plenty = false;          ///< shows enough features to be recognised by
  bool view_is_mapped = false;  ///< somebody looked this way from here before
  bool carried = false;         ///< the body turned while its wheels stood
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
  /// The place was recognised far from the believed pose.
  void found_elsewhere();

  /// Dead reckoning may be built upon: nothing has contradicted it.
  bool is_trusted() const {
    return state_ == TrackingState::kTracking ||
           (state_ == TrackingState::kReckoning && contradictions_ == 0);
  }
  /// When the camera first failed to agree; meaningful unless tracking.
  double doubted_since_s() const { return doubted_since_s_; }

 private:
  TrackingState state_ = TrackingState::kReckoning;
  int contradictions_ = 0;  ///< frames since the last tracked one that should have matched
  double contradicted_since_s_ = 0.0;
  double doubted_since_s_ = 0.0;
  int confirmations_ = 0;
};

}  // namespace rovigo::slam
