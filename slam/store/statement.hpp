// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>

struct sqlite3_stmt;

namespace glint::slam {

class Database;

/// A prepared statement of a Database, which must outlive it. Thread-compatible; every member
/// throws SqlError.
class Statement {
 public:
  Statement(const Database& database, const std::string& sql);

  /// Binds the values in order, runs the statement to its end and makes it ready for the next time.
  /// Numbers, text, bytes, or nullptr.
  template <class... Values>
  void run(const Values&... values) {
    bind_all(values...);
    finish();
  }
  /// Binds the values of a query that next() then goes through.
  template <class... Values>
  void bind_all(const Values&... values) {
    int index = 0;
    (bind(++index, values), ...);
  }

  /// The next row; false after the last one, when the statement is ready for the next time.
  bool next();
  /// Columns of the row, from 0; text and bytes are valid until next().
  [[nodiscard]] std::int64_t integer(int column) const;
  [[nodiscard]] double real(int column) const;
  [[nodiscard]] std::string_view text(int column) const;
  [[nodiscard]] std::span<const std::byte> bytes(int column) const;
  [[nodiscard]] bool is_null(int column) const;

 private:
  void bind(int index, std::integral auto value) {
    bind_integer(index, static_cast<std::int64_t>(value));
  }
  void bind(int index, double value);
  void bind(int index, std::string_view value);
  void bind(int index, std::span<const std::byte> value);
  void bind(int index, std::nullptr_t value);
  void bind_integer(int index, std::int64_t value);
  void finish();

  struct Finalize {
    void operator()(sqlite3_stmt* statement) const;
  };
  std::unique_ptr<sqlite3_stmt, Finalize> statement_;
};

}  // namespace glint::slam
