#include "slam/tracking_health.h"

namespace rovigo::slam {

namespace {

// A person who fills the view for a moment is no proof; a view that stays foreign is.
constexpr double kContradictedForS = 0.6;
constexpr int kContradictingFrames = 3;
constexpr int kConfirmingFrames = 4;

}  // namespace

void TrackingHealth::update(const FrameEvidence& frame) {
  if (state_ == TrackingState::kTracking && !frame.tracked) doubted_since_s_ = frame.time_s;
  if (frame.tracked) {
    contradictions_ = 0;
    const bool must_confirm =
        state_ == TrackingState::kLost || state_ == TrackingState::kConfirming;
    confirmations_ = must_confirm ? confirmations_ + 1 : 0;
    const bool confirmed = !must_confirm || confirmations_ >= kConfirmingFrames;
    state_ = confirmed ? TrackingState::kTracking : TrackingState::kConfirming;
    return;
  }
  confirmations_ = 0;
  if (state_ == TrackingState::kLost || state_ == TrackingState::kConfirming) {
    state_ = TrackingState::kLost;
    return;
  }
  state_ = TrackingState::kReckoning;
  if (frame.plenty && frame.view_is_mapped && contradictions_++ == 0) {
    contradicted_since_s_ = frame.time_s;
  }
  const bool contradicted = contradictions_ >= kContradictingFrames &&
                            frame.time_s - contradicted_since_s_ >= kContradictedForS;
  if (contradicted || frame.carried) state_ = TrackingState::kLost;
}

void TrackingHealth::found_elsewhere() {
  state_ = TrackingState::kConfirming;
  confirmations_ = 0;
}

}  // namespace rovigo::slam
