// libFuzzer: map files. Inputs that are no map yet are laid over a small whole one, so that the
// fuzzer gets past SQLite's header: the first four bytes say where.

#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "maps/error.h"
#include "maps/map_file.h"
#include "maps/occupancy_grid.h"

namespace {

namespace maps = rovigo::maps;

struct Workspace {
  std::filesystem::path file;
  std::string whole;

  Workspace() {
    std::string folder = (std::filesystem::temp_directory_path() / "rovigo-fuzz-XXXXXX").string();
    if (!::mkdtemp(folder.data())) std::abort();
    file = std::filesystem::path(folder) / "a.rovigo";
    maps::SavedMap map;
    map.grid = maps::OccupancyGrid({0.05, {0.0, 0.0}, 70, 70}, 0);
    for (int i = 0; i < 3; ++i) {
      map.keyframes.push_back({i, 0.1 * i, {}, maps::Blob(3000, 7), maps::Blob(200, 8), {}});
      map.trajectory.push_back({0.1 * i, {}, true});
    }
    map.edges.push_back({0, 1, maps::StoredEdge::Kind::kLoop, {}, {}});
    map.edges[0].information.setIdentity();
    map.places.push_back({"dock", {1.0, 2.0, 0.0}});
    map.zones.push_back({"stairs", {{0.0, 0.0}, {1.0, 0.0}, {1.0, 1.0}}});
    maps::save_map(map, file);
    std::ifstream in(file, std::ios::binary);
    whole.assign(std::istreambuf_iterator<char>(in), {});
  }
  ~Workspace() {
    std::error_code ignored;
    std::filesystem::remove_all(file.parent_path(), ignored);
  }
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const Workspace workspace;
  std::string bytes(reinterpret_cast<const char*>(data), size);
  if (size >= 4 && bytes.substr(0, 6) != "SQLite") {
    std::size_t at = 0;
    for (int i = 0; i < 4; ++i) at = at << 8 | data[i];
    at %= workspace.whole.size();
    std::string patch = bytes.substr(4);
    bytes = workspace.whole;
    patch.resize(std::min(patch.size(), bytes.size() - at));
    bytes.replace(at, patch.size(), patch);
  }
  std::ofstream(workspace.file, std::ios::binary) << bytes;
  try {
    maps::load_map(workspace.file);
  } catch (const maps::InputError&) {
  }
  try {
    maps::recover_map(workspace.file);
  } catch (const maps::InputError&) {
  }
  return 0;
}
