#include "app/simulated_drive.h"

#include <openssl/evp.h>

#include <array>
#include <bit>
#include <memory>
#include <stdexcept>

#include "control/look_around.h"

namespace rovigo::app {

namespace {

class Sha256 {
 public:
  Sha256() : context_(EVP_MD_CTX_new(), EVP_MD_CTX_free) {
    static_assert(std::endian::native == std::endian::little,
                  "the hash is over little-endian doubles");
    if (!context_ || EVP_DigestInit_ex(context_.get(), EVP_sha256(), nullptr) != 1) {
      throw std::runtime_error("SHA-256 is not available");
    }
  }
  void add(const void* bytes, std::size_t size) { EVP_DigestUpdate(context_.get(), bytes, size); }
  std::string hex() {
    std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
    unsigned int size = 0;
    EVP_DigestFinal_ex(context_.get(), digest.data(), &size);
    std::string text;
    constexpr char kDigits[] = "0123456789abcdef";
    for (unsigned int i = 0; i < size; ++i) {
      text += kDigits[digest[i] >> 4];
      text += kDigits[digest[i] & 15];
    }
    return text;
  }

 private:
  std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)> context_;
};

}  // namespace

void DriveLoop::advance(const TTwist2D& command) {
  for (int i = 0; i < kStepsPerCommand; ++i) {
    simulator_.step(command);
    const auto told = simulator_.take_observations();
    for (const auto& observation : sensor_faults_.pass(simulator_, simulator_.time_s(), told)) {
      poses_.observe(*observation);
    }
    if (!hooks_.observation) continue;
    for (const auto& observation : told) hooks_.observation(*observation);
  }
}

void DriveLoop::stand_still(double seconds) {
  const double until = simulator_.time_s() + seconds;
  while (simulator_.time_s() < until) advance(TTwist2D());
}

TPose2D DriveLoop::true_pose() const {
  return maps::compose(map_from_world_, TPose2D(simulator_.truth().world_from_base.asTPose()));
}

void DriveLoop::step(control::DriveController& controller, double begin_s, control::DriveLog& log) {
  const double now = simulator_.time_s();
  const control::PoseInput pose = pose_faults_.pass(simulator_, now, poses_.pose(now));
  control::GuardInput in;
  if (!simulator_.fault(sim::FaultKind::kSetPointsStop)) {
    last_ =
        control::concerns_drive(guard_.cause()) ? controller.hold(now) : controller.step(now, pose);
    in.set_point = last_.command;
  }
  in.now_s = now;
  in.pose = pose;
  in.battery_v = simulator_.battery_v();
  in.manual = simulator_.fault(sim::FaultKind::kManualTakeover) != nullptr;
  in.looks_around = looks_around_;

  control::DriveStep step;
  step.command = guard_.pass(in);
  step.held = log.held = guard_.cause();
  step.time_s = now - begin_s;
  step.true_pose = true_pose();
  step.estimated_pose = pose.map_from_base;
  step.quality = pose.quality;
  step.sigma_position_m = pose.sigma_position_m;
  step.true_twist = simulator_.truth().twist;
  step.reference = last_.reference;
  step.heading_error_rad = last_.heading_error_rad;
  step.cross_track_error_m = last_.cross_track_error_m;
  if (looks_around_ && !log.steps.empty()) step.reference = log.steps.back().reference;
  log.steps.push_back(step);
  log.status = last_.status;
  if (log.status == control::TrackStatus::kRunning && guard_.out_of_patience(now)) {
    log.status = control::TrackStatus::kStopped;
  }
}

bool DriveLoop::look_around(std::optional<double> facing_rad, double begin_s,
                            control::DriveLog& log) {
  control::LookAround search(facing_rad);
  looks_around_ = true;
  log.status = control::TrackStatus::kRunning;
  while (log.status == control::TrackStatus::kRunning) {
    step(search, begin_s, log);
    advance(log.steps.back().command);
  }
  looks_around_ = false;
  return log.status == control::TrackStatus::kReached;
}

namespace {

constexpr int kMostLooksAround = 3;

/// The estimator says that it does not know; poses that do not come are another matter.
bool pose_is_lost(const control::DriveLog& log) {
  const bool ended =
      log.status == control::TrackStatus::kPoseLost || log.status == control::TrackStatus::kStopped;
  return ended &&
         (log.held == control::StopCause::kNone || log.held == control::StopCause::kLostPoses);
}

/// Looks around and plans anew; the drive has ended where this finds no pose, or no way.
std::unique_ptr<control::DriveController> find_again(DriveLoop& loop, const DriveRecovery& recovery,
                                                     double begin_s, control::DriveLog& log) {
  ++log.looked_around;
  std::unique_ptr<control::DriveController> next;
  if (loop.look_around(std::nullopt, begin_s, log)) {
    next = recovery.plan_anew(log.steps.back().estimated_pose, log);
  }
  log.status = next ? control::TrackStatus::kRunning : control::TrackStatus::kPoseLost;
  return next;
}

}  // namespace

control::DriveLog drive_in_simulator(sim::Simulator& simulator, const TPose2D& world_from_map,
                                     PoseSource& poses, control::DriveController& controller,
                                     double planned_duration_s, const RovigoConfig& config,
                                     const DriveHooks& hooks) {
  DriveLoop loop(simulator, world_from_map, poses, config, hooks);
  control::DriveLog log;
  if (hooks.recovery) {
    control::DriveLog before;  // no part of the drive
    log.start_known =
        loop.look_around(hooks.recovery->start_heading_rad, simulator.time_s(), before);
  }
  loop.stand_still(kStandBeforeS);
  const int contacts_before = simulator.truth().contact_events;
  const double begin_s = simulator.time_s();
  std::unique_ptr<control::DriveController> anew;
  control::DriveController* driver = &controller;
  while (log.status == control::TrackStatus::kRunning) {
    loop.step(*driver, begin_s, log);
    loop.advance(log.steps.back().command);
    if (hooks.progress && planned_duration_s > 0.0) {
      hooks.progress(log.steps.back().time_s / planned_duration_s);
    }
    if (hooks.recovery && pose_is_lost(log) && log.looked_around < kMostLooksAround) {
      anew = find_again(loop, *hooks.recovery, begin_s, log);
      driver = anew.get();
    }
  }
  loop.stand_still(kStandAfterS);
  log.contact_events = simulator.truth().contact_events - contacts_before;
  if (log.contact_events > 0) log.touched = simulator.truth().touched;
  return log;
}

std::string log_hash(const control::DriveLog& log) {
  Sha256 hash;
  for (std::size_t i = 0; i < log.steps.size(); ++i) {
    const control::DriveStep& s = log.steps[i];
    const std::array<double, 9> row{static_cast<double>(i), s.true_pose.x,      s.true_pose.y,
                                    s.true_pose.phi,        s.estimated_pose.x, s.estimated_pose.y,
                                    s.estimated_pose.phi,   s.command.vx,       s.command.omega};
    hash.add(row.data(), sizeof row);
  }
  return hash.hex();
}

std::string sha256(std::string_view bytes) {
  Sha256 hash;
  hash.add(bytes.data(), bytes.size());
  return hash.hex();
}

}  // namespace rovigo::app
