#pragma once
// Makes of any RGB-D observation the one kind the rest of Rovigo knows.

#include <mrpt/obs/CObservation3DRangeScan.h>

#include <optional>
#include <string>

#include "slam/recording/depth_registration.h"

namespace rovigo::slam {

/// What `normalize` leaves: images in memory, colour as 8-bit BGR, depth (not range) of the same
/// size and registered to the colour camera, both camera models equal, the sensor pose that of the
/// colour camera, no point cloud. Keeps the tables of the last registration.
class RgbdNormalizer {
 public:
  /// False, with `problem` set, when the observation cannot be brought into that form.
  bool normalize(mrpt::obs::CObservation3DRangeScan& scan, std::string& problem);

 private:
  void register_depth(mrpt::obs::CObservation3DRangeScan& scan);

  std::optional<DepthRegistration> registration_;
};

}  // namespace rovigo::slam
