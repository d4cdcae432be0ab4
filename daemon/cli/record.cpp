// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
//
// glint record: a live sensor's packets and metadata as a capture.
#include <fmt/format.h>

#include <fstream>
#include <iostream>
#include <iterator>
#include <memory>

#include "daemon/cli/command.hpp"
#include "daemon/record/recording.hpp"
#include "driver/core/error.hpp"
#include "driver/core/sensor_info.hpp"

namespace glint::cli {
namespace {

constexpr std::uint64_t kMegabyte = 1'000'000;

struct RecordOptions {
  daemon::RecordingOptions recording;
  std::string out;
  std::string meta;
  std::uint64_t split_mb = 0;
  std::uint64_t max_total_mb = 0;
};

void print_summary(const daemon::RecordingResult& done, const RecordOptions& options) {
  fmt::print(
      "recorded {} lidar and {} IMU packets in {:.1f} s: {:.1f} MB in {} file{}{}\n",
      done.lidar_packets, done.imu_packets, done.seconds,
      static_cast<double>(done.bytes) / static_cast<double>(kMegabyte),
      done.files - done.deleted_files, done.files - done.deleted_files == 1 ? "" : "s",
      done.deleted_files > 0 ? fmt::format(", {} older ones deleted", done.deleted_files) : "");
  fmt::print("dropped by the kernel {}, for a slow disk {}\n", done.kernel_drops, done.disk_drops);
  if (done.other_packets > 0) {
    fmt::print("{} packets have another size than the metadata say\n", done.other_packets);
  }
  if (done.kernel_drops > 0 && done.granted_rcvbuf_bytes < options.recording.rcvbuf_bytes) {
    std::cerr << fmt::format(
        "glint: the kernel grants a receive buffer of {} bytes only; run: sysctl -w "
        "net.core.rmem_max={}\n",
        done.granted_rcvbuf_bytes, options.recording.rcvbuf_bytes);
  }
}

void record(RecordOptions& options) {
  daemon::RecordingOptions& recording = options.recording;
  recording.files.file = options.out;
  recording.files.part_bytes = options.split_mb * kMegabyte;
  recording.files.max_total_bytes = options.max_total_mb * kMegabyte;
  if (options.max_total_mb != 0 && options.split_mb == 0) {
    throw UsageError("--max-total deletes the oldest part, so it needs --split MB.");
  }
  if (options.max_total_mb != 0 && options.max_total_mb < 2 * options.split_mb) {
    throw UsageError("--max-total must have room for two parts of --split.");
  }
  if (!options.meta.empty()) {
    static_cast<void>(load_sensor_info(options.meta));  // Tells what is wrong with it.
    std::ifstream in(options.meta, std::ios::binary);
    recording.metadata_json.assign(std::istreambuf_iterator<char>(in), {});
  }
  recording.on_news = [](const std::string& news) { std::cerr << "glint: " << news << '\n'; };
  print_summary(daemon::record(recording), options);
}

}  // namespace

void add_record(CLI::App& app) {
  CLI::App* const command = app.add_subcommand(
      "record", "Record a live sensor's packets and metadata, until Ctrl-C or --seconds");
  const auto options = std::make_shared<RecordOptions>();
  daemon::RecordingOptions& recording = options->recording;
  command
      ->add_option("--sensor", recording.sensor, "The sensor's name or address, if need be :PORT")
      ->required();
  command->add_option("--out", options->out, "Capture to write; metadata go beside it, as .json")
      ->required();
  command->add_option("--seconds", recording.seconds, "How long, s")->check(CLI::PositiveNumber);
  command
      ->add_option("--split", options->split_mb,
                   "Begin another file every so many MB: NAME_0001.pcap, NAME_0002.pcap, ...")
      ->check(CLI::PositiveNumber);
  command
      ->add_option("--max-total", options->max_total_mb,
                   "Delete the oldest files so that all have at most so many MB")
      ->check(CLI::PositiveNumber);
  command->add_flag("--configure", recording.configure,
                    "Have the sensor send here; without it, it is left as it is");
  command->add_option("--lidar-port", recording.lidar_port,
                      "Port of lidar packets; default: the "
                      "sensor's, with --configure 7502");
  command->add_option("--imu-port", recording.imu_port,
                      "Port of IMU packets; default: the sensor's, with --configure 7503");
  command->add_option("--meta", options->meta, "Metadata file, for a sensor that cannot be asked");
  command->add_option("--wait", recording.patience_s, "How long to wait for its metadata, s")
      ->check(CLI::Range(0.1, 86'400.0))
      ->capture_default_str();
  command->callback([options] { record(*options); });
}

}  // namespace glint::cli
