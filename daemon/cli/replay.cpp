// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
// glint replay: runs the pipeline over a capture and leaves trajectory, map, session and report.
#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <filesystem>
#include <iostream>
#include <memory>

#include "daemon/cli/capture_input.hpp"
#include "daemon/cli/command.hpp"
#include "daemon/cli/replay_run.hpp"
#include "daemon/cli/report.hpp"
#include "daemon/cli/scan_table.hpp"
#include "daemon/cli/text_file.hpp"
#include "daemon/cli/trajectory_error.hpp"
#include "daemon/cli/trajectory_writer.hpp"
#include "daemon/clock_settings.hpp"
#include "daemon/config_layers.hpp"
#include "daemon/export/ply_writer.hpp"
#include "daemon/replay_pacer.hpp"
#include "daemon/version.hpp"
#include "pcap/pcap_source.hpp"
#include "slam/loops/loops_by_appearance.hpp"

namespace glint::cli {
namespace {

struct ReplayCommand {
  CaptureInput input;
  std::filesystem::path out;
  std::string preset;
  std::filesystem::path config_file;
  std::vector<std::string> settings;
  std::filesystem::path truth;
  std::filesystem::path map;
  std::string rate = "max";
  std::uint64_t frames = 0;
};

std::atomic<bool> interrupted = false;

// The configuration file, then the preset named on the command line, then each --set.
daemon::Config effective_config(const ReplayCommand& command) {
  daemon::Config config;
  if (!command.config_file.empty()) {
    config = daemon::read_config_layers(command.config_file, {}).config;
  }
  if (!command.preset.empty()) config.slam = slam::preset_config(command.preset);
  daemon::apply_settings(config, command.settings);
  return config;
}

// Null for --rate max: packets then come as fast as they are read.
Pacer pacer_for(const std::string& rate) {
  const auto speed = daemon::parse_rate(rate);
  if (!speed) return {};
  return [pacer = std::make_shared<daemon::ReplayPacer>(*speed)](HostTime t) {
    return pacer->wait(t);
  };
}

double peak_rss_mb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

struct Totals {
  double duration_s = 0.0;
  double lost_s = 0.0;
  double degenerate_s = 0.0;  // Where an axis was left to the motion before.
  double completeness_mean = 0.0;
  std::size_t poses = 0;
  double path_m = 0.0;
  double keypoints_mean = 0.0;
  double matches_mean = 0.0;
  double inliers_mean = 0.0;
};

Totals totals_of(const ReplayResult& result, const SensorInfo& info) {
  Totals totals;
  const double period_s = static_cast<double>(info.scan_period_ns()) * kSecondsPerNs;
  const slam::OdometryEstimate* last = nullptr;
  for (const slam::OdometryEstimate& estimate : result.estimates) {
    const auto scans = static_cast<double>(result.estimates.size());
    totals.completeness_mean += estimate.completeness / scans;
    totals.keypoints_mean += estimate.keypoints / scans;
    totals.matches_mean += estimate.matches / scans;
    totals.inliers_mean += estimate.inliers / scans;
    if (estimate.state == slam::TrackingState::kLost) totals.lost_s += period_s;
    if (estimate.weak_axes.any_critical()) totals.degenerate_s += period_s;
    if (!has_pose(estimate)) continue;
    if (last != nullptr && last->segment == estimate.segment) {
      totals.path_m +=
          (estimate.T_odom_sensor.translation_m - last->T_odom_sensor.translation_m).norm();
    }
    last = &estimate;
    ++totals.poses;
  }
  if (!result.estimates.empty()) {
    // From the start of the first scan to the end of the last one.
    totals.duration_s =
        static_cast<double>(result.estimates.back().stamp - result.estimates.front().stamp) *
            kSecondsPerNs +
        period_s;
  }
  return totals;
}

nlohmann::ordered_json summary_of(const ReplayResult& result, const SensorInfo& info,
                                  const daemon::Config& config) {
  const Totals totals = totals_of(result, info);
  const AssemblerCounters& packets = result.packets;
  nlohmann::ordered_json summary = {
      {"version", kVersion},
      {"preset", config.slam.preset},
      {"frames", result.estimates.size()},
      {"frames_dropped", 0},
      {"frames_with_pose", totals.poses},
      {"completeness_mean", totals.completeness_mean},
      {"duration_s", totals.duration_s},
      {"wall_s", result.wall_s},
      {"realtime_factor", result.wall_s > 0 ? totals.duration_s / result.wall_s : 0.0},
      {"path_m", totals.path_m},
      {"keyframes", result.map->keyframe_count},
      {"map_points", result.map->point_count},
      {"map_points_refused", result.map->points_refused},
      {"loops_accepted", result.loops_accepted},
      {"loops_rejected", result.loops_rejected},
      {"map_epoch", result.correction.epoch},
      {"placed_in_map", result.correction.placed},
      {"degenerate_s", totals.degenerate_s},
      {"lost_s", totals.lost_s},
      {"interrupted", result.interrupted},
      {"peak_rss_mb", peak_rss_mb()}};
  summary["packets"] = {{"accepted", packets.packets},
                        {"imu", packets.imu_packets},
                        {"missing", packets.missing_packets},
                        {"late", packets.late_packets},
                        {"duplicate", packets.duplicate_packets},
                        {"bad", packets.bad_size + packets.bad_type + packets.bad_serial},
                        {"corrupt", packets.corrupt_packets},
                        {"bad_columns", packets.bad_column},
                        {"sensor_restarts", packets.restarts}};
  summary["tracking"] = {{"keypoints_mean", totals.keypoints_mean},
                         {"matches_mean", totals.matches_mean},
                         {"inliers_mean", totals.inliers_mean}};
  for (const auto& [name, ms] : result.stages.paper_table()) {
    summary["paper_table_ms"][std::string(name)] = {{"mean", ms.mean}, {"std", ms.std}};
  }
  summary["stage_ms"] = result.stages.to_json(false);
  summary["stage_cpu_ms"] = result.stages.to_json(true);
  summary["config"] = daemon::to_json(config);
  return summary;
}

struct Trajectories {
  std::vector<StampedPose> odometry;  // As told live.
  // In the map frame, as the back end leaves it; none where the sensor was not found in the map.
  std::vector<StampedPose> optimised;
};

Trajectories trajectories_of(const ReplayResult& result) {
  Trajectories trajectories;
  for (const slam::OdometryEstimate& estimate : result.estimates) {
    if (!has_pose(estimate)) continue;
    trajectories.odometry.push_back({estimate.stamp, estimate.T_odom_sensor});
    if (!result.correction.placed) continue;
    trajectories.optimised.push_back({estimate.stamp, map_pose(result, estimate)});
  }
  return trajectories;
}

void write_trajectories(const std::filesystem::path& out, const Trajectories& trajectories) {
  write_tum(out / "odometry.tum", trajectories.odometry);
  write_tum(out / "trajectory.tum", trajectories.optimised);
  write_kitti(out / "trajectory.kitti", out / "times.txt", trajectories.optimised);
  if (const std::size_t lacking = count_not_rising(trajectories.odometry); lacking > 0) {
    std::cerr << "glint: the sensor's clock went back, so " << lacking
              << " poses have no line in the trajectories, whose times must rise\n";
  }
}

// Adds the error against --truth to the summary; returns the line that says it.
std::string compare_with_truth(const std::filesystem::path& truth_file,
                               const Trajectories& trajectories, nlohmann::ordered_json& summary) {
  if (truth_file.empty()) return {};
  const auto error = trajectory_error(trajectories.optimised, read_tum(truth_file));
  if (!error) return "trajectory error: the truth has fewer than three poses in common\n";
  summary["truth"] = {{"ate_rmse_m", error->ate_rmse_m},
                      {"ate_max_m", error->ate_max_m},
                      {"path_m", error->path_m},
                      {"poses", error->poses}};
  return fmt::format(
      "trajectory error: {:.3f} m RMSE, {:.3f} m at most, over {:.1f} m of true path\n",
      error->ate_rmse_m, error->ate_max_m, error->path_m);
}

// The paper's own table of times on one line.
std::string paper_line(const StageStatistics& stages) {
  std::string line;
  for (const auto& [name, ms] : stages.paper_table()) {
    line +=
        fmt::format("{}{} {:.2f} ± {:.2f}", line.empty() ? "ms: " : ", ", name, ms.mean, ms.std);
  }
  return line + '\n';
}

// A line that is rewritten on a terminal; nothing in a pipe.
void show_progress(std::uint64_t scans) {
  static const bool terminal = isatty(STDERR_FILENO) != 0;
  if (terminal && scans % 10 == 0) std::cerr << "\rglint: " << scans << " scans" << std::flush;
}

void end_progress(const ReplayResult& result, const ReplayCommand& command) {
  if (isatty(STDERR_FILENO) != 0) std::cerr << '\r';
  if (!result.source_error.empty()) std::cerr << "glint: " << result.source_error << '\n';
  if (result.keyframes_not_stored > 0) {
    std::cerr << "glint: " << result.keyframes_not_stored << " keyframes are missing in "
              << (command.out / "session.glint").string() << ": " << result.store_error << '\n';
  }
}

void run(const ReplayCommand& command) {
  const daemon::Config config = effective_config(command);
  const SensorInfo info =
      daemon::with_clock_settings(load_capture_info(command.input), config.sensor);
  const auto source = open_capture(command.input, info, pacer_for(command.rate));
  std::error_code error;
  std::filesystem::create_directories(command.out, error);
  if (error) {
    throw InputError("cannot create the directory " + command.out.string() + ": " +
                     error.message() + "; name one that can be written with --out");
  }
  ReplayOptions options;
  options.slam = config.slam;
  options.slam.map_memory_mb = config.map.memory_mb;
  options.loops = slam::loops_by_appearance(config.slam);
  options.R_base_sensor = config.mount.T_base_sensor.rotation;
  options.session_file = command.out / "session.glint";
  options.earlier_session = command.map;
  options.max_scans = command.frames;
  options.on_scan = [](std::uint64_t scans) {
    show_progress(scans);
    return !interrupted;
  };
  std::signal(SIGINT, [](int) { interrupted = true; });
  const ReplayResult result = run_replay(*source, info, options);
  std::signal(SIGINT, SIG_DFL);
  end_progress(result, command);
  print_notices(source->notices());

  auto summary = summary_of(result, info, config);
  const Trajectories trajectories = trajectories_of(result);
  const std::string comparison = compare_with_truth(command.truth, trajectories, summary);
  write_trajectories(command.out, trajectories);
  write_scan_table(command.out / "scans.csv", result.estimates);
  write_ply(command.out / "map.ply", map_points(*result.map));
  write_text_file(command.out / "summary.json", summary.dump(2) + "\n");
  write_report(command.out / "report.html",
               std::filesystem::path(command.input.capture).filename().string(), summary, result);
  if (!result.correction.placed) {
    std::cerr << "glint: the sensor was not found in the map of " << command.map.string()
              << ": trajectory.tum is empty, odometry.tum is not; without --map a map of its own "
                 "is made\n";
  }
  std::cout << summary["frames"] << " scans, " << summary["frames_with_pose"] << " with a pose, "
            << summary["keyframes"] << " keyframes, " << summary["loops_accepted"]
            << " loops; results in " << command.out.string() << '\n'
            << paper_line(result.stages) << comparison;
}

}  // namespace

void add_replay(CLI::App& app) {
  auto command = std::make_shared<ReplayCommand>();
  CLI::App* sub = app.add_subcommand("replay", "Run the pipeline over a capture");
  add_capture_options(*sub, command->input);
  sub->add_option("--out", command->out, "Directory for the results")->required();
  sub->add_option("--preset", command->preset, "paper or full (default: full)")
      ->check(CLI::IsMember({"paper", "full"}));
  sub->add_option("--config", command->config_file, "Configuration file (TOML)");
  sub->add_option("--set", command->settings, "Set one value: key=value; may be given again");
  sub->add_option("--rate", command->rate, "max, or a multiple of the recorded speed");
  sub->add_option("--truth", command->truth, "True trajectory (TUM) to compare with");
  sub->add_option("--map", command->map,
                  "Session (.glint) whose map to go on with; the sensor may begin anywhere in it");
  sub->add_option("--frames", command->frames, "Stop after this many scans");
  sub->callback([command] { run(*command); });
}

}  // namespace glint::cli
