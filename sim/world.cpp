#include "sim/world.h"

#include "sim/world_model.h"

namespace rovigo::sim {

World::World(WorldModel model) : model_(std::make_shared<const WorldModel>(std::move(model))) {}

const std::string& World::name() const { return model_->name; }

TPose2D World::start() const { return model_->start; }

}  // namespace rovigo::sim
