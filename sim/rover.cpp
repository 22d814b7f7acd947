#include "sim/rover.h"

#include <btBulletDynamicsCommon.h>

#include <array>
#include <cmath>
#include <map>
#include <vector>

#include "sim/tires.h"

namespace rovigo::sim {
namespace {

constexpr int kFloor = 1;
constexpr int kObstacle = 2;
constexpr int kWheel = 4;
constexpr int kBody = 8;

constexpr double kFlushM = 0.01;        // lower than this: a carpet, no step at all
constexpr double kStandingRadS = 0.05;  // a wheel slower than this stands
constexpr int kSolverIterations = 30;
constexpr int kRestStepsBetweenContacts = 24;  // 0.1 s: a bounce is one contact, not ten

btVector3 to_bullet(const Eigen::Vector3d& v) {
  return {static_cast<btScalar>(v.x()), static_cast<btScalar>(v.y()), static_cast<btScalar>(v.z())};
}
Eigen::Vector3d to_eigen(const btVector3& v) {
  return {static_cast<double>(v.x()), static_cast<double>(v.y()), static_cast<double>(v.z())};
}

btTransform to_bullet(const Eigen::Isometry3d& m) {
  const Eigen::Quaterniond q(m.linear());
  return btTransform(btQuaternion(static_cast<btScalar>(q.x()), static_cast<btScalar>(q.y()),
                                  static_cast<btScalar>(q.z()), static_cast<btScalar>(q.w())),
                     to_bullet(Eigen::Vector3d(m.translation())));
}

Eigen::Isometry3d upright(const TPose2D& pose, double z) {
  Eigen::Isometry3d m = Eigen::Isometry3d::Identity();
  m.linear() = Eigen::AngleAxisd(pose.phi, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  m.translation() = Eigen::Vector3d(pose.x, pose.y, z);
  return m;
}

/// Coulomb friction of a wheel's gears and bearings: a constraint of its own beside the motor, so
/// that it can hold a wheel against a load that the motor cannot. Where it sticks it remembers the
/// angle: the solver leaves some tenths of a millimetre per second of every load.
class AxleFriction final : public btTypedConstraint {
 public:
  AxleFriction(btRigidBody& wheel, btRigidBody& chassis)
      : btTypedConstraint(MAX_CONSTRAINT_TYPE, wheel, chassis) {}

  /// Before each step: the most it can do, and how far the wheel turned in the last one.
  void update(btScalar impulse_limit, btScalar turned_rad) {
    constexpr btScalar kSticks = btScalar(0.99);
    const bool stuck = btFabs(getAppliedImpulse()) < kSticks * limit_;
    drift_rad_ = stuck ? drift_rad_ + turned_rad : 0;
    limit_ = impulse_limit;
  }

 private:
  void getInfo1(btConstraintInfo1* info) override {
    info->m_numConstraintRows = limit_ > 0 ? 1 : 0;
    info->nub = 5;
  }
  void getInfo2(btConstraintInfo2* info) override {
    constexpr btScalar kReturnRate_1_s = 10;
    const btVector3 axle = m_rbB.getWorldTransform().getBasis().getColumn(1);
    for (int i = 0; i < 3; ++i) {
      info->m_J1angularAxis[i] = axle[i];
      info->m_J2angularAxis[i] = -axle[i];
    }
    info->m_constraintError[0] = -kReturnRate_1_s * drift_rad_;
    info->m_lowerLimit[0] = -limit_;
    info->m_upperLimit[0] = limit_;
  }
  void setParam(int, btScalar, int) override {}
  btScalar getParam(int, int) const override { return 0; }

  btScalar limit_ = 0;
  btScalar drift_rad_ = 0;
};

/// Bullet picks its own friction directions; a wheel's only one is where it rolls. They are set
/// between finding contacts and solving them.
class RollingWorld final : public btDiscreteDynamicsWorld {
 public:
  using btDiscreteDynamicsWorld::btDiscreteDynamicsWorld;
  const btCollisionObject* chassis = nullptr;

 private:
  void solveConstraints(btContactSolverInfo& info) override {
    const btVector3 axle = chassis->getWorldTransform().getBasis().getColumn(1);
    for (int i = 0; i < getDispatcher()->getNumManifolds(); ++i) {
      btPersistentManifold* manifold = getDispatcher()->getManifoldByIndexInternal(i);
      if (manifold->getBody0() == chassis || manifold->getBody1() == chassis) continue;
      for (int k = 0; k < manifold->getNumContacts(); ++k) {
        btManifoldPoint& point = manifold->getContactPoint(k);
        point.m_lateralFrictionDir1 = axle.cross(point.m_normalWorldOnB).normalized();
        point.m_contactPointFlags |= BT_CONTACT_FLAG_LATERAL_FRICTION_INITIALIZED;
      }
    }
    btDiscreteDynamicsWorld::solveConstraints(info);
  }
};

double top_of(const Solid& solid) {
  double top = -1e9;
  for (const auto& p : corners_of(solid)) top = std::max(top, p.z());
  return top;
}

}  // namespace

struct RoverBody::Impl {
  Impl(const WorldModel& model, const maps::RobotModel& robot, const TPose2D& pose,
       const Footing& footing)
      : robot_(robot),
        footing_(footing),
        mass_(loaded_body(robot, footing.payload)),
        wheel_loads_n_(wheel_loads(robot, footing.payload)),
        dispatcher_(&configuration_),
        world_(&dispatcher_, &broadphase_, &solver_, &configuration_) {
    world_.setGravity(to_bullet(gravity_on(footing.slope)));
    world_.getSolverInfo().m_numIterations = kSolverIterations;
    world_.getSolverInfo().m_solverMode =
        SOLVER_SIMD | SOLVER_USE_WARMSTARTING | SOLVER_ENABLE_FRICTION_DIRECTION_CACHING;
    for (const auto& solid : model.solids) add_static(solid);
    build_rover(pose);
  }

