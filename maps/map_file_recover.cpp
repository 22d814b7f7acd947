// Rescuing what is whole in a damaged map file.
//
// Every file of one schema version begins with the same page: SQLite's header and the list of
// tables, each of which begins at a fixed page. So a fresh first page is put before the rest of the
// file, and each row is asked for by its number: damage costs only the rows it lies in.

#include <SQLiteCpp/SQLiteCpp.h>
#include <sqlite3.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <set>

#include "maps/atomic_file.h"
#include "maps/error.h"
#include "maps/map_database.h"
#include "maps/map_file.h"

namespace rovigo::maps {
namespace {

namespace fs = std::filesystem;
using namespace detail;

constexpr std::size_t kMaxFileBytes = std::size_t{1} << 34;
constexpr std::size_t kPageBytes = 4096;
constexpr std::size_t kPageCountAt = 28;  // in SQLite's header, big-endian

struct SqliteFree {
  void operator()(unsigned char* bytes) const { sqlite3_free(bytes); }
};
using SqliteBytes = std::unique_ptr<unsigned char, SqliteFree>;

/// The file's bytes with a fresh first page and whole pages.
SqliteBytes with_fresh_first_page(const std::string& bytes, std::size_t& size) {
  SQLite::Database fresh(":memory:", SQLite::OPEN_READWRITE);
  create_schema(fresh);
  sqlite3_int64 fresh_size = 0;
  const SqliteBytes start(sqlite3_serialize(fresh.getHandle(), "main", &fresh_size, 0));
  const std::size_t pages =
      std::max<std::size_t>((bytes.size() + kPageBytes - 1) / kPageBytes,
                            static_cast<std::size_t>(fresh_size) / kPageBytes);
  size = pages * kPageBytes;
  SqliteBytes image(static_cast<unsigned char*>(sqlite3_malloc64(size)));
  if (!start || !image) throw InputError("not enough memory to read the map");
  std::fill_n(image.get(), size, static_cast<unsigned char>(0));
  std::copy(bytes.begin(), bytes.end(), image.get());
  std::copy_n(start.get(), kPageBytes, image.get());
  for (std::size_t i = 0; i < 4; ++i) {
    image.get()[kPageCountAt + i] = static_cast<unsigned char>(pages >> (24 - 8 * i));
  }
  return image;
}

/// Reads tables row by row, forgivingly: what cannot be read is noted.
class RescueReader {
 public:
  RescueReader(SQLite::Database& db, std::vector<std::string>& lost) : db_(db), lost_(lost) {}

  /// Hands every whole row among 1 .. `count` to `take`.
  template <class Part>
  void read(std::int64_t count, const std::function<void(Part&&)>& take) {
    std::int64_t missing = 0;
    std::string example;
    for (std::int64_t row = 1; row <= count; ++row) {
      std::vector<std::string> lost_blobs;
      try {
        // A statement of its own for each row: one that met damage may not be used again.
        SQLite::Statement statement(db_, RowSchema::of<Part>().select_sql());
        Part part = read_row<Part>(statement, row, &lost_blobs);
        if (const std::string problem = part.problem(); !problem.empty()) throw RowProblem{problem};
        note_blobs(Part::kTable, row, lost_blobs);
        take(std::move(part));
      } catch (const RowProblem& e) {
        ++missing;
        example = "row " + std::to_string(row) + ": " + e.what;
      } catch (const SQLite::Exception& e) {
        ++missing;
        example = "row " + std::to_string(row) + ": " + e.what();
      }
    }
    if (missing == 0) return;
    lost_.push_back(std::string(Part::kTable) + ": " + std::to_string(missing) + " of " +
                    std::to_string(count) + " rows cannot be read (" + example + ")");
  }

  /// The highest row number a table has, for when the count is lost.
  std::int64_t last_row(const char* table, std::int64_t limit) {
    try {
      SQLite::Statement statement(db_, std::string("SELECT max(row) FROM ") + table);
      if (!statement.executeStep()) return 0;
      return std::clamp<std::int64_t>(statement.getColumn(0).getInt64(), 0, limit);
    } catch (const SQLite::Exception&) {
      lost_.push_back(std::string(table) + ": nobody knows how many rows there were");
      return 0;
    }
  }

