// The text files of a TUM directory and trajectory files: read, or refused with an InputError.
#include <cstdint>
#include <cstdlib>

#include "maps/error.h"
#include "slam/recording/rig_yaml.h"
#include "slam/recording/tum_lists.h"
#include "slam/trajectory_file.h"
#include "slam_fuzz_file.h"

namespace {

template <class Read>
void attempt(const Read& read) {
  try {
    read();
  } catch (const rovigo::maps::InputError& error) {
    if (std::string(error.what()).find('\n') != std::string::npos) std::abort();
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace rovigo::slam;
  if (size == 0) return 0;
  const auto path = fuzz_file(".txt", data + 1, size - 1);
  switch (data[0] % 8) {
    case 0:
      attempt([&] { associate(read_image_list(path), read_image_list(path), 0.02); });
      break;
    case 1:
      attempt([&] { read_associations(path); });
      break;
    case 2:
      attempt([&] { read_imu(path); });
      break;
    case 3:
      attempt([&] { read_wheel_odometry(path); });
      break;
    case 4:
      attempt([&] { read_tum_trajectory(path); });
      break;
    case 5:
      attempt([&] { read_camera_info(path); });
      break;
    case 6:
      attempt([&] { read_extrinsics(path); });
      break;
    default:
      attempt([&] { read_simulation(path); });
      break;
  }
  return 0;
}