  ~Impl() {
    for (auto& hinge : hinges_) world_.removeConstraint(hinge.get());
    for (auto& friction : frictions_) world_.removeConstraint(friction.get());
    for (auto& body : bodies_) world_.removeRigidBody(body.get());
  }

  void add_static(const Solid& solid) {
    if (!solid.touchable) return;
    const double top = top_of(solid);
    const bool is_plane = solid.kind == Solid::Kind::kPlane;
    if (!is_plane && top <= kFlushM) return;
    Eigen::Isometry3d frame = solid.world_from_solid;
    std::unique_ptr<btCollisionShape> shape;
    if (is_plane) {  // a slab below the plane: finite, and nothing falls through it
      constexpr double kSlabM = 0.5;
      frame.translation() -= 0.5 * kSlabM * frame.linear().col(2);
      shape = std::make_unique<btBoxShape>(
          to_bullet(Eigen::Vector3d(solid.size.x() / 2, solid.size.y() / 2, kSlabM / 2)));
    } else if (solid.kind == Solid::Kind::kBox) {
      shape = std::make_unique<btBoxShape>(to_bullet(Eigen::Vector3d(solid.size / 2)));
    } else {
      shape = std::make_unique<btCylinderShapeZ>(to_bullet(Eigen::Vector3d(solid.size / 2)));
    }
    const bool is_floor = is_plane || top <= robot_.ground_clearance_m;
    add_body(0.0, std::move(shape), to_bullet(frame), btVector3(0, 0, 0),
             is_floor ? kFloor : kObstacle, is_floor ? kWheel : kBody);
    names_[bodies_.back().get()] = solid.name;
  }

  btRigidBody* add_body(double mass, std::unique_ptr<btCollisionShape> shape,
                        const btTransform& frame, const btVector3& inertia, int group, int mask) {
    btRigidBody::btRigidBodyConstructionInfo info(static_cast<btScalar>(mass), nullptr, shape.get(),
                                                  inertia);
    info.m_startWorldTransform = frame;
    info.m_friction = group == kWheel ? static_cast<btScalar>(robot_.tire_friction) : btScalar(1);
    bodies_.push_back(std::make_unique<btRigidBody>(info));
    shapes_.push_back(std::move(shape));
    world_.addRigidBody(bodies_.back().get(), group, mask);
    return bodies_.back().get();
  }

  void build_rover(const TPose2D& pose) {
    const double clearance = robot_.ground_clearance_m;
    const double height = robot_.body_height_m - clearance;
    auto box = std::make_unique<btBoxShape>(to_bullet(
        Eigen::Vector3d(robot_.footprint_length_m / 2, robot_.footprint_width_m / 2, height / 2)));
    // Bullet's bodies turn about their origin: the frame lies in the centre of mass.
    auto hull = std::make_unique<btCompoundShape>();
    Eigen::Isometry3d body_from_box = Eigen::Isometry3d::Identity();
    body_from_box.translation() =
        Eigen::Vector3d(0.0, 0.0, clearance + height / 2) - mass_.center_of_mass;
    hull->addChildShape(to_bullet(body_from_box), box.get());
    shapes_.push_back(std::move(box));
    chassis_ = add_body(mass_.mass_kg, std::move(hull), to_bullet(body_at(pose)),
                        to_bullet(mass_.inertia), kBody, kObstacle);
    chassis_->setActivationState(DISABLE_DEACTIVATION);
    world_.chassis = chassis_;
    for (const int x : {1, -1}) {
      for (const int y : {1, -1}) add_wheel(pose, x, y);
    }
  }

