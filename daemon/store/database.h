// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <sqlite3.h>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "proto/error.h"

/// A Database wraps SQLite in values: a connection, a statement, a transaction. Errors name the file, what
/// SQLite says, and what to do.
namespace mgtd::daemon::store {

class Database;

class Statement {
 public:
  /// Parameters count from 1, columns from 0. A failed bind is reported by the next step.
  Statement& bind(int at, double value);
  Statement& bind(int at, std::int64_t value);
  Statement& bind(int at, std::string_view value);
  Statement& bind(int at, const std::optional<double>& value);
  /// True: a row is there.
  [[nodiscard]] Result<bool> step();
  /// To the end, then ready to be bound and run again.
  [[nodiscard]] Result<void> run();

  [[nodiscard]] bool null(int column) const;
  [[nodiscard]] double real(int column) const;
  [[nodiscard]] std::optional<double> optional_real(int column) const;
  [[nodiscard]] std::int64_t integer(int column) const;
  [[nodiscard]] std::string text(int column) const;

 private:
  friend class Database;
  struct Finalize {
    void operator()(sqlite3_stmt* s) const { sqlite3_finalize(s); }
  };
  Statement(const Database* db, sqlite3_stmt* statement) : db_(db), statement_(statement) {}
  Statement& note(int code);

  const Database* db_;
  std::unique_ptr<sqlite3_stmt, Finalize> statement_;
  int bind_code_{SQLITE_OK};
};

class Database {
 public:
  enum class Mode { create, read_write, read_only };

  [[nodiscard]] static Result<std::unique_ptr<Database>> open(const std::filesystem::path& path, Mode mode);
  /// Read-only, also where nothing may be written: a WAL left behind there is read from a copy.
  [[nodiscard]] static Result<std::unique_ptr<Database>> open_anywhere(const std::filesystem::path& path);
  Database(const Database&) = delete;
  Database& operator=(const Database&) = delete;
  ~Database();

  [[nodiscard]] Result<void> execute(const std::string& sql);
  [[nodiscard]] Result<Statement> prepare(std::string_view sql) const;
  /// First column of the first row, e.g. of a pragma.
  [[nodiscard]] Result<std::int64_t> integer(std::string_view sql) const;
  /// Runs `work` in one transaction; its failure, or the commit's, leaves nothing behind.
  template <class Work>
  [[nodiscard]] Result<void> atomically(Work work) {
    if (auto ok = execute("BEGIN IMMEDIATE"); !ok) return ok;
    Result<void> done = work();
    if (done) done = execute("COMMIT");
    if (!done && !sqlite3_get_autocommit(db_)) sqlite3_exec(db_, "ROLLBACK", nullptr, nullptr, nullptr);
    return done;
  }
  /// The last failure of this connection.
  [[nodiscard]] Error error(int code) const;

 private:
  Database(std::filesystem::path path, sqlite3* db) : path_(std::move(path)), db_(db) {}
  [[nodiscard]] static Result<std::unique_ptr<Database>> open_uri(const std::filesystem::path& path,
                                                                  const std::string& uri, int flags);

  std::filesystem::path path_;  ///< as the operator named it
  std::filesystem::path copy_;  ///< directory of a private copy; removed at the end
  sqlite3* db_;
};

}  // namespace mgtd::daemon::store
