#include "sim/simulator.h"

#include <gtest/gtest.h>

#include "sim/world_model.h"

namespace rovigo::sim {
namespace {

World empty_world() {
  WorldModel model;
  model.name = "empty";
  Solid floor;
  floor.kind = Solid::Kind::kPlane;
  floor.size = {40.0, 40.0, 1.0};
  model.solids.push_back(floor);
  return World(model);
}

TEST(Simulator, TimeStartsAtOneSecondAndGrowsByOneStep) {
  SimulatorOptions options;
  options.camera_enabled = false;
  Simulator simulator(empty_world(), options);
  EXPECT_DOUBLE_EQ(simulator.time_s(), 1.0);
  simulator.step({0.0, 0.0, 0.0});
  EXPECT_DOUBLE_EQ(simulator.time_s(), 1.0 + Simulator::kStepS);
}

}  // namespace
}  // namespace rovigo::sim
