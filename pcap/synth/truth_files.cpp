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

// Scans within this distance of one from which so much way was made since: places seen again.
constexpr double kRevisitM = 2.0;
constexpr double kRevisitWayM = 10.0;
constexpr std::int64_t kDenseStepNs = kNsPerSecond / 100;

// A text file that has its name only once it is whole.
class TextFile {
 public:
  explicit TextFile(std::filesystem::path file)
      : file_(std::move(file)), part_(file_.string() + ".part"), out_(part_) {
    check();
  }
  ~TextFile() {
    if (finished_) return;
    std::error_code ignored;
    std::filesystem::remove(part_, ignored);
  }
  TextFile(const TextFile&) = delete;
  TextFile& operator=(const TextFile&) = delete;

  void line(const std::string& text) {
    out_ << text << '\n';
    check();
  }
  void finish() {
    out_.close();
    check();
    std::error_code error;
    std::filesystem::rename(part_, file_, error);
    if (error) fail(error.message());
    finished_ = true;
  }

 private:
  void check() const {
    if (!out_) fail(std::strerror(errno));
  }
  [[noreturn]] void fail(const std::string& cause) const {
    throw InputError(
        fmt::format("cannot write {}: {}; name a directory that can be written and has room",
                    file_.string(), cause));
  }

  std::filesystem::path file_;
  std::filesystem::path part_;
  std::ofstream out_;
  bool finished_ = false;
};

// Scans where the path came by before, in runs.
class RevisitFinder {
 public:
  nlohmann::json add(const Eigen::Vector3d& here_m) {
    const double way_m =
        places_.empty() ? 0.0 : places_.back().way_m + (here_m - places_.back().at_m).norm();
    nlohmann::json runs = nlohmann::json::array();
    int last = -2;
    for (int i = 0; i < static_cast<int>(places_.size()); ++i) {
      const Place& place = places_[static_cast<std::size_t>(i)];
      if (way_m - place.way_m < kRevisitWayM) break;
      if ((place.at_m - here_m).norm() > kRevisitM) continue;
      if (last != i - 1) runs.push_back({i, i});
      runs.back()[1] = last = i;
    }
    places_.push_back({here_m, way_m});
    return runs;
  }

 private:
  struct Place {
    Eigen::Vector3d at_m;
    double way_m;
  };
  std::vector<Place> places_;
};

std::string seconds(SensorTime time) {
  return fmt::format("{}.{:09}", time.ns / kNsPerSecond, time.ns % kNsPerSecond);
}

std::string tum_line(SensorTime time, const Pose& pose) {
  const Eigen::Vector3d& p = pose.translation_m;
  const Eigen::Quaterniond& q = pose.rotation;
  return fmt::format("{} {:.9f} {:.9f} {:.9f} {:.12f} {:.12f} {:.12f} {:.12f}", seconds(time),
                     p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w());
}

std::string truth_line(const ScanTruth& truth, RevisitFinder& revisits) {
  nlohmann::ordered_json line = {{"scan", truth.scan},
                                 {"frame_id", truth.frame_id},
                                 {"t_ns", truth.start.ns},
                                 {"t", seconds(truth.start)},
                                 {"blind_axes", nlohmann::json::array()},
                                 {"moving_share", truth.moving_share}};
  for (const Eigen::Vector3d& axis : truth.blind_axes) {
    line["blind_axes"].push_back({axis.x(), axis.y(), axis.z()});
  }
  line["earlier_scans_within_2m"] = revisits.add(truth.T_world_sensor.translation_m);
  return line.dump();
}

void write_dense_truth(const Simulator& simulator, TextFile& file) {
  const SensorTime end = simulator.column_time(std::int64_t{simulator.scan_count()} *
                                               simulator.info().columns_per_frame);
  for (SensorTime t = simulator.column_time(0); t <= end; t = t + kDenseStepNs) {
    file.line(tum_line(t, simulator.true_pose(t)));
  }
}

void make_directory(const std::filesystem::path& directory) {
  std::error_code error;
  std::filesystem::create_directories(directory, error);
  if (!error) return;
  throw InputError(fmt::format("cannot make the directory {}: {}; name one that can be written",
                               directory.string(), error.message()));
}

}  // namespace

void simulate(const SimulationOptions& options, const std::filesystem::path& directory,
              const std::function<void(int done, int all)>& progress) {
  SyntheticSource source(options);
  const Simulator& simulator = source.simulator();
  make_directory(directory);
  CaptureWriter capture(directory / "capture.pcap");
  TextFile metadata(directory / "metadata.json");
  TextFile starts(directory / "groundtruth.tum");
  TextFile dense(directory / "groundtruth_100hz.tum");
  TextFile truth(directory / "truth.jsonl");
  metadata.line(to_metadata_json(simulator.info()));

  const auto port = static_cast<std::uint16_t>(simulator.info().lidar_port);
  const Endpoint sensor{IpAddress::v4(192, 168, 100, 2), port};
  const Endpoint host{IpAddress::v4(192, 168, 100, 1), port};
  RevisitFinder revisits;
  RawPacket packet;
  std::size_t scans = 0;
  while (source.read(packet) == SourceStatus::kPacket) {
    capture.write(packet.host_time, sensor, host, packet.bytes);
    if (source.truth().size() == scans) continue;
    const ScanTruth& scan = source.truth().back();
    starts.line(tum_line(scan.start, scan.T_world_sensor));
    truth.line(truth_line(scan, revisits));
    scans = source.truth().size();
    if (progress) progress(static_cast<int>(scans), simulator.scan_count());
  }
  write_dense_truth(simulator, dense);

  // An older capture must not stand beside the new truth.
  std::error_code ignored;
  std::filesystem::remove(directory / "capture.pcap", ignored);
  metadata.finish();
  starts.finish();
  dense.finish();
  truth.finish();
  capture.finish();
}

}  // namespace glint::synth
