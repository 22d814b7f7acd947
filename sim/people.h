#pragma once
// People who walk about near the rover. The camera sees them; the world's true grid does not hold
// them, and the rover cannot bump into them because they keep away from it.

#include <cstdint>
#include <limits>
#include <vector>

#include "maps/distance_field.h"
#include "sim/random.h"
#include "sim/renderer.h"
#include "sim/scenario.h"
#include "sim/world.h"

namespace rovigo::sim {

/// Smooth walks on free ground, drawn by seed: again and again towards another place in front of
/// the rover's camera, round walls and furniture.
class People {
 public:
  static constexpr double kStepS = 1.0 / 60.0;
  /// From a person's axis to the rover's middle, at least; a body is about 0.25 m in radius.
  static constexpr double kNearestM = 0.9;

  People(const World& world, const PeopleSettings& settings, const TPose2D& world_from_base,
         std::uint64_t seed);

  /// Everybody walks on for kStepS.
  void step(const TPose2D& world_from_base);

  /// What the camera sees of them now.
  std::vector<Mover> bodies() const;

  struct Person {
    TPoint2D at;
    TPoint2D velocity;       ///< m/s, world
    double heading_rad = 0;  ///< where the body faces
    double stride_rad = 0;   ///< phase of the legs
    double speed_m_s = 0.8;  ///< wanted
    double until_choice_s = 0.0;
    double until_way_s = 0.0;
    double until_aim_s = 0.0;
    TPoint2D aim;  ///< where it walks to in a straight line
    TPoint2D target;
    std::vector<float> way_m;  ///< per cell, to the target; infinity: cannot be reached
  };
  const std::vector<Person>& persons() const { return persons_; }

 private:
  bool is_walkable(maps::Cell c) const;
  double clearance(const TPoint2D& p) const;
  bool is_clear(const TPoint2D& a, const TPoint2D& b, double clearance_m) const;
  void choose_target(Person& person, const TPose2D& rover);
  void find_way(Person& person, const TPoint2D& rover) const;
  TPoint2D aim(const Person& person) const;
  void walk(Person& person, const TPose2D& rover);
  /// Out of the rover's sight: where somebody comes in, or reappears whom the rover drove into a
  /// corner.
  void appear(Person& person, const TPose2D& rover);

  PeopleSettings settings_;
  maps::OccupancyGrid grid_;
  maps::DistanceField field_;
  RandomStream random_;
  std::vector<Person> persons_;
};

/// A walking person's body: legs that swing, torso, arms, head, in clothes drawn from `number`.
std::vector<Solid> person_body(const People::Person& person, std::size_t number);

}  // namespace rovigo::sim
