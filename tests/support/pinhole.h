#pragma once
// A camera without distortion, and how a rover carries it.

#include <mrpt/img/TCamera.h>

#include "slam/camera_model.h"
#include "slam/se3.h"

namespace rovigo::test {

/// The optical axis meets the middle of the image.
inline mrpt::img::TCamera pinhole(double focal_px = 460.0, unsigned columns = 640,
                                  unsigned rows = 480) {
  mrpt::img::TCamera camera;
  camera.ncols = columns;
  camera.nrows = rows;
  camera.setIntrinsicParamsFromValues(focal_px, focal_px, (columns - 1) / 2.0, (rows - 1) / 2.0);
  return camera;
}

/// base_from_camera of a camera that looks level along base_link's x.
inline slam::Se3 looking_ahead(double height_m, double ahead_m = 0.0) {
  slam::Se3 out;
  out.rotation << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  out.translation = {ahead_m, 0.0, height_m};
  return out;
}

}  // namespace rovigo::test
