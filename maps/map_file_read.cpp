// Reading map files: strictly, and what can be saved of damaged ones.

#include <SQLiteCpp/SQLiteCpp.h>
#include <sqlite3.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <fstream>
#include <functional>
#include <map>
#include <set>

#include "maps/atomic_file.h"
#include "maps/error.h"
#include "maps/map_database.h"
#include "maps/map_file.h"

namespace rovigo::maps {
namespace {

namespace fs = std::filesystem;
using namespace detail;

constexpr std::string_view kSqliteStart("SQLite format 3\0", 16);
constexpr std::size_t kHeaderBytes = 100;  // SQLite's file header
constexpr std::size_t kMaxFileBytes = std::size_t{1} << 36;
constexpr std::size_t kPageBytes = 4096;

[[noreturn]] void fail(const fs::path& path, const std::string& why) {
  throw InputError(path.string() + ": " + why);
}

[[noreturn]] void fail_damaged(const fs::path& path, const std::string& what) {
  fail(path, "the map is damaged: " + what + "; `rovigo info " + path.string() +
                 " --recover OUT.rovigo` rescues what is whole");
}

std::uint32_t big_endian_32(std::string_view bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    value = value << 8 | static_cast<std::uint8_t>(bytes[at + i]);
  }
  return value;
}

/// The first bytes of a regular file, as many as there are up to SQLite's header.
std::string read_header(const fs::path& path) {
  std::error_code error;
  if (!fs::is_regular_file(path, error)) return {};
  std::ifstream in(path, std::ios::binary);
  std::string header(kHeaderBytes, '\0');
  in.read(header.data(), static_cast<std::streamsize>(header.size()));
  header.resize(static_cast<std::size_t>(in.gcount()));
  return header;
}

bool is_map_header(std::string_view header) {
  return header.size() == kHeaderBytes && header.substr(0, 16) == kSqliteStart &&
         big_endian_32(header, 68) == kApplicationId;
}

/// What SQLite would find out late or not at all.
void check_header(const fs::path& path) {
  std::error_code error;
  if (!fs::exists(path, error)) fail(path, "cannot be read: no such file");
  if (fs::is_directory(path, error)) fail(path, "is a folder; give a map file");
  const std::string header = read_header(path);
  if (header.empty()) fail(path, "cannot be read, or is empty");
  if (header.substr(0, 16) != kSqliteStart.substr(0, header.size())) {
    fail(path, "is no Rovigo map: it does not start as an SQLite file does");
  }
  if (header.size() < kHeaderBytes) fail_damaged(path, "it is cut off inside its header");
  if (!is_map_header(header)) {
    fail(path, "is an SQLite file, but no Rovigo map (its application id is another)");
  }
  const std::uint32_t version = big_endian_32(header, 60);
  if (version > kSchemaVersion) {
    fail(path, "was written with map schema " + std::to_string(version) +
                   ", this program reads up to " + std::to_string(kSchemaVersion) +
                   "; use a newer Rovigo");
  }
  if (version != kSchemaVersion) fail_damaged(path, "its schema version is 0");
  const std::uint64_t page = big_endian_32(header, 16) >> 16;
  const std::uint64_t expected = page * big_endian_32(header, 28);
  const std::uint64_t actual = fs::file_size(path, error);
  if (page != kPageBytes || expected != actual) {
    fail_damaged(
        path, "it has " + std::to_string(actual) + " bytes instead of " + std::to_string(expected));
  }
}

/// A URI for `path`, because only a URI can say `immutable`: no locks, no journal of somebody
/// else's rolled back into the file, also in folders that cannot be written.
std::string immutable_uri(const fs::path& path) {
  static constexpr char kHex[] = "0123456789abcdef";
  std::string uri = "file:";
  for (const char c : fs::absolute(path).string()) {
    const bool plain = std::isalnum(static_cast<unsigned char>(c)) || std::strchr("/._-", c);
    if (plain) {
      uri += c;
    } else {
      uri += '%';
      uri += kHex[static_cast<unsigned char>(c) >> 4];
      uri += kHex[static_cast<unsigned char>(c) & 15];
    }
  }
  return uri + "?mode=ro&immutable=1";
}

/// The tables, no more and no less, must be ours to the letter.
void check_schema(SQLite::Database& db) {
  std::map<std::string, std::string> expected;
  for (const RowSchema& table : all_tables()) expected[table.table()] = table.create_sql();
  SQLite::Statement query(db, "SELECT name, sql FROM sqlite_master");
  while (query.executeStep()) {
    const auto found = expected.find(query.getColumn(0).getString());
    if (found == expected.end() || found->second != query.getColumn(1).getString()) {
      throw RowProblem{"table " + query.getColumn(0).getString() + " is not as it should be"};
    }
    expected.erase(found);
  }
  if (!expected.empty()) throw RowProblem{"table " + expected.begin()->first + " is missing"};
}

/// Reads tables row by row, strictly: the first problem ends it.
class StrictReader {
 public:
  explicit StrictReader(SQLite::Database& db) : db_(db) {}

