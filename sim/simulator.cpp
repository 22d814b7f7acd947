#include "sim/simulator.h"

#include <mrpt/system/datetime.h>

#include <cmath>
#include <deque>

#include "maps/error.h"
#include "sim/body_sensors.h"
#include "sim/command_link.h"
#include "sim/depth_camera.h"
#include "sim/drive_train.h"
#include "sim/kidnapping.h"
#include "sim/people.h"
#include "sim/rover.h"
#include "sim/sensor_timer.h"
#include "sim/world_model.h"

namespace rovigo::sim {
namespace {

constexpr double kFirstTimeS = 1.0;  // MRPT takes 0 for "no time"
constexpr int kSettleSteps = 48;     // 0.2 s for the wheels to take the weight
constexpr long kStepsPerWalk = 4;    // People::kStepS
static_assert(People::kStepS == kStepsPerWalk * Simulator::kStepS);
constexpr double kCameraForwardM = 0.12;
constexpr double kCameraHeightM = 0.25;

enum Stream : std::uint64_t {
  kImuStream = 10,
  kWheelStream,
  kSlipStream,
  kCameraStream,
  kPeopleStream,
  kCommandStream,
  kGripStream,
  kFaultStream
};

mrpt::poses::CPose3D to_mrpt(const Eigen::Isometry3d& m) {
  mrpt::math::CMatrixDouble44 matrix;
  matrix.asEigen() = m.matrix();
  return mrpt::poses::CPose3D(matrix);
}

SensorRig make_rig() {
  SensorRig rig;
  rig.camera.ncols = 640;
  rig.camera.nrows = 480;
  rig.camera.setIntrinsicParamsFromValues(460.0, 460.0, 319.5, 239.5);
  rig.camera.cameraName = "camera";
  // The optical frame (x right, y down, z forward) on a level camera that looks ahead.
  Eigen::Isometry3d base_from_camera = Eigen::Isometry3d::Identity();
  base_from_camera.linear() << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  base_from_camera.translation() << kCameraForwardM, 0.0, kCameraHeightM;
  rig.base_from_camera = to_mrpt(base_from_camera);
  return rig;
}

const SimulatorOptions& checked(const SimulatorOptions& options) {
  constexpr double kMaxRateHz = 1.0 / Simulator::kStepS;
  if (!(options.camera_rate_hz > 0.0 && options.camera_rate_hz <= kMaxRateHz)) {
    throw maps::InputError("camera_rate_hz = " + std::to_string(options.camera_rate_hz) +
                           " is outside (0, " + std::to_string(static_cast<int>(kMaxRateHz)) + "]");
  }
  if (!maps::is_finite(options.world_from_base)) {
    throw maps::InputError("the rover's start pose is not finite");
  }
  const maps::RobotModel& robot = options.robot;
  if (!(robot.mass_kg > 4.0 * robot.wheel_mass_kg)) {
    throw maps::InputError("robot.mass_kg = " + std::to_string(robot.mass_kg) +
                           " must exceed the mass of four wheels, " +
                           std::to_string(4.0 * robot.wheel_mass_kg));
  }
  if (!(robot.body_height_m > robot.ground_clearance_m)) {
    throw maps::InputError(
        "robot.ground_clearance_m = " + std::to_string(robot.ground_clearance_m) +
        " must be below robot.body_height_m = " + std::to_string(robot.body_height_m));
  }
  return options;
}

}  // namespace

struct Simulator::Impl {
  /// Either ready, or a shot that is rendered when somebody asks for it.
  struct Pending {
    double time_s = 0.0;
    mrpt::obs::CObservation::Ptr ready;
    Shot shot;
  };

