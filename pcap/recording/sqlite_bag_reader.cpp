// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "pcap/recording/sqlite_bag_reader.hpp"

#include <fmt/format.h>
#include <sqlite3.h>

#include <cstdint>
#include <limits>
#include <map>
#include <utility>

#include "driver/core/error.hpp"
#include "pcap/recording/whole_pages_vfs.hpp"

namespace glint::recording {
namespace {

/// Larger than any packet and any metadata.
constexpr int kMaxMessageBytes = 16 << 20;
constexpr std::size_t kMaxTopics = 4096;

struct Close {
  void operator()(sqlite3* database) const { sqlite3_close(database); }
};
using Database = std::unique_ptr<sqlite3, Close>;

struct Finalize {
  void operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }
};
using Statement = std::unique_ptr<sqlite3_stmt, Finalize>;

/// The file's name as SQLite wants it with options behind: escaped where it would mislead.
std::string uri_of(const std::filesystem::path& file) {
  std::string uri = "file:";
  for (const char c : std::filesystem::absolute(file).string()) {
    uri += c == '%' || c == '?' || c == '#' ? fmt::format("%{:02X}", c) : std::string(1, c);
  }
  std::error_code error;
  const auto log_bytes = std::filesystem::file_size(file.string() + "-wal", error);
  // Without a log to take into account, nothing need be locked or made beside the file, which may
  // lie on a read-only disk.
  if (error || log_bytes == 0) uri += "?immutable=1";
  return uri;
}

Database open_database(const std::filesystem::path& file) {
  sqlite3* opened = nullptr;
  const int status = sqlite3_open_v2(uri_of(file).c_str(), &opened,
                                     SQLITE_OPEN_READONLY | SQLITE_OPEN_URI, whole_pages_vfs());
  Database database(opened);
  if (status != SQLITE_OK) {
    throw InputError(
        fmt::format("The recording {} cannot be read: {}; check the path and its "
                    "rights.",
                    file.string(), sqlite3_errstr(status)));
  }
  sqlite3_limit(opened, SQLITE_LIMIT_LENGTH, kMaxMessageBytes);
  sqlite3_db_config(opened, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
  sqlite3_db_config(opened, SQLITE_DBCONFIG_ENABLE_TRIGGER, 0, nullptr);
  // Lets a file that was cut short be opened at all; nothing is written, the file is read-only.
  sqlite3_db_config(opened, SQLITE_DBCONFIG_WRITABLE_SCHEMA, 1, nullptr);
  sqlite3_exec(opened, "PRAGMA cell_size_check=ON; PRAGMA mmap_size=0", nullptr, nullptr, nullptr);
  return database;
}

/// Null if the statement does not fit the database.
Statement prepare(const Database& database, const std::string& sql) {
  sqlite3_stmt* prepared = nullptr;
  sqlite3_prepare_v2(database.get(), sql.c_str(), -1, &prepared, nullptr);
  return Statement(prepared);
}

std::string text_at(const Statement& statement, int column) {
  const auto* const text =
      reinterpret_cast<const char*>(sqlite3_column_text(statement.get(), column));
  const auto size = static_cast<std::size_t>(sqlite3_column_bytes(statement.get(), column));
  return text == nullptr || size > kMaxNameBytes ? std::string() : std::string(text, size);
}

/// Plain tables only: a view might take for ever.
bool has_bag_tables(const Database& database) {
  const Statement count = prepare(database,
                                  "SELECT count(*) FROM sqlite_master WHERE type = 'table' AND "
                                  "rootpage > 0 AND name IN ('topics', 'messages')");
  return count != nullptr && sqlite3_step(count.get()) == SQLITE_ROW &&
         sqlite3_column_int(count.get(), 0) == 2;
}

}  // namespace

struct SqliteBagReader::Impl {
  struct Topic {
    std::string name;
    std::string type;
    Encoding encoding = Encoding::kOther;
  };

  explicit Impl(std::filesystem::path path) : file(std::move(path)), database(open_database(file)) {
    if (!has_bag_tables(database)) {
      const std::string said = sqlite3_errmsg(database.get());
      throw InputError(
          fmt::format("{} is no ROS 2 bag: the database has no tables of topics and "
                      "messages{}.",
                      file.string(), said == "not an error" ? "" : " (" + said + ")"));
    }
    read_topics();
    select_messages();
  }

  void read_topics() {
    const Statement rows =
        prepare(database, "SELECT id, name, type, serialization_format FROM topics");
    while (rows != nullptr && topics.size() < kMaxTopics &&
           sqlite3_step(rows.get()) == SQLITE_ROW) {
      const bool cdr = text_at(rows, 3) == "cdr";
      topics.try_emplace(
          sqlite3_column_int64(rows.get(), 0),
          Topic{text_at(rows, 1), text_at(rows, 2), cdr ? Encoding::kCdr : Encoding::kOther});
    }
  }

  /// In the order of recording, which follows the table and needs neither index nor sorting.
  void select_messages() {
    std::string wanted;
    for (const auto& [id, topic] : topics) {
      if (!carries_sensor_data(topic.type)) continue;
      wanted += fmt::format("{}{}", wanted.empty() ? "" : ",", id);
    }
    messages = prepare(database, fmt::format("SELECT rowid, topic_id, timestamp, "
                                             "CASE WHEN topic_id IN ({}) THEN data END "
                                             "FROM messages ORDER BY rowid",
                                             wanted));
    if (messages == nullptr) {
      throw InputError(fmt::format("{} is a ROS 2 bag of an unknown kind: {}.", file.string(),
                                   sqlite3_errmsg(database.get())));
    }
  }

  bool next(Message& message) {
    const int status = ended ? SQLITE_DONE : sqlite3_step(messages.get());
    ended = status != SQLITE_ROW;
    if (ended && status != SQLITE_DONE) fail(sqlite3_errmsg(database.get()));
    if (ended) return false;
    const std::int64_t row = sqlite3_column_int64(messages.get(), 0);
    // A damaged tree may lead round in circles.
    if (row <= last_row) {
      fail("its rows are out of order");
      return false;
    }
    last_row = row;
    ++count;
    static const Topic kUnknown;
    const auto topic = topics.find(sqlite3_column_int64(messages.get(), 1));
    const Topic& found = topic != topics.end() ? topic->second : kUnknown;
    const auto* const data = static_cast<const std::byte*>(sqlite3_column_blob(messages.get(), 3));
    const auto size = static_cast<std::size_t>(sqlite3_column_bytes(messages.get(), 3));
    message = {found.name,
               found.type,
               found.encoding,
               {sqlite3_column_int64(messages.get(), 2)},
               data != nullptr ? ByteSpan(data, size) : ByteSpan()};
    return true;
  }

  void fail(const std::string& why) {
    ended = true;
    problem =
        fmt::format("The recording {} breaks off after {} messages ({}); what came before is used.",
                    file.string(), count, why);
  }

  const std::filesystem::path file;
  const Database database;
  std::map<std::int64_t, Topic> topics;
  Statement messages;
  bool ended = false;
  std::uint64_t count = 0;
  std::int64_t last_row = std::numeric_limits<std::int64_t>::min();
  std::string problem;
};

SqliteBagReader::SqliteBagReader(const std::filesystem::path& file)
    : impl_(std::make_unique<Impl>(file)) {}
SqliteBagReader::~SqliteBagReader() = default;

bool SqliteBagReader::next(Message& message) { return impl_->next(message); }
std::string SqliteBagReader::problem() const { return impl_->problem; }

}  // namespace glint::recording
