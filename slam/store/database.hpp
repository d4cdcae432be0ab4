// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>

struct sqlite3;

namespace glint::slam {

/// What SQLite refused, in its own words. Stays within this folder: others are told which file it
/// was and what to do.
class SqlError : public std::runtime_error {
 public:
  /// The last error of a connection.
  explicit SqlError(sqlite3* connection);
  SqlError(int code, const std::string& message);

  /// SQLite's primary result code: SQLITE_FULL, ...
  [[nodiscard]] int code() const { return code_; }

 private:
  int code_ = 0;
};

/// A file name as SQLite's URI; `parameters` as in "mode=ro&immutable=1".
std::string file_uri(const std::filesystem::path& file, const std::string& parameters);

/// A connection to an SQLite database. Thread-compatible; every member throws SqlError.
class Database {
 public:
  /// `name`: a file, a URI, or "" for a private database that goes with its connection. `flags` as
  /// sqlite3_open_v2 has them.
  Database(const std::string& name, int flags);
  Database(Database&&) noexcept = default;
  Database& operator=(Database&&) noexcept = default;

  /// Runs statements whose rows are of no interest.
  void run(const std::string& sql);
  /// First column of a query's first row; 0 or empty where there is none.
  [[nodiscard]] std::int64_t number(const std::string& sql) const;
  [[nodiscard]] std::string text(const std::string& sql) const;
  [[nodiscard]] sqlite3* handle() const { return connection_.get(); }

 private:
  struct Close {
    void operator()(sqlite3* connection) const;
  };
  std::unique_ptr<sqlite3, Close> connection_;
};

/// All or nothing: what is not committed is undone when it goes out of scope.
class Transaction {
 public:
  explicit Transaction(Database& database);
  ~Transaction();
  Transaction(const Transaction&) = delete;
  Transaction& operator=(const Transaction&) = delete;
  void commit();

 private:
  Database& database_;
};

}  // namespace glint::slam