  Impl(const World& w, const SimulatorOptions& o)
      : world(w),
        options(checked(o)),
        rig(make_rig()),
        body(w.model(), o.robot, o.world_from_base,
             {o.scenario.payload, o.scenario.slope, o.scenario.grip,
              derive_seed(o.seed, kGripStream)}),
        faults(o.scenario.faults, derive_seed(o.seed, kFaultStream)),
        link(o.scenario.commands, derive_seed(o.seed, kCommandStream)),
        drive(o.scenario.motor, o.scenario.wheels, o.robot, derive_seed(o.seed, kSlipStream)),
        imu(o.scenario.imu, gravity_on(o.scenario.slope), derive_seed(o.seed, kImuStream)),
        wheels(o.scenario.wheels, o.robot, derive_seed(o.seed, kWheelStream)),
        imu_timer(o.scenario.imu.rate_hz, kStepS),
        wheel_timer(o.scenario.wheels.rate_hz, kStepS),
        camera_timer(o.camera_rate_hz, kStepS) {
    if (options.camera_enabled) {
      camera = std::make_unique<DepthCamera>(world.model(), options.scenario.camera,
                                             options.scenario.floor, rig.camera,
                                             derive_seed(options.seed, kCameraStream));
    }
    const SideDrive hold{0.0, options.robot.motor_stall_torque_nm};
    for (int i = 0; i < kSettleSteps; ++i) {
      body.step(kStepS, hold, hold);
      if (const std::string thing = body.touched(); !thing.empty()) {
        refuse_start("it would touch '" + thing + "'; choose a start that is clear of it");
      }
    }
    if (body.state().world_from_base.translation().z() < -0.01) {
      refuse_start("there is no floor; choose a start on one");
    }
    imu.reset_motion(body.state());
    update_truth();
    if (camera && options.scenario.people.count > 0) {
      people.emplace(world, options.scenario.people, pose_now(),
                     derive_seed(options.seed, kPeopleStream));
    }
    sense();
  }

  [[noreturn]] void refuse_start(const std::string& why) const {
    const TPose2D& p = options.world_from_base;
    throw maps::InputError("the rover cannot be put down at (" + std::to_string(p.x) + ", " +
                           std::to_string(p.y) + ") in world '" + world.name() + "': " + why);
  }

  double time_s() const { return kFirstTimeS + static_cast<double>(step_index) * kStepS; }
  /// Since the recording's first moment, as scenarios count.
  double elapsed_s() const { return static_cast<double>(step_index) * kStepS; }

  void step(const TTwist2D& command) {
    const TTwist2D received = link.pass(elapsed_s(), command);
    if (ride) {
      DriveTrain::Input idle;  // the motors are let go
      idle.time_s = elapsed_s();
      idle.dt_s = kStepS;
      drive.step(idle);
    } else {
      move(received);
    }
    ++step_index;
    follow_kidnaps();
    update_truth();
    if (people && step_index % kStepsPerWalk == 0) people->step(pose_now());
    if (!is_switched_off()) imu.advance(state);
    sense();
  }

  void move(const TTwist2D& command) {
    const auto out = drive.step({.time_s = elapsed_s(),
                                 .dt_s = kStepS,
                                 .command = command,
                                 .voltage_share = voltage_share(),
                                 .left_speed_rad_s = body.left_speed_rad_s(),
                                 .right_speed_rad_s = body.right_speed_rad_s()});
    body.step(kStepS, out.left, out.right);
    wheels.advance(body.left_speed_rad_s() * kStepS / out.left_grip,
                   body.right_speed_rad_s() * kStepS / out.right_grip);
  }

  double voltage_share() const {
    const Fault* low = faults.active(FaultKind::kBatteryLow, elapsed_s());
    return low ? low->voltage_share : options.scenario.motor.voltage_share;
  }

  bool is_switched_off() const { return ride && ride->kind() == "switched_off"; }

  void follow_kidnaps() {
    const auto& kidnaps = options.scenario.kidnaps;
    if (!kidnaps.empty()) track.add(pose_now());
    if (ride && ride->is_over(elapsed_s())) put_down();
    while (!ride && next_kidnap < kidnaps.size() && kidnaps[next_kidnap].time_s <= elapsed_s()) {
      take_away(kidnaps[next_kidnap++]);
    }
  }

  TPose2D pose_now() const {
    const auto& p = truth.world_from_base;
    return {p.x(), p.y(), p.yaw()};
  }

  void take_away(const Kidnap& kidnap) {
    if (!spots) spots.emplace(world, options.robot);
    ++truth.kidnaps;
    const TTwist2D twist(state.velocity.x(), state.velocity.y(), state.angular_velocity.z());
    ride.emplace(pose_now(), twist, spots->choose(pose_now(), kidnap, track), kidnap, elapsed_s());
    if (ride->is_over(elapsed_s())) put_down();
  }

  void put_down() {
    body.place(ride->target());
    ride.reset();
    imu.reset_motion(body.state());
  }

