// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "pcap/synth/truth_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <system_error>

#include "driver/core/error.hpp"
#include "pcap/capture_writer.hpp"
#include "pcap/synth/synthetic_source.hpp"

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
  nlohmann::json add(int scan, const Eigen::Vector3d& here_m) {
    if (last_scan_ >= 0) way_m_ += (here_m - last_m_).norm();
    std::vector<int> near;
    const Cell cell = cell_of(here_m);
    for (int i = 0; i < 27; ++i) {
      const auto found =
          places_.find({cell[0] + i % 3 - 1, cell[1] + i / 3 % 3 - 1, cell[2] + i / 9 - 1});
      if (found == places_.end()) continue;
      for (const Place& place : found->second) {
        if (way_m_ - place.way_m >= kRevisitWayM && (place.at_m - here_m).norm() <= kRevisitM) {
          near.push_back(place.scan);
        }
      }
    }
    places_[cell].push_back({scan, here_m, way_m_});
    last_scan_ = scan;
    last_m_ = here_m;
    return runs(std::move(near));
  }

 private:
  using Cell = std::array<int, 3>;
  struct Place {
    int scan;
    Eigen::Vector3d at_m;
    double way_m;
  };
  static Cell cell_of(const Eigen::Vector3d& at_m) {
    const Eigen::Vector3d cell = (at_m / kRevisitM).array().floor();
    return {static_cast<int>(cell.x()), static_cast<int>(cell.y()), static_cast<int>(cell.z())};
  }
  static nlohmann::json runs(std::vector<int> scans) {
    std::sort(scans.begin(), scans.end());
    nlohmann::json runs = nlohmann::json::array();
    int last = -2;
    for (const int scan : scans) {
      if (last != scan - 1) runs.push_back({scan, scan});
      runs.back()[1] = last = scan;
    }
    return runs;
  }

  std::map<Cell, std::vector<Place>> places_;
  int last_scan_ = -1;
  Eigen::Vector3d last_m_ = Eigen::Vector3d::Zero();
  double way_m_ = 0.0;
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
                                 {"moving_share", truth.moving_share},
                                 {"moving_pixels", nlohmann::json::array()}};
  for (const Eigen::Vector3d& axis : truth.blind_axes) {
    line["blind_axes"].push_back({axis.x(), axis.y(), axis.z()});
  }
  for (const MovingRun& run : truth.moving) {
    line["moving_pixels"].push_back({run.row, run.first_column, run.last_column});
  }
  line["earlier_scans_within_2m"] = revisits.add(truth.scan, truth.T_world_sensor.translation_m);
  return line.dump();
}

void write_dense_truth(const Simulator& simulator, TextFile& file) {
  const Timing& timing = simulator.timing();
  const SensorTime end = timing.clock_at(
      timing.column_s(std::int64_t{simulator.scan_count()} * simulator.info().columns_per_frame));
  for (SensorTime t = timing.clock_at(0.0); t <= end; t = t + kDenseStepNs) {
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

FaultCounts simulate(const SimulationOptions& options, const std::filesystem::path& directory,
                     int mtu, const std::function<void(int done, int all)>& progress) {
  SyntheticSource source(options);
  const Simulator& simulator = source.simulator();
  make_directory(directory);
  CaptureWriter capture(directory / "capture.pcap", {mtu});
  TextFile metadata(directory / "metadata.json");
  TextFile starts(directory / "groundtruth.tum");
  TextFile dense(directory / "groundtruth_100hz.tum");
  TextFile truth(directory / "truth.jsonl");
  metadata.line(to_metadata_json(simulator.info()));

  const IpAddress sensor = IpAddress::v4(192, 168, 100, 2);
  const IpAddress host = IpAddress::v4(192, 168, 100, 1);
  RevisitFinder revisits;
  RawPacket packet;
  int written = -1;
  while (source.read(packet) == SourceStatus::kPacket) {
    capture.write(packet.host_time, {sensor, packet.port}, {host, packet.port}, packet.bytes);
    const ScanTruth& scan = source.truth();
    if (scan.scan == written) continue;
    written = scan.scan;
    starts.line(tum_line(scan.start, scan.T_world_sensor));
    truth.line(truth_line(scan, revisits));
    if (progress) progress(written + 1, simulator.scan_count());
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
  return source.faults();
}

}  // namespace glint::synth