  template <class Part>
  void read(std::int64_t count, const std::function<void(Part&&)>& take) {
    place_ = Part::kTable;
    SQLite::Statement counter(db_, std::string("SELECT count(*) FROM ") + Part::kTable);
    counter.executeStep();
    if (counter.getColumn(0).getInt64() != count) {
      throw RowProblem{"it has " + counter.getColumn(0).getString() + " rows instead of " +
                       std::to_string(count)};
    }
    SQLite::Statement statement(db_, RowSchema::of<Part>().select_sql());
    for (std::int64_t row = 1; row <= count; ++row) {
      place_ = std::string(Part::kTable) + " row " + std::to_string(row);
      Part part = read_row<Part>(statement, row);
      if (const std::string problem = part.problem(); !problem.empty()) throw RowProblem{problem};
      take(std::move(part));
    }
  }
  /// Where in the file the reader is, for messages.
  const std::string& place() const { return place_; }

 private:
  SQLite::Database& db_;
  std::string place_ = "the list of tables";
};

void take_map_row(const MapRow& row, MapMetadata& metadata) {
  metadata.software_version = row.software_version;
  metadata.recording = row.recording;
}

void check_references(const SavedMap& map) {
  std::set<int> ids;
  for (const StoredKeyframe& k : map.keyframes) {
    if (!ids.insert(k.id).second) {
      throw RowProblem{"two keyframes have the id " + std::to_string(k.id)};
    }
  }
  for (const StoredEdge& e : map.edges) {
    if (!ids.count(e.from) || !ids.count(e.to)) {
      throw RowProblem{"the edge " + std::to_string(e.from) + " - " + std::to_string(e.to) +
                       " names a keyframe that is not there"};
    }
  }
}

SavedMap read_everything(SQLite::Database& db, StrictReader& reader) {
  SavedMap map;
  check_schema(db);
  MapRow counts;
  reader.read<MapRow>(1, [&](MapRow&& row) { counts = std::move(row); });
  take_map_row(counts, map.metadata);
  reader.read<CameraRow>(1, [&](CameraRow&& row) { restore(row, map.metadata); });
  reader.read<SimulationRow>(counts.simulation,
                             [&](SimulationRow&& row) { map.metadata.simulation = restore(row); });
  reader.read<GridRow>(1, [&](GridRow&& row) { map.grid = restore(row); });
  reader.read<KeyframeRow>(counts.keyframes, [&](KeyframeRow&& row) {
    map.keyframes.push_back(restore(std::move(row)));
  });
  reader.read<EdgeRow>(counts.edges, [&](EdgeRow&& row) { map.edges.push_back(restore(row)); });
  reader.read<TrajectoryRow>(counts.trajectory,
                             [&](TrajectoryRow&& row) { map.trajectory.push_back(restore(row)); });
  reader.read<PlaceRow>(counts.places, [&](PlaceRow&& row) { map.places.push_back(restore(row)); });
  reader.read<ZoneRow>(counts.zones, [&](ZoneRow&& row) { map.zones.push_back(restore(row)); });
  check_references(map);
  return map;
}

}  // namespace

bool is_map_file(const fs::path& path) { return is_map_header(read_header(path)); }

SavedMap load_map(const fs::path& path) {
  check_header(path);
  std::string place = "the file";
  try {
    SQLite::Database db(immutable_uri(path), SQLite::OPEN_READONLY | SQLite::OPEN_URI);
    distrust(db);
    StrictReader reader(db);
    try {
      return read_everything(db, reader);
    } catch (const RowProblem& e) {
      fail_damaged(path, reader.place() + ": " + e.what);
    } catch (const SQLite::Exception& e) {
      fail_damaged(path, reader.place() + ": " + e.what());
    }
  } catch (const SQLite::Exception& e) {
    fail_damaged(path, e.what());
  }
}

}  // namespace rovigo::maps
