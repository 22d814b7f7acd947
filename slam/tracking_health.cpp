#include "slam/tracking_health.h"

namespace rovigo::slam {

namespace {

constexpr double kContradictedForS = 0.6;
constexpr int kContradictingFrames = 3;
// Somebody who stands in the way for so long may as well have carried the rover off.
constexpr double kHiddenForS = 3.0;
constexpr int kConfirmingFrames = 4;

}  // namespace

void TrackingHealth::update(const FrameEvidence& frame) {
  if (state_ == TrackingState::kTracking && !frame.tracked) doubted_since_s_ = frame.time_s;
  if (frame.tracked) {
    broken_ = false;
    doubts_ = contradictions_ = 0;
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
  const bool contradicts = frame.verdict == ViewVerdict::kContradicts;
  if (!frame.continuous) broken_ = true;
  if (frame.verdict == ViewVerdict::kAgrees) {
    broken_ = false;
    doubts_ = contradictions_ = 0;
  }
  // In an unbroken view a landmark that should be there and is not was a ghost, or is behind a wall
  // of a room that is being entered.
  if (broken_ && (contradicts || frame.verdict == ViewVerdict::kHidden)) {
    if (doubts_++ == 0) hidden_since_s_ = frame.time_s;
    if (contradicts && contradictions_++ == 0) contradicted_since_s_ = frame.time_s;
  }
  const bool contradicted = contradictions_ >= kContradictingFrames &&
                            frame.time_s - contradicted_since_s_ >= kContradictedForS;
  const bool hidden = doubts_ > 0 && frame.time_s - hidden_since_s_ >= kHiddenForS;
  if (contradicted || hidden || frame.carried) state_ = TrackingState::kLost;
}

void TrackingHealth::found_elsewhere() {
  state_ = TrackingState::kConfirming;
  confirmations_ = 0;
}

void TrackingHealth::found_for_sure() {
  state_ = TrackingState::kConfirming;
  confirmations_ = kConfirmingFrames - 1;
}

}  // namespace rovigo::slam
