// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
//
// glint dump: the scans of a capture as NumPy arrays and pictures, for scripts and for looking at.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <iostream>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>

#include "daemon/cli/capture_input.hpp"
#include "daemon/cli/capture_json.hpp"
#include "daemon/cli/command.hpp"
#include "daemon/cli/npy_writer.hpp"
#include "daemon/cli/scan_reader.hpp"
#include "daemon/cli/text_file.hpp"
#include "daemon/png.hpp"
#include "driver/core/destagger.hpp"
#include "driver/core/error.hpp"
#include "driver/core/xyz_lut.hpp"

namespace glint::cli {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

struct DumpOptions {
  CaptureInput input;
  std::string out;
  std::string frames;
};

/// Frames [first, end), counted from 0 in the order of the capture.
struct FrameRange {
  int first = 0;
  int end = std::numeric_limits<int>::max();
};

/// Reads one side of A:B; false if it is neither empty nor a number.
bool parse_bound(std::string_view text, int& bound) {
  if (text.empty()) return true;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), bound);
  return error == std::errc() && end == text.data() + text.size() && bound >= 0;
}

FrameRange parse_frames(const std::string& text) {
  FrameRange range;
  if (text.empty()) return range;
  const std::size_t colon = text.find(':');
  const std::string_view whole = text;
  if (colon == std::string::npos || !parse_bound(whole.substr(0, colon), range.first) ||
      !parse_bound(whole.substr(colon + 1), range.end) || range.first >= range.end) {
    throw UsageError(
        fmt::format("--frames {} is no range; write A:B for the frames from A up to "
                    "but without B, counted from 0, or A: or :B.",
                    text));
  }
  return range;
}

/// Writes the files of one frame after the other.
class FrameWriter {
 public:
  FrameWriter(const SensorInfo& info, fs::path folder)
      : info_(info), lut_(info), folder_(std::move(folder)) {}

  /// Writes everything the scan holds under the prefix.
  void write(const LidarScan& scan, const std::string& prefix) {
    write_channel(scan.range_mm, prefix + "_range");
    write_channel(scan.signal, prefix + "_signal");
    write_channel(scan.reflectivity, prefix + "_reflectivity");
    write_channel(scan.near_ir, prefix + "_near_ir");
    write_channel(scan.range2_mm, prefix + "_range2");
    write_channel(scan.signal2, prefix + "_signal2");
    write_channel(scan.reflectivity2, prefix + "_reflectivity2");
    write_xyz(scan.range_mm, prefix + "_xyz");
    write_columns(scan, prefix);
  }

 private:
  /// A channel that the profile lacks has an empty image, and gets no file.
  template <class T>
  void write_channel(const Image<T>& staggered, const std::string& name) {
    if (staggered.empty()) return;
    Image<T> image(staggered.rows, staggered.cols);
    destagger(staggered, info_.pixel_shift_by_row, image);
    write_npy<T>(folder_ / (name + ".npy"), {size(image.rows), size(image.cols)}, image.data);
    write_png(folder_ / (name + ".png"), grey_preview(image));
  }

  void write_xyz(const Image<std::uint32_t>& range_mm, const std::string& name) {
    xyz_m_.resize(range_mm.data.size());
    lut_.destaggered_points(range_mm, info_.pixel_shift_by_row, xyz_m_);
    write_npy<double>(folder_ / (name + ".npy"), {size(range_mm.rows), size(range_mm.cols), 3},
                      {xyz_m_.data()->data(), 3 * xyz_m_.size()});
  }

  void write_columns(const LidarScan& scan, const std::string& prefix) {
    times_ns_.clear();
    for (const SensorTime time : scan.column_time) {
      times_ns_.push_back(static_cast<std::uint64_t>(time.ns));
    }
    write_npy<std::uint64_t>(folder_ / (prefix + "_time.npy"), {times_ns_.size()}, times_ns_);
    write_npy<std::uint32_t>(folder_ / (prefix + "_status.npy"), {scan.column_status.size()},
                             scan.column_status);
  }

  static std::size_t size(int dimension) { return static_cast<std::size_t>(dimension); }

  const SensorInfo& info_;
  const XyzLut lut_;
  const fs::path folder_;
  std::vector<Eigen::Vector3d> xyz_m_;
  std::vector<std::uint64_t> times_ns_;
};

/// The frame's entry in index.json. Columns that never came carry time 0 and are left out.
Json describe(const LidarScan& scan, int index, const std::string& prefix) {
  std::int64_t first_ns = std::numeric_limits<std::int64_t>::max();
  std::int64_t last_ns = 0;
  for (const SensorTime time : scan.column_time) {
    if (time.ns == 0) continue;
    first_ns = std::min(first_ns, time.ns);
    last_ns = std::max(last_ns, time.ns);
  }
  return {{"frame_id", scan.frame_id},
          {"index", index},
          {"file", prefix},
          {"completeness", scan.completeness()},
          {"columns_expected", scan.columns_expected},
          {"columns_received", scan.columns_received},
          {"first_time_ns", std::min(first_ns, last_ns)},
          {"last_time_ns", last_ns}};
}

void make_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (!error) return;
  throw InputError(fmt::format("The folder {} cannot be made: {}; choose another with --out.",
                               folder.string(), error.message()));
}

void dump(const DumpOptions& options) {
  const FrameRange range = parse_frames(options.frames);
  const SensorInfo info = load_capture_info(options.input);
  const auto source = open_capture(options.input, info);
  ScanReader reader(*source, info);
  const fs::path folder = options.out;
  make_folder(folder);

  FrameWriter writer(info, folder);
  Json frames = Json::array();
  for (int index = 0; index < range.end; ++index) {
    const LidarScan* const scan = reader.next();
    if (scan == nullptr) break;
    if (index < range.first) continue;
    const std::string prefix = fmt::format("frame_{:05}", index);
    writer.write(*scan, prefix);
    frames.push_back(describe(*scan, index, prefix));
  }

  print_notices(source->notices());
  const Json summary = {{"capture", options.input.capture},
                        {"profile", to_string(info.profile)},
                        {"rows", info.pixels_per_column},
                        {"columns", info.columns_per_frame},
                        {"frames", frames},
                        {"counters",
                         {{"assembler", to_json(reader.assembler().counters())},
                          {"source", source_json(*source)},
                          {"capture", capture_json(*source)}}},
                        {"notices", source->notices()}};
  write_text_file(folder / "index.json", summary.dump(2) + "\n");
  std::cout << fmt::format("{} frames written to {}\n", frames.size(), folder.string());
}

}  // namespace

void add_dump(CLI::App& app) {
  CLI::App* const command =
      app.add_subcommand("dump", "Write a capture's scans as NumPy arrays and PNG pictures");
  const auto options = std::make_shared<DumpOptions>();
  add_capture_options(*command, options->input);
  command->add_option("--out", options->out, "Folder to write to")->required();
  command->add_option("--frames", options->frames,
                      "A:B: frames from A up to but without B, counted from 0");
  command->callback([options] { dump(*options); });
}

}  // namespace glint::cli
