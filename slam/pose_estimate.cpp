#include "slam/pose_estimate.h"

namespace rovigo::slam {

const char* to_string(Health health) {
  switch (health) {
    case Health::kOk:
      return "OK";
    case Health::kDegraded:
      return "DEGRADED";
    case Health::kLost:
      return "LOST";
  }
  return "LOST";
}

}  // namespace rovigo::slam
