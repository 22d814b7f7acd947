// Any bytes as a trajectory and a stream of poses: the tracker refuses or stays within its limits.
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>

#include "control/command_limiter.h"
#include "control/tracker.h"
#include "maps/error.h"

namespace {

/// Hands out the fuzzer's bytes as numbers; zeros when they run out.
class Bytes {
 public:
  Bytes(const std::uint8_t* data, std::size_t size) : data_(data), left_(size) {}
  bool empty() const { return left_ == 0; }
  std::uint8_t byte() {
    if (left_ == 0) return 0;
    --left_;
    return *data_++;
  }
  /// Mostly small numbers in steps of 1/64, sometimes any double at all.
  double number() {
    if (byte() % 8 != 0) return (static_cast<int>(byte()) - 128) / 64.0;
    double value = 0.0;
    std::uint8_t raw[sizeof value];
    for (auto& b : raw) b = byte();
    std::memcpy(&value, raw, sizeof value);
    return value;
  }

 private:
  const std::uint8_t* data_;
  std::size_t left_;
};

rovigo::planning::Trajectory any_trajectory(Bytes& bytes) {
  rovigo::planning::Trajectory trajectory;
  const int points = 1 + bytes.byte() % 32;
  double time = 0.0;
  for (int i = 0; i < points; ++i) {
    rovigo::planning::TrajectoryPoint p;
    time += bytes.byte() / 256.0;
    p.time_s = bytes.byte() % 16 == 0 ? bytes.number() : time;
    p.pose = {bytes.number(), bytes.number(), bytes.number()};
    p.speed_m_s = bytes.number();
    p.yaw_rate_rad_s = bytes.number();
    p.curvature_1_m = bytes.number();
    trajectory.points.push_back(p);
  }
  return trajectory;
}

void require(bool holds) {
  if (!holds) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace rovigo;
  Bytes bytes(data, size);
  const maps::RobotModel robot;
  const control::DriveLimits limits = control::drive_limits({}, robot);
  try {
    control::TrajectoryTracker tracker({}, robot, any_trajectory(bytes));
    double now = 0.0;
    for (int i = 0; i < 400 && !bytes.empty(); ++i) {
      now = bytes.byte() % 32 == 0 ? bytes.number() : now + bytes.byte() / 2048.0;
      control::PoseInput pose;
      pose.time_s = bytes.byte() % 8 == 0 ? bytes.number() : now;
      pose.map_from_base = {bytes.number(), bytes.number(), bytes.number()};
      pose.sigma_position_m = bytes.number();
      pose.quality = static_cast<control::PoseQuality>(bytes.byte() % 3);
      const TTwist2D c = tracker.step(now, pose).command;
      require(c.vx >= 0.0 && c.vx <= limits.max_speed_m_s && c.vy == 0.0);
      require(std::abs(c.omega) <= limits.max_yaw_rate_rad_s);
      require(control::faster_wheel(c, limits.track_width_m) <= limits.max_wheel_speed_m_s + 1e-12);
    }
  } catch (const maps::InputError&) {
    // a trajectory that cannot be driven
  }
  return 0;
}
