// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "pcap/recording/message_files.hpp"

#include <fmt/format.h>

#include <optional>
#include <utility>
#include <vector>

#include "driver/core/error.hpp"
#include "pcap/recording/mcap_reader.hpp"
#include "pcap/recording/osf_file.hpp"
#include "pcap/recording/recording_files.hpp"
#include "pcap/recording/ros1_bag_reader.hpp"
#include "pcap/recording/sqlite_bag_reader.hpp"
#include "pcap/recording/unpacked_file.hpp"

namespace glint::recording {
namespace {

namespace fs = std::filesystem;

/// @param name The file as the user knows it, for messages.
std::unique_ptr<MessageReader> open_plain(const fs::path& file, const fs::path& name) {
  switch (recording_format(file)) {
    case RecordingFormat::kRos1:
      return std::make_unique<Ros1BagReader>(file);
    case RecordingFormat::kSqlite:
      return std::make_unique<SqliteBagReader>(file);
    case RecordingFormat::kMcap:
      return std::make_unique<McapReader>(file);
    case RecordingFormat::kOsf:
      throw InputError(osf_refusal(file, name));
    case RecordingFormat::kZstd:
    case RecordingFormat::kNone:
      break;
  }
  throw InputError(
      fmt::format("{} is no recording: neither a ROS 1 bag, nor a ROS 2 bag (SQLite or MCAP), nor "
                  "an MCAP file.",
                  name.string()));
}

/// One file, packed or not.
class MessageFile : public MessageReader {
 public:
  explicit MessageFile(const fs::path& file) {
    if (recording_format(file) == RecordingFormat::kZstd) unpacked_.emplace(file);
    reader_ = open_plain(unpacked_ ? unpacked_->path() : file, file);
  }
  bool next(Message& message) override { return reader_->next(message); }
  [[nodiscard]] std::string problem() const override {
    // What cuts the unpacked file short is that the packed one is.
    if (unpacked_ && !unpacked_->problem().empty()) return unpacked_->problem();
    return reader_->problem();
  }

 private:
  std::optional<UnpackedFile> unpacked_;
  std::unique_ptr<MessageReader> reader_;
};

/// Several files, one after the other. One that cannot be read is told of and passed over.
class MessageChain : public MessageReader {
 public:
  explicit MessageChain(std::vector<fs::path> files) : files_(std::move(files)) {}

  bool next(Message& message) override {
    while (true) {
      if (reader_ != nullptr && reader_->next(message)) return true;
      close();
      if (opened_ == files_.size()) return false;
      open(files_[opened_++]);
    }
  }
  [[nodiscard]] std::string problem() const override { return problem_; }

 private:
  void open(const fs::path& file) {
    try {
      reader_ = std::make_unique<MessageFile>(file);
    } catch (const InputError& error) {
      add_problem(error.what());
    }
  }
  void close() {
    if (reader_ != nullptr) add_problem(reader_->problem());
    reader_.reset();
  }
  void add_problem(const std::string& problem) {
    if (!problem.empty()) problem_ += (problem_.empty() ? "" : " ") + problem;
  }

  const std::vector<fs::path> files_;
  std::size_t opened_ = 0;
  std::unique_ptr<MessageFile> reader_;
  std::string problem_;
};

}  // namespace

std::unique_ptr<MessageReader> open_messages(const fs::path& path) {
  std::vector<fs::path> files = recording_files(path);
  if (files.empty()) {
    throw InputError(fmt::format("There is no recording in the folder {}.", path.string()));
  }
  if (files.size() == 1) return std::make_unique<MessageFile>(files.front());
  return std::make_unique<MessageChain>(std::move(files));
}

}  // namespace glint::recording
