#include "maps/map_file.h"

#include <SQLiteCpp/SQLiteCpp.h>

#include <set>

#include "maps/atomic_file.h"
#include "maps/error.h"
#include "maps/map_database.h"
#include "maps/movingai.h"
#include "maps/ros_map.h"

namespace rovigo::maps {
namespace {

namespace fs = std::filesystem;
using namespace detail;

/// Writes the rows of one table; a value that cannot be read back is not written in the first
/// place.
template <class Items, class ToRow>
void write_table(SQLite::Database& db, const Items& items, ToRow to_row) {
  using Part = decltype(to_row(*std::begin(items)));
  SQLite::Statement statement(db, RowSchema::of<Part>().insert_sql());
  std::int64_t row = 0;
  for (const auto& item : items) {
    const Part part = to_row(item);
    ++row;
    if (const std::string problem = part.problem(); !problem.empty()) {
      throw InputError("the map cannot be saved: " + std::string(Part::kTable) + " row " +
                       std::to_string(row) + ": " + problem);
    }
    write_row(statement, row, part);
  }
}

void check_references(const SavedMap& map) {
  std::set<int> ids;
  for (const StoredKeyframe& k : map.keyframes) {
    if (ids.insert(k.id).second) continue;
    throw InputError("the map cannot be saved: two keyframes have the id " + std::to_string(k.id));
  }
  for (const StoredEdge& e : map.edges) {
    if (ids.count(e.from) && ids.count(e.to)) continue;
    throw InputError("the map cannot be saved: the edge " + std::to_string(e.from) + " - " +
                     std::to_string(e.to) + " names a keyframe that is not there");
  }
}

void write_database(const SavedMap& map, const fs::path& file) {
  SQLite::Database db(file.string(), SQLite::OPEN_READWRITE);
  // Nobody sees this file before it is whole: no journal, no locks for others, one sync at the end.
  db.exec("PRAGMA journal_mode = OFF");
  db.exec("PRAGMA synchronous = OFF");
  db.exec("PRAGMA locking_mode = EXCLUSIVE");
  create_schema(db);
  db.exec("BEGIN");
  write_table(db, std::vector{&map}, [](const SavedMap* m) { return map_row(*m); });
  write_table(db, std::vector{&map.metadata}, [](const MapMetadata* m) { return camera_row(*m); });
  if (map.metadata.simulation) {
    write_table(db, std::vector{*map.metadata.simulation}, simulation_row);
  }
  write_table(db, std::vector{&map.grid}, [](const OccupancyGrid* g) { return grid_row(*g); });
  write_table(db, map.keyframes, keyframe_row);
  write_table(db, map.edges, edge_row);
  write_table(db, map.trajectory, trajectory_row);
  write_table(db, map.places, place_row);
  write_table(db, map.zones, zone_row);
  db.exec("COMMIT");
}

}  // namespace

void save_map(const SavedMap& map, const fs::path& path) {
  check_references(map);
  try {
    write_file_atomically(path, [&](const fs::path& file) { write_database(map, file); });
  } catch (const SQLite::Exception& e) {
    throw InputError("cannot write " + path.string() + ": " + e.what() +
                     "; check the folder, its permissions and the free space");
  }
}

SavedMap load_any_map(const fs::path& path, std::vector<std::string>& warnings) {
  const std::string extension = path.extension().string();
  SavedMap map;
  if (extension == ".yaml" || extension == ".yml") {
    map.grid = load_ros_map(path, warnings);
  } else if (extension == ".map") {
    map.grid = load_movingai_map(path);
  } else if (extension == ".rovigo" || is_map_file(path)) {
    return load_map(path);
  } else if (!fs::exists(path)) {
    throw InputError("cannot read " + path.string() + ": no such file");
  } else {
    throw InputError(path.string() +
                     " is neither a Rovigo map (.rovigo), the .yaml of a ROS map, nor a MovingAI "
                     ".map; give one of these");
  }
  return map;
}

}  // namespace rovigo::maps
