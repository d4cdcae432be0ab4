// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/store/database.hpp"

#include <fmt/format.h>
#include <sqlite3.h>

#include <string_view>

#include "slam/store/statement.hpp"

namespace glint::slam {

SqlError::SqlError(sqlite3* connection)
    : SqlError(sqlite3_errcode(connection), sqlite3_errmsg(connection)) {}

SqlError::SqlError(int code, const std::string& message)
    : std::runtime_error(message), code_(code & 0xFF) {}

std::string file_uri(const std::filesystem::path& file, const std::string& parameters) {
  std::string uri = "file:";
  for (const char c : std::filesystem::absolute(file).string()) {
    // What a URI takes for its own.
    if (std::string_view("%?#").find(c) == std::string_view::npos) {
      uri += c;
    } else {
      uri += fmt::format("%{:02X}", static_cast<unsigned char>(c));
    }
  }
  return uri + '?' + parameters;
}

Database::Database(const std::string& name, int flags) {
  sqlite3* connection = nullptr;
  const int result = sqlite3_open_v2(name.c_str(), &connection, flags | SQLITE_OPEN_URI, nullptr);
  connection_.reset(connection);
  if (connection == nullptr) throw SqlError(result, sqlite3_errstr(result));
  if (result != SQLITE_OK) throw SqlError(connection);
}

void Database::run(const std::string& sql) {
  if (sqlite3_exec(handle(), sql.c_str(), nullptr, nullptr, nullptr) != SQLITE_OK) {
    throw SqlError(handle());
  }
}

std::int64_t Database::number(const std::string& sql) const {
  Statement query(*this, sql);
  return query.next() ? query.integer(0) : 0;
}

std::string Database::text(const std::string& sql) const {
  Statement query(*this, sql);
  return query.next() ? std::string(query.text(0)) : std::string();
}

void Database::Close::operator()(sqlite3* connection) const { sqlite3_close(connection); }

Transaction::Transaction(Database& database) : database_(database) {
  database.run("BEGIN IMMEDIATE");
}

// A failure may have rolled it back already, and one to roll back leaves nothing to be done.
Transaction::~Transaction() {
  if (sqlite3_get_autocommit(database_.handle()) != 0) return;
  sqlite3_exec(database_.handle(), "ROLLBACK", nullptr, nullptr, nullptr);
}

void Transaction::commit() { database_.run("COMMIT"); }

}  // namespace glint::slam