  Eigen::Isometry3d body_at(const TPose2D& world_from_base) const {
    Eigen::Isometry3d frame = upright(world_from_base, 0.0);
    frame.translation() = frame * mass_.center_of_mass;
    return frame;
  }

  /// Order: front left, front right, rear left, rear right.
  void add_wheel(const TPose2D& pose, int x, int y) {
    const double r = robot_.wheel_radius_m;
    const Eigen::Vector3d center(x * robot_.wheel_base_m / 2, y * robot_.track_width_m / 2, r);
    auto sphere = std::make_unique<btSphereShape>(static_cast<btScalar>(r));
    btVector3 inertia;
    sphere->calculateLocalInertia(static_cast<btScalar>(robot_.wheel_mass_kg), inertia);
    Eigen::Isometry3d frame = upright(pose, 0.0);
    frame.translation() = frame * center;
    btRigidBody* wheel = add_body(robot_.wheel_mass_kg, std::move(sphere), to_bullet(frame),
                                  inertia, kWheel, kFloor);
    wheel->setActivationState(DISABLE_DEACTIVATION);
    const btVector3 axle(0, 1, 0);
    const btVector3 on_chassis = to_bullet(Eigen::Vector3d(center - mass_.center_of_mass));
    // The wheel is body A: with the chassis there, Bullet's motor turns the other way.
    auto hinge = std::make_unique<btHingeConstraint>(*wheel, *chassis_, btVector3(0, 0, 0),
                                                     on_chassis, axle, axle);
    world_.addConstraint(hinge.get(), true);
    hinges_.push_back(std::move(hinge));
    auto friction = std::make_unique<AxleFriction>(*wheel, *chassis_);
    world_.addConstraint(friction.get(), true);
    frictions_.push_back(std::move(friction));
    wheels_.push_back(wheel);
    tires_.emplace_back(robot_);
  }

  double wheel_speed(std::size_t i) const {
    const btVector3 axle = chassis_->getWorldTransform().getBasis().getColumn(1);
    return static_cast<double>(
        (wheels_[i]->getAngularVelocity() - chassis_->getAngularVelocity()).dot(axle));
  }

  /// What the floor does to the tyres: its grip where they roll, and their side forces, on the
  /// chassis at the wheels' contacts.
  void apply_tires(double dt_s) {
    const btTransform& frame = chassis_->getWorldTransform();
    const btVector3 axle = frame.getBasis().getColumn(1);
    for (std::size_t i = 0; i < wheels_.size(); ++i) {
      btVector3 foot = wheels_[i]->getWorldTransform().getOrigin();
      const double grip = grip_at(footing_.grip, footing_.seed, {foot.x(), foot.y()});
      wheels_[i]->setFriction(static_cast<btScalar>(robot_.tire_friction * grip));
      foot.setZ(foot.z() - static_cast<btScalar>(robot_.wheel_radius_m));
      const btVector3 arm = foot - frame.getOrigin();
      const double scrub = chassis_->getVelocityInLocalPoint(arm).dot(axle);
      const bool rolls = std::abs(wheel_speed(i)) > kStandingRadS;
      const double force = tires_[i].force(scrub, rolls, wheel_loads_n_[i], grip, dt_s);
      chassis_->applyForce(axle * static_cast<btScalar>(force), arm);
    }
  }

  /// Calls `visit` with every obstacle that the body touches.
  template <class Visit>
  void for_each_touched(const Visit& visit) {
    for (int i = 0; i < dispatcher_.getNumManifolds(); ++i) {
      const btPersistentManifold* manifold = dispatcher_.getManifoldByIndexInternal(i);
      const btCollisionObject* other = nullptr;
      if (manifold->getBody0() == chassis_) other = manifold->getBody1();
      if (manifold->getBody1() == chassis_) other = manifold->getBody0();
      if (other && is_touching(*manifold)) visit(other);
    }
  }