  void update_truth() {
    state = body.state();
    if (ride) state = ride->kind() == "unfelt" ? at_rest(state) : ride->at(elapsed_s());
    truth.carried = ride.has_value();
    truth.camera_blind = camera_is_blind();
    truth.world_from_base = to_mrpt(state.world_from_base);
    const Eigen::Matrix3d base_from_world = state.world_from_base.linear().transpose();
    const Eigen::Vector3d v = base_from_world * state.velocity;
    truth.twist = TTwist2D(v.x(), v.y(), (base_from_world * state.angular_velocity).z());
    truth.contact_events = body.contact_events();
    if (truth.touched.empty() && truth.contact_events > 0) truth.touched = body.touched();
  }

  static BodyState at_rest(BodyState state) {
    state.velocity.setZero();
    state.angular_velocity.setZero();
    return state;
  }

  /// The blackout that rules now, or none.
  const Blackout* blackout_now() const {
    for (const auto& b : options.scenario.blackouts) {
      if (elapsed_s() >= b.start_s && elapsed_s() < b.start_s + b.duration_s) return &b;
    }
    return nullptr;
  }
  bool camera_is_blind() const { return ride || blackout_now(); }

  void sense() {
    const bool off = is_switched_off();
    if (imu_timer.is_due(step_index) && !off) add(imu.sample(state, imu_timer.interval_s()));
    if (wheel_timer.is_due(step_index) && !off) add(wheels.sample(wheel_timer.interval_s()));
    if (camera && camera_timer.is_due(step_index)) add_shot();
  }

  void add(const mrpt::obs::CObservation::Ptr& observation) {
    observation->timestamp = mrpt::Clock::fromDouble(time_s());
    pending.push_back({time_s(), observation, {}});
  }

  void add_shot() {
    Pending p;
    p.time_s = time_s();
    p.shot.index = camera_timer.index();
    p.shot.world_from_camera = truth.world_from_base + rig.base_from_camera;
    p.shot.yaw_rate_rad_s = truth.twist.omega;
    p.shot.interval_s = camera_timer.interval_s();
    for (const auto& s : options.scenario.light_steps) {
      if (elapsed_s() >= s.time_s) p.shot.light = s.factor;
    }
    const Blackout* blackout = blackout_now();
    if (blackout && blackout->kind == "missing") return;
    if (ride && !ride->camera_covered()) return;
    p.shot.covered = blackout || ride;
    if (people) p.shot.movers = people->bodies();
    pending.push_back(std::move(p));
  }

  mrpt::obs::CObservation::Ptr develop(const Pending& p) {
    auto scan = camera->take(p.shot);
    scan->timestamp = mrpt::Clock::fromDouble(p.time_s);
    // MRPT's sensor pose looks along +x; a level camera's is plain.
    scan->sensorPose = mrpt::poses::CPose3D(kCameraForwardM, 0.0, kCameraHeightM, 0.0, 0.0, 0.0);
    return scan;
  }

  World world;
  SimulatorOptions options;
  SensorRig rig;
  RoverBody body;
  FaultScript faults;
  CommandLink link;
  DriveTrain drive;
  ImuSensor imu;
  WheelSensor wheels;
  std::unique_ptr<DepthCamera> camera;
  std::optional<People> people;
  SensorTimer imu_timer;
  SensorTimer wheel_timer;
  SensorTimer camera_timer;
  BodyState state;
  Truth truth;
  std::deque<Pending> pending;
  long step_index = 0;
  std::size_t next_kidnap = 0;
  DrivenTrack track;
  std::optional<PutDownSpots> spots;
  std::optional<Ride> ride;
};

Simulator::Simulator(const World& world, const SimulatorOptions& options)
    : impl_(std::make_unique<Impl>(world, options)) {}
Simulator::~Simulator() = default;

void Simulator::step(const TTwist2D& command) { impl_->step(command); }
double Simulator::time_s() const { return impl_->time_s(); }
double Simulator::battery_v() const {
  return impl_->voltage_share() * impl_->options.robot.battery_nominal_v;
}
const Fault* Simulator::fault(FaultKind kind) const {
  return impl_->faults.active(kind, impl_->elapsed_s());
}
const Truth& Simulator::truth() const { return impl_->truth; }
const SensorRig& Simulator::rig() const { return impl_->rig; }

std::vector<mrpt::obs::CObservation::Ptr> Simulator::take_observations() {
  std::vector<mrpt::obs::CObservation::Ptr> out;
  out.reserve(impl_->pending.size());
  for (const auto& p : impl_->pending) out.push_back(p.ready ? p.ready : impl_->develop(p));
  impl_->pending.clear();
  return out;
}

}  // namespace rovigo::sim
