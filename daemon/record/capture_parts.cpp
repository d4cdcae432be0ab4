// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "daemon/record/capture_parts.hpp"

#include <fmt/format.h>

#include <utility>

#include "daemon/cli/text_file.hpp"
#include "driver/core/error.hpp"

namespace glint::daemon {

namespace fs = std::filesystem;

namespace {

fs::path metadata_file(fs::path capture) { return capture.replace_extension(".json"); }

fs::path part_name(const fs::path& file, std::uint64_t number) {
  return file.parent_path() /
         fmt::format("{}_{:04}{}", file.stem().string(), number, file.extension().string());
}

}  // namespace

CaptureParts::CaptureParts(CapturePartsOptions options, std::string metadata_json)
    : options_(std::move(options)), metadata_json_(std::move(metadata_json)) {
  begin_file();
}

void CaptureParts::write(HostTime host_time, const Endpoint& source, const Endpoint& destination,
                         std::span<const std::byte> payload) {
  if (options_.part_bytes != 0 && writer_->bytes() >= options_.part_bytes) begin_next_part();
  writer_->write(host_time, source, destination, payload);
}

void CaptureParts::set_metadata(std::string metadata_json) {
  metadata_json_ = std::move(metadata_json);
  if (options_.part_bytes != 0) begin_next_part();
}

void CaptureParts::begin_file() {
  ++files_;
  current_ = options_.part_bytes == 0 ? options_.file : part_name(options_.file, files_);
  for (const fs::path& file : {current_, metadata_file(current_)}) {
    std::error_code ignored;
    if (!fs::exists(file, ignored)) continue;
    throw InputError(
        fmt::format("{} is there already and is not written over; name another file, or remove it",
                    file.string()));
  }
  // First, so that there is no capture without its metadata.
  cli::write_text_file(metadata_file(current_), metadata_json_);
  writer_.emplace(current_, CaptureWriterOptions{.in_place = true});
}

void CaptureParts::begin_next_part() {
  writer_->finish();
  closed_.push_back({current_, writer_->bytes()});
  closed_bytes_ += writer_->bytes();
  begin_file();
  if (options_.max_total_bytes == 0) return;
  while (!closed_.empty() && closed_bytes_ + options_.part_bytes > options_.max_total_bytes) {
    delete_oldest();
  }
}

void CaptureParts::delete_oldest() {
  std::error_code ignored;
  fs::remove(closed_.front().file, ignored);
  fs::remove(metadata_file(closed_.front().file), ignored);
  closed_bytes_ -= closed_.front().bytes;
  closed_.pop_front();
  ++deleted_files_;
}

}  // namespace glint::daemon
