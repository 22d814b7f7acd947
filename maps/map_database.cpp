#include "maps/map_database.h"

#include <sqlite3.h>
#include <zlib.h>

#include <cstring>

namespace rovigo::maps::detail {
namespace {

std::int64_t crc_of(const Blob& blob) {
  return static_cast<std::int64_t>(::crc32_z(::crc32_z(0, nullptr, 0), blob.data(), blob.size()));
}

/// SQLite keeps whole reals as integers and so loses the sign of -0.
double without_negative_zero(double value) { return value == 0.0 ? 0.0 : value; }

}  // namespace

void RowSchema::blob(const char* name, const Blob&) {
  add(name, "BLOB");
  add(std::string(name) + "_crc32", "INTEGER");
}

std::string RowSchema::create_sql() const {
  std::string sql = "CREATE TABLE ";
  sql += table_ + " (row INTEGER PRIMARY KEY";
  for (const auto& [name, type] : columns_) {
    sql.append(", ").append(name).append(" ").append(type).append(" NOT NULL");
  }
  return sql + ")";
}

std::string RowSchema::insert_sql() const {
  std::string sql = "INSERT INTO ";
  sql += table_ + " VALUES (?";
  for (std::size_t i = 0; i < columns_.size(); ++i) sql += ", ?";
  return sql + ")";
}

std::string RowSchema::select_sql() const {
  std::string sql = "SELECT ";
  for (const auto& column : columns_) {
    if (&column != &columns_.front()) sql += ", ";
    sql += column.first;
  }
  return sql + " FROM " + table_ + " WHERE row = ?";
}

std::vector<RowSchema> all_tables() {
  return {
      RowSchema::of<MapRow>(),        RowSchema::of<CameraRow>(),   RowSchema::of<SimulationRow>(),
      RowSchema::of<GridRow>(),       RowSchema::of<KeyframeRow>(), RowSchema::of<EdgeRow>(),
      RowSchema::of<TrajectoryRow>(), RowSchema::of<PlaceRow>(),    RowSchema::of<ZoneRow>()};
}

RowChecksum::RowChecksum(std::string_view table, std::int64_t row)
    : crc_(::crc32_z(0, nullptr, 0)) {
  add(table);
  add(row);
}

void RowChecksum::add_bytes(const void* data, std::size_t size) {
  crc_ = ::crc32_z(crc_, static_cast<const Bytef*>(data), size);
}

void RowChecksum::add(double value) { add_bytes(&value, sizeof value); }
void RowChecksum::add(std::int64_t value) { add_bytes(&value, sizeof value); }
void RowChecksum::add(std::string_view text) {
  add(static_cast<std::int64_t>(text.size()));
  if (!text.empty()) add_bytes(text.data(), text.size());
}

RowWriter::RowWriter(SQLite::Statement& statement, std::string_view table, std::int64_t row)
    : statement_(statement), checksum_(table, row) {
  statement_.reset();
  statement_.bind(column_++, row);
}

void RowWriter::real(const char*, double value) {
  value = without_negative_zero(value);
  checksum_.add(value);
  statement_.bind(column_++, value);
}

void RowWriter::integer(const char*, std::int64_t value) {
  checksum_.add(value);
  statement_.bind(column_++, value);
}

void RowWriter::text(const char*, const std::string& value) {
  checksum_.add(std::string_view(value));
  statement_.bind(column_++, value);
}

void RowWriter::blob(const char*, const Blob& value) {
  const std::int64_t crc = crc_of(value);
  checksum_.add(static_cast<std::int64_t>(value.size()));
  checksum_.add(crc);
  // A null pointer would be bound as NULL, not as an empty blob.
  const void* data = value.empty() ? static_cast<const void*>("") : value.data();
  statement_.bindNoCopy(column_++, data, static_cast<int>(value.size()));
  statement_.bind(column_++, crc);
}

void RowWriter::finish() {
  statement_.bind(column_, checksum_.value());
  statement_.exec();
}

RowReader::RowReader(SQLite::Statement& statement, std::string_view table, std::int64_t row,
                     std::vector<std::string>* lost_blobs)
    : statement_(statement), checksum_(table, row), lost_blobs_(lost_blobs) {
  statement_.reset();
  statement_.bind(1, row);
  if (!statement_.executeStep()) throw RowProblem{"the row is missing"};
}

SQLite::Column RowReader::next(const char* name, int type) {
  SQLite::Column column = statement_.getColumn(column_++);
  if (column.getType() != type) throw RowProblem{std::string(name) + " is of the wrong type"};
  return column;
}

void RowReader::real(const char* name, double& value) {
  value = next(name, SQLITE_FLOAT).getDouble();
  checksum_.add(value);
}

void RowReader::integer(const char* name, std::int64_t& value) {
  value = next(name, SQLITE_INTEGER).getInt64();
  checksum_.add(value);
}

void RowReader::text(const char* name, std::string& value) {
  value = next(name, SQLITE_TEXT).getString();
  checksum_.add(std::string_view(value));
}

void RowReader::blob(const char* name, Blob& value) {
  const SQLite::Column column = next(name, SQLITE_BLOB);
  const auto* data = static_cast<const std::uint8_t*>(column.getBlob());
  const int size = column.getBytes();
  // getBlob() has no way to say that the memory or the pages behind it were not to be had.
  const bool readable = data != nullptr || size == 0;
  if (readable && size > 0) value.assign(data, data + size);
  const std::int64_t crc = next(name, SQLITE_INTEGER).getInt64();
  checksum_.add(static_cast<std::int64_t>(size));
  checksum_.add(crc);
  if (readable && crc_of(value) == crc) return;
  if (!lost_blobs_) throw RowProblem{std::string(name) + " does not match its checksum"};
  lost_blobs_->emplace_back(name);
  value.clear();
}

void RowReader::finish() {
  if (next("row_crc32", SQLITE_INTEGER).getInt64() != checksum_.value()) {
    throw RowProblem{"the row does not match its checksum"};
  }
}

void create_schema(SQLite::Database& db) {
  db.exec("PRAGMA page_size = 4096");
  db.exec("PRAGMA encoding = 'UTF-8'");
  db.exec("PRAGMA auto_vacuum = NONE");
  db.exec("PRAGMA application_id = " + std::to_string(kApplicationId));
  db.exec("PRAGMA user_version = " + std::to_string(kSchemaVersion));
  for (const RowSchema& table : all_tables()) db.exec(table.create_sql());
}

void distrust(SQLite::Database& db) {
  sqlite3* handle = db.getHandle();
  sqlite3_db_config(handle, SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
  sqlite3_db_config(handle, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
  sqlite3_db_config(handle, SQLITE_DBCONFIG_ENABLE_TRIGGER, 0, nullptr);
  sqlite3_db_config(handle, SQLITE_DBCONFIG_ENABLE_VIEW, 0, nullptr);
  db.exec("PRAGMA cell_size_check = ON");
}

}  // namespace rovigo::maps::detail