  void count_contacts() {
    ++step_;
    for_each_touched([this](const btCollisionObject* other) {
      const auto last = last_touch_.find(other);
      if (last == last_touch_.end() || step_ - last->second > kRestStepsBetweenContacts) {
        ++contact_events_;
      }
      last_touch_[other] = step_;
    });
  }

  static bool is_touching(const btPersistentManifold& manifold) {
    for (int i = 0; i < manifold.getNumContacts(); ++i) {
      if (manifold.getContactPoint(i).getDistance() <= 0) return true;
    }
    return false;
  }

  maps::RobotModel robot_;
  Footing footing_;
  MassProperties mass_;
  std::array<double, 4> wheel_loads_n_;
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_;
  btDbvtBroadphase broadphase_;
  btSequentialImpulseConstraintSolver solver_;
  RollingWorld world_;
  std::vector<std::unique_ptr<btCollisionShape>> shapes_;
  std::vector<std::unique_ptr<btRigidBody>> bodies_;
  std::vector<std::unique_ptr<btHingeConstraint>> hinges_;
  std::vector<std::unique_ptr<AxleFriction>> frictions_;
  btRigidBody* chassis_ = nullptr;
  std::vector<btRigidBody*> wheels_;
  std::vector<TireSide> tires_;
  long step_ = 0;
  int contact_events_ = 0;
  std::map<const btCollisionObject*, long> last_touch_;
  std::map<const btCollisionObject*, std::string> names_;
};

RoverBody::RoverBody(const WorldModel& world, const maps::RobotModel& robot,
                     const TPose2D& world_from_base, const Footing& footing)
    : impl_(std::make_unique<Impl>(world, robot, world_from_base, footing)) {}
RoverBody::~RoverBody() = default;

void RoverBody::step(double dt_s, const SideDrive& left, const SideDrive& right) {
  for (std::size_t i = 0; i < impl_->hinges_.size(); ++i) {
    const SideDrive& drive = i % 2 == 0 ? left : right;
    impl_->hinges_[i]->enableAngularMotor(true, static_cast<btScalar>(drive.speed_rad_s),
                                          static_cast<btScalar>(drive.torque_limit_nm * dt_s));
    impl_->frictions_[i]->update(static_cast<btScalar>(drive.friction_nm * dt_s),
                                 static_cast<btScalar>(impl_->wheel_speed(i) * dt_s));
  }
  impl_->apply_tires(dt_s);
  impl_->world_.stepSimulation(static_cast<btScalar>(dt_s), 0);  // exactly one step
  impl_->count_contacts();
}

BodyState RoverBody::state() const {
  const btTransform& frame = impl_->chassis_->getWorldTransform();
  BodyState s;
  const btQuaternion q = frame.getRotation();
  s.world_from_base.linear() =
      Eigen::Quaterniond(q.w(), q.x(), q.y(), q.z()).normalized().toRotationMatrix();
  const Eigen::Vector3d arm = s.world_from_base.linear() * -impl_->mass_.center_of_mass;
  s.world_from_base.translation() = to_eigen(frame.getOrigin()) + arm;
  s.angular_velocity = to_eigen(impl_->chassis_->getAngularVelocity());
  s.velocity = to_eigen(impl_->chassis_->getLinearVelocity()) + s.angular_velocity.cross(arm);
  return s;
}

double RoverBody::left_speed_rad_s() const {
  return 0.5 * (impl_->wheel_speed(0) + impl_->wheel_speed(2));
}
double RoverBody::right_speed_rad_s() const {
  return 0.5 * (impl_->wheel_speed(1) + impl_->wheel_speed(3));
}
int RoverBody::contact_events() const { return impl_->contact_events_; }

std::string RoverBody::touched() const {
  std::string name;
  impl_->for_each_touched([&](const btCollisionObject* other) { name = impl_->names_[other]; });
  return name;
}

void RoverBody::place(const TPose2D& world_from_base) {
  const auto put = [](btRigidBody* body, const btTransform& frame) {
    body->setWorldTransform(frame);
    body->setInterpolationWorldTransform(frame);
    body->setLinearVelocity(btVector3(0, 0, 0));
    body->setAngularVelocity(btVector3(0, 0, 0));
    body->clearForces();
  };
  const btTransform old_inverse = impl_->chassis_->getWorldTransform().inverse();
  const btTransform target = to_bullet(impl_->body_at(world_from_base));
  for (auto* wheel : impl_->wheels_)
    put(wheel, target * (old_inverse * wheel->getWorldTransform()));
  put(impl_->chassis_, target);
}

}  // namespace rovigo::sim