 private:
  void note_blobs(const char* table, std::int64_t row, const std::vector<std::string>& blobs) {
    for (const std::string& blob : blobs) {
      lost_.push_back(std::string(table) + " row " + std::to_string(row) + ": " + blob +
                      " is damaged and left out");
    }
  }
  SQLite::Database& db_;
  std::vector<std::string>& lost_;
};

/// How many rows to look for: as the map row says, else as many as there seem to be.
MapRow find_counts(RescueReader& reader, SavedMap& map, std::int64_t limit) {
  MapRow counts;
  bool known = false;
  reader.read<MapRow>(1, [&](MapRow&& row) {
    known = true;
    counts = std::move(row);
  });
  map.metadata.software_version = counts.software_version;
  map.metadata.recording = counts.recording;
  if (!known) {
    counts.simulation = std::min<std::int64_t>(reader.last_row(SimulationRow::kTable, limit), 1);
    counts.keyframes = reader.last_row(KeyframeRow::kTable, limit);
    counts.edges = reader.last_row(EdgeRow::kTable, limit);
    counts.trajectory = reader.last_row(TrajectoryRow::kTable, limit);
    counts.places = reader.last_row(PlaceRow::kTable, limit);
    counts.zones = reader.last_row(ZoneRow::kTable, limit);
  }
  return counts;
}

/// Edges whose keyframe is gone, and keyframes that come twice, cannot stay.
void drop_dangling(SavedMap& map, std::vector<std::string>& lost) {
  std::set<int> ids;
  std::erase_if(map.keyframes, [&](const StoredKeyframe& k) { return !ids.insert(k.id).second; });
  const std::size_t dropped = std::erase_if(
      map.edges, [&](const StoredEdge& e) { return !ids.count(e.from) || !ids.count(e.to); });
  if (dropped == 0) return;
  lost.push_back("edges: " + std::to_string(dropped) +
                 " left out because their keyframes are lost");
}

}  // namespace

RecoveredMap recover_map(const fs::path& path) {
  const std::string bytes = read_file(path, kMaxFileBytes);
  RecoveredMap recovered;
  SavedMap& map = recovered.map;
  bool grid_found = false;
  try {
    SQLite::Database db(":memory:", SQLite::OPEN_READWRITE);
    std::size_t size = 0;
    SqliteBytes image = with_fresh_first_page(bytes, size);
    const int result =
        sqlite3_deserialize(db.getHandle(), "main", image.release(),
                            static_cast<sqlite3_int64>(size), static_cast<sqlite3_int64>(size),
                            SQLITE_DESERIALIZE_FREEONCLOSE | SQLITE_DESERIALIZE_READONLY);
    if (result != SQLITE_OK) throw SQLite::Exception("the file cannot be opened", result);
    distrust(db);
    RescueReader reader(db, recovered.lost);
    // A row takes more than eight bytes: a damaged count must not keep us here for ever.
    const MapRow counts = find_counts(reader, map, static_cast<std::int64_t>(bytes.size() / 8));
    reader.read<CameraRow>(1, [&](CameraRow&& row) {
      if (row.problem().empty()) restore(row, map.metadata);
    });
    reader.read<SimulationRow>(
        counts.simulation, [&](SimulationRow&& row) { map.metadata.simulation = restore(row); });
    reader.read<GridRow>(1, [&](GridRow&& row) {
      grid_found = true;
      map.grid = restore(row);
    });
    reader.read<KeyframeRow>(counts.keyframes, [&](KeyframeRow&& row) {
      map.keyframes.push_back(restore(std::move(row)));
    });
    reader.read<EdgeRow>(counts.edges, [&](EdgeRow&& row) { map.edges.push_back(restore(row)); });
    reader.read<TrajectoryRow>(
        counts.trajectory, [&](TrajectoryRow&& row) { map.trajectory.push_back(restore(row)); });
    reader.read<PlaceRow>(counts.places,
                          [&](PlaceRow&& row) { map.places.push_back(restore(row)); });
    reader.read<ZoneRow>(counts.zones, [&](ZoneRow&& row) { map.zones.push_back(restore(row)); });
  } catch (const SQLite::Exception& e) {
    recovered.lost.push_back(std::string("the rest: ") + e.what());
  }
  drop_dangling(map, recovered.lost);
  if (!grid_found && map.keyframes.empty() && map.trajectory.empty()) {
    throw InputError(path.string() + ": nothing of a Rovigo map can be found in it");
  }
  return recovered;
}

}  // namespace rovigo::maps
