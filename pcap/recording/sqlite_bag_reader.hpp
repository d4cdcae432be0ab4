// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "pcap/recording/message.hpp"

namespace glint::recording {

/// First bytes of an SQLite database, the zero that ends them left out.
constexpr std::string_view kSqliteMagic = "SQLite format 3";

/// Reads one file of a ROS 2 bag stored in SQLite. The file is never written to; what a recorder
/// that died left in a write-ahead log beside it is read as well. Bytes of messages of no interest
/// are left in the file.
class SqliteBagReader : public MessageReader {
 public:
  /// @throws InputError if the file cannot be read, or is a database of another purpose.
  explicit SqliteBagReader(const std::filesystem::path& file);
  ~SqliteBagReader() override;

  bool next(Message& message) override;
  [[nodiscard]] std::string problem() const override;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace glint::recording
