// SPDX-License-Identifier: Apache-2.0
#include "daemon/store/database.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <system_error>

#include "daemon/store/run_schema.h"

namespace mgtd::daemon::store {
namespace {

constexpr int kBusy_ms = 1000;

/// A path as the path part of a file: URI.
std::string uri_of(const std::filesystem::path& path, std::string_view query) {
  std::string uri = "file:";
  for (const char c : std::filesystem::absolute(path).string()) {
    if (c == '%' || c == '?' || c == '#') {
      uri += fmt::format("%{:02X}", static_cast<unsigned>(c));
    } else {
      uri += c;
    }
  }
  return uri + std::string(query);
}

bool not_empty(const std::filesystem::path& path) {
  std::error_code error;
  const auto size = std::filesystem::file_size(path, error);
  return !error && size > 0;
}

std::filesystem::path beside(const std::filesystem::path& path, std::string_view suffix) {
  return std::filesystem::path(path.string() + std::string(suffix));
}

}  // namespace

Statement& Statement::note(int code) {
  if (bind_code_ == SQLITE_OK) bind_code_ = code;
  return *this;
}
Statement& Statement::bind(int at, double value) {
  return note(sqlite3_bind_double(statement_.get(), at, value));
}
Statement& Statement::bind(int at, std::int64_t value) {
  return note(sqlite3_bind_int64(statement_.get(), at, value));
}
Statement& Statement::bind(int at, std::string_view value) {
  return note(sqlite3_bind_text64(statement_.get(), at, value.data() != nullptr ? value.data() : "",
                                  value.size(), SQLITE_TRANSIENT, SQLITE_UTF8));
}
Statement& Statement::bind(int at, const std::optional<double>& value) {
  return value ? bind(at, *value) : note(sqlite3_bind_null(statement_.get(), at));
}

Result<bool> Statement::step() {
  const int code = bind_code_ == SQLITE_OK ? sqlite3_step(statement_.get()) : bind_code_;
  if (code == SQLITE_ROW) return true;
  if (code == SQLITE_DONE) return false;
  return tl::unexpected(db_->error(code));
}

Result<void> Statement::run() {
  for (;;) {
    auto row = step();
    if (row && *row) continue;
    sqlite3_reset(statement_.get());
    bind_code_ = SQLITE_OK;
    if (!row) return tl::unexpected(std::move(row.error()));
    return {};
  }
}

bool Statement::null(int column) const {
  return sqlite3_column_type(statement_.get(), column) == SQLITE_NULL;
}
double Statement::real(int column) const { return sqlite3_column_double(statement_.get(), column); }
std::optional<double> Statement::optional_real(int column) const {
  if (null(column)) return std::nullopt;
  return real(column);
}
std::int64_t Statement::integer(int column) const { return sqlite3_column_int64(statement_.get(), column); }
std::string Statement::text(int column) const {
  const void* const bytes = sqlite3_column_blob(statement_.get(), column);
  const auto size = static_cast<std::size_t>(sqlite3_column_bytes(statement_.get(), column));
  return bytes == nullptr ? std::string{} : std::string(static_cast<const char*>(bytes), size);
}

Database::~Database() {
  sqlite3_close(db_);
  std::error_code ignored;
  if (!copy_.empty()) std::filesystem::remove_all(copy_, ignored);
}

Result<std::unique_ptr<Database>> Database::open_uri(const std::filesystem::path& path,
                                                     const std::string& uri, int flags) {
  sqlite3* raw = nullptr;
  const int code = sqlite3_open_v2(
      uri.c_str(), &raw, flags | SQLITE_OPEN_URI | SQLITE_OPEN_NOMUTEX | SQLITE_OPEN_EXRESCODE, nullptr);
  std::unique_ptr<Database> db(new Database(path, raw));
  if (code != SQLITE_OK) return tl::unexpected(db->error(code));
  sqlite3_busy_timeout(raw, kBusy_ms);
  return db;
}

Result<std::unique_ptr<Database>> Database::open(const std::filesystem::path& path, Mode mode) {
  const int flags = mode == Mode::create       ? SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE
                    : mode == Mode::read_write ? SQLITE_OPEN_READWRITE
                                               : SQLITE_OPEN_READONLY;
  auto db = open_uri(path, uri_of(path, ""), flags);
  if (!db) return db;
  if (mode == Mode::read_only) return db;
  if (sqlite3_db_readonly((*db)->db_, "main") == 1) {
    return fail(ErrorCode::io, fmt::format("{} cannot be written", path.string()),
                "check its owner and permissions");
  }
  if (auto ok = (*db)->execute("PRAGMA synchronous=FULL; PRAGMA foreign_keys=ON"); !ok)
    return tl::unexpected(ok.error());
  return db;
}

/// A file in WAL mode needs a writable place even to be read. Where there is none: with no WAL the file alone
/// is the truth and cannot change under us; with one, both are read from a private copy.
Result<std::unique_ptr<Database>> Database::open_anywhere(const std::filesystem::path& path) {
  auto db = open(path, Mode::read_only);
  if (!db) return db;
  const auto probe = (*db)->integer("SELECT count(*) FROM sqlite_schema");
  if (probe || probe.error().code != ErrorCode::io) return db;
  if (!not_empty(beside(path, "-wal")))
    return open_uri(path, uri_of(path, "?immutable=1"), SQLITE_OPEN_READONLY);
  std::string pattern = (std::filesystem::temp_directory_path() / "mgtrun-XXXXXX").string();
  if (::mkdtemp(pattern.data()) == nullptr) return tl::unexpected(probe.error());
  const std::filesystem::path directory = pattern, copy = directory / path.filename();
  std::error_code error;
  std::filesystem::copy_file(path, copy, error);
  if (!error) std::filesystem::copy_file(beside(path, "-wal"), beside(copy, "-wal"), error);
  if (error) {
    std::filesystem::remove_all(directory, error);
    return tl::unexpected(probe.error());
  }
  auto copied = open_uri(path, uri_of(copy, ""), SQLITE_OPEN_READWRITE);
  if (copied) (*copied)->copy_ = directory;
  return copied;
}

Result<void> Database::execute(const std::string& sql) {
  const int code = sqlite3_exec(db_, sql.c_str(), nullptr, nullptr, nullptr);
  if (code != SQLITE_OK) return tl::unexpected(error(code));
  return {};
}

Result<Statement> Database::prepare(std::string_view sql) const {
  sqlite3_stmt* statement = nullptr;
  const int code = sqlite3_prepare_v2(db_, sql.data(), static_cast<int>(sql.size()), &statement, nullptr);
  if (code != SQLITE_OK) return tl::unexpected(error(code));
  return Statement(this, statement);
}

Result<std::int64_t> Database::integer(std::string_view sql) const {
  auto statement = prepare(sql);
  if (!statement) return tl::unexpected(statement.error());
  const auto row = statement->step();
  if (!row) return tl::unexpected(row.error());
  return *row ? statement->integer(0) : 0;
}

Error Database::error(int code) const {
  const std::string file = path_.string();
  const std::string said = db_ != nullptr ? sqlite3_errmsg(db_) : "out of memory";
  switch (code & 0xff) {
    case SQLITE_FULL:
      return {ErrorCode::io, fmt::format("{}: no space left; nothing of this step was kept", file),
              "free space on its disk"};
    case SQLITE_NOTADB:
      return {ErrorCode::bad_input, fmt::format("{} is not a run file (no SQLite database)", file),
              "name a *.mgtrun file written by mgtd or mgt import"};
    case SQLITE_CORRUPT:
      return {ErrorCode::bad_input, fmt::format("{} is damaged: {}", file, said), rescue_remedy(file)};
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
      return {ErrorCode::state, fmt::format("{} is being written by another program", file),
              "try again when it is done"};
    case SQLITE_CONSTRAINT:
      return {ErrorCode::refused, fmt::format("{}: {}", file, said), ""};
    case SQLITE_READONLY:
      return {ErrorCode::io, fmt::format("{} cannot be written: {}", file, said),
              "check owner and permissions of file and directory"};
    case SQLITE_CANTOPEN: {
      const int os = db_ != nullptr ? sqlite3_system_errno(db_) : 0;
      return {ErrorCode::io,
              fmt::format("cannot open {}: {}", file, os != 0 ? std::strerror(os) : said.c_str()),
              "check path and permissions"};
    }
    case SQLITE_IOERR: {
      const int os = db_ != nullptr ? sqlite3_system_errno(db_) : 0;
      return {ErrorCode::io,
              fmt::format("{}: {} ({})", file, said, os != 0 ? std::strerror(os) : "no reason given"),
              "check the disk: space, quota, kernel log"};
    }
    case SQLITE_ERROR:  // the tables are others than this program makes
      return {ErrorCode::bad_input, fmt::format("{} is damaged, or another program wrote it: {}", file, said),
              rescue_remedy(file)};
    default:
      return {ErrorCode::internal, fmt::format("{}: {}", file, said),
              "try a copy of the file on another disk"};
  }
}

}  // namespace mgtd::daemon::store
