// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>
#include <system_error>

#include "driver/core/error.hpp"
#include "pcap/capture_writer.hpp"
#include "pcap/synth/simulator.hpp"

namespace glint::synth {
namespace {

// Scans within this distance of one at least this much older are places seen again.
constexpr double kRevisit_m = 2.0;
constexpr std::int64_t kRevisitAge_ns = 10 * kNsPerSecond;

// One output file: lines go in, a failed write is told with its name.
class LineFile {
 public:
  explicit LineFile(std::filesystem::path file) : file_(std::move(file)), out_(file_) { check(); }
  void write(const std::string& line) {
    out_ << line << '\n';
    check();
  }
  void finish() {
    out_.close();
    check();
  }

 private:
  void check() const {
    if (out_) return;
    throw InputError(
        fmt::format("cannot write {}: {}; name a directory that is writable and has room",
                    file_.string(), std::strerror(errno)));
  }
  std::filesystem::path file_;
  std::ofstream out_;
};

std::string tum_line(SensorTime time, const Pose& pose) {
  const auto& t = pose.translation_m;
  const auto& q = pose.rotation;
  return fmt::format("{}.{:09} {:.9f} {:.9f} {:.9f} {:.12f} {:.12f} {:.12f} {:.12f}",
                     time.ns / kNsPerSecond, time.ns % kNsPerSecond, t.x(), t.y(), t.z(), q.x(),
                     q.y(), q.z(), q.w());
}

std::string truth_line(const std::vector<ScanTruth>& truth, std::size_t index) {
  const ScanTruth& scan = truth[index];
  nlohmann::ordered_json line = {{"frame_id", scan.frame_id},
                                 {"t_ns", scan.start.ns},
                                 {"blind_axes", nlohmann::json::array()},
                                 {"moving_share", scan.moving_share},
                                 {"revisits", nlohmann::json::array()}};
  for (const Eigen::Vector3d& axis : scan.blind_axes) {
    line["blind_axes"].push_back({axis.x(), axis.y(), axis.z()});
  }
  for (std::size_t i = 0; i < index && scan.start - truth[i].start > kRevisitAge_ns; ++i) {
    const double distance_m =
        (truth[i].T_world_sensor.translation_m - scan.T_world_sensor.translation_m).norm();
    if (distance_m < kRevisit_m) line["revisits"].push_back(truth[i].frame_id);
  }
  return line.dump();
}

void write_truth(const SyntheticSource& source, const std::filesystem::path& directory) {
  const std::vector<ScanTruth>& truth = source.truth();
  LineFile starts(directory / "groundtruth.tum");
  LineFile lines(directory / "truth.jsonl");
  for (std::size_t i = 0; i < truth.size(); ++i) {
    starts.write(tum_line(truth[i].start, truth[i].T_world_sensor));
    lines.write(truth_line(truth, i));
  }
  starts.finish();
  lines.finish();
  LineFile dense(directory / "groundtruth_100hz.tum");
  const Simulator& simulator = source.simulator();
  const SensorTime end = simulator.column_time(std::int64_t{simulator.scan_count()} *
                                               simulator.info().columns_per_frame);
  for (SensorTime t = simulator.column_time(0); t <= end; t = t + kNsPerSecond / 100) {
    dense.write(tum_line(t, simulator.true_pose(t)));
  }
  dense.finish();
}

}  // namespace

void simulate(const SimulationOptions& options, const std::filesystem::path& directory) {
  SyntheticSource source(options);
  std::error_code error;
  std::filesystem::create_directories(directory, error);
  if (error) {
    throw InputError(fmt::format("cannot create the directory {}: {}; name one that can be written",
                                 directory.string(), error.message()));
  }
  CaptureWriter capture(directory / "capture.pcap");
  LineFile metadata(directory / "metadata.json");
  metadata.write(to_metadata_json(source.simulator().info()));
  metadata.finish();

  const auto port = static_cast<std::uint16_t>(source.simulator().info().lidar_port);
  const Endpoint sensor{IpAddress::parse("192.168.100.2").value(), port};
  const Endpoint host{IpAddress::parse("192.168.100.1").value(), port};
  RawPacket packet;
  while (source.read(packet) == SourceStatus::kPacket) {
    capture.write(packet.host_time, sensor, host, packet.bytes);
  }
  write_truth(source, directory);
  capture.finish();
}

}  // namespace glint::synth
