#pragma once
#include "maps/settings.h"

namespace rovigo::control {

struct ControlConfig {
  void describe(maps::SettingsVisitor& v);
};

}  // namespace rovigo::control
