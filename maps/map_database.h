#pragma once
// The SQLite side of the map file: schema, checksummed rows, opening what may be damaged. Internal.

#include <SQLiteCpp/SQLiteCpp.h>

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "maps/map_rows.h"

namespace rovigo::maps::detail {

inline constexpr std::uint32_t kApplicationId = 0x5256474F;  // "RVGO"
inline constexpr int kSchemaVersion = 1;

/// What is wrong with a row that SQLite could read.
struct RowProblem {
  std::string what;
};

/// Turns describe() into SQL.
class RowSchema {
 public:
  template <class Part>
  static RowSchema of() {
    RowSchema schema(Part::kTable);
    const Part part;
    Part::describe(schema, part);
    schema.add("row_crc32", "INTEGER");
    return schema;
  }
  const std::string& table() const { return table_; }
  std::string create_sql() const;
  std::string insert_sql() const;
  std::string select_sql() const;

  void real(const char* name, double) { add(name, "REAL"); }
  void integer(const char* name, std::int64_t) { add(name, "INTEGER"); }
  void text(const char* name, const std::string&) { add(name, "TEXT"); }
  void blob(const char* name, const Blob&);

 private:
  explicit RowSchema(std::string table) : table_(std::move(table)) {}
  void add(const std::string& name, const std::string& type) { columns_.emplace_back(name, type); }

  std::string table_;
  std::vector<std::pair<std::string, std::string>> columns_;
};

/// Every table, in the order of creation (which fixes where in the file each begins).
std::vector<RowSchema> all_tables();

/// zlib CRC-32 over a row: table, row number, then the columns in order. Numbers count as 8
/// little-endian bytes, texts and blobs with their length before them, blobs by their own CRC.
class RowChecksum {
 public:
  RowChecksum(std::string_view table, std::int64_t row);
  void add(double value);
  void add(std::int64_t value);
  void add(std::string_view text);
  std::int64_t value() const { return static_cast<std::int64_t>(crc_); }

 private:
  void add_bytes(const void* data, std::size_t size);
  unsigned long crc_ = 0;
};

/// Binds one row to insert_sql().
class RowWriter {
 public:
  RowWriter(SQLite::Statement& statement, std::string_view table, std::int64_t row);
  void real(const char*, double value);
  void integer(const char*, std::int64_t value);
  void text(const char*, const std::string& value);
  void blob(const char*, const Blob& value);
  void finish();

 private:
  SQLite::Statement& statement_;
  RowChecksum checksum_;
  int column_ = 1;
};

/// Reads one row of select_sql(). Throws RowProblem for a wrong type or checksum; where
/// `lost_blobs` is given, a damaged blob is named there instead and comes back empty.
class RowReader {
 public:
  RowReader(SQLite::Statement& statement, std::string_view table, std::int64_t row,
            std::vector<std::string>* lost_blobs);
  void real(const char* name, double& value);
  void integer(const char* name, std::int64_t& value);
  void text(const char* name, std::string& value);
  void blob(const char* name, Blob& value);
  void finish();

 private:
  SQLite::Column next(const char* name, int type);
  SQLite::Statement& statement_;
  RowChecksum checksum_;
  std::vector<std::string>* lost_blobs_;
  int column_ = 0;
};

template <class Part>
void write_row(SQLite::Statement& statement, std::int64_t row, const Part& part) {
  RowWriter writer(statement, Part::kTable, row);
  Part::describe(writer, part);
  writer.finish();
}

template <class Part>
Part read_row(SQLite::Statement& statement, std::int64_t row,
              std::vector<std::string>* lost_blobs = nullptr) {
  Part part;
  RowReader reader(statement, Part::kTable, row, lost_blobs);
  Part::describe(reader, part);
  reader.finish();
  return part;
}

/// Sets page size, ids and tables of an empty database.
void create_schema(SQLite::Database& db);

/// Puts limits and guards on a connection to a file nobody vouches for.
void distrust(SQLite::Database& db);

}  // namespace rovigo::maps::detail
