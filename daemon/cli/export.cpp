// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
//
// glint export: a session's map or trajectory in the files of other programs.
#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <string>

#include "daemon/cli/command.hpp"
#include "daemon/cli/trajectory_writer.hpp"
#include "daemon/export/las_writer.hpp"
#include "daemon/export/pcd_writer.hpp"
#include "daemon/export/pgm_writer.hpp"
#include "daemon/export/ply_writer.hpp"
#include "driver/core/error.hpp"
#include "slam/store/session_map.hpp"

namespace glint::cli {
namespace {

struct ExportCommand {
  std::filesystem::path session;
  std::string format;
  std::filesystem::path out;
  double voxel_m = 0.0;
  slam::FloorPlanOptions plan;
};

void export_points(const ExportCommand& command, const slam::SessionReader& session) {
  const auto points = map_points(*slam::session_map(session, command.voxel_m));
  if (command.format == "ply") write_ply(command.out, points);
  if (command.format == "pcd") write_pcd(command.out, points);
  if (command.format == "las") write_las(command.out, points);
  fmt::print("{}: {} points, map frame\n", command.out.string(), points.size());
}

void export_trajectory(const ExportCommand& command, const slam::SessionReader& session) {
  std::vector<StampedPose> poses;
  for (const slam::KeyframePose& keyframe : session.poses()) {
    poses.push_back({keyframe.stamp, keyframe.T_map_sensor});
  }
  if (command.format == "tum") {
    write_tum(command.out, poses);
  } else {
    std::filesystem::path times = command.out;
    times.replace_extension(".times.txt");
    write_kitti(command.out, times, poses);
    fmt::print("{}: their times, s\n", times.string());
  }
  const std::size_t lacking = count_not_rising(poses);
  fmt::print("{}: {} poses of keyframes, map frame\n", command.out.string(),
             poses.size() - lacking);
  if (lacking > 0) {
    fmt::print(stderr,
               "glint: the sensor's clock went back, so {} poses are left out, whose times must "
               "rise\n",
               lacking);
  }
}

void export_plan(const ExportCommand& command, const slam::SessionReader& session) {
  slam::FloorPlan plan(command.plan);
  session.for_each_keyframe([&](slam::SessionKeyframe&& keyframe) {
    plan.add(keyframe.T_map_sensor, keyframe.keyframe.points);
  });
  const slam::FloorPlanImage image = plan.image();
  const std::filesystem::path description = write_floor_plan(command.out, image);
  fmt::print("{}: {} x {} cells of {} m\n{}: its scale and place, for the map_server\n",
             command.out.string(), image.width, image.height, image.cell_m, description.string());
}

void run(const ExportCommand& command) {
  const slam::SessionReader session(command.session);
  if (session.keyframe_count() == 0) {
    throw InputError(command.session.string() + " holds no keyframe; name a session that has one");
  }
  if (command.format == "pgm") {
    export_plan(command, session);
  } else if (command.format == "tum" || command.format == "kitti") {
    export_trajectory(command, session);
  } else {
    export_points(command, session);
  }
}

}  // namespace

void add_export(CLI::App& app) {
  auto command = std::make_shared<ExportCommand>();
  CLI::App* sub = app.add_subcommand(
      "export", "Write a session's map (ply, pcd, las, pgm) or trajectory (tum, kitti)");
  sub->add_option("session", command->session, "Session file (.glint); it is only read")
      ->required();
  sub->add_option("--format", command->format, "ply, pcd, las, tum, kitti, or pgm with its .yaml")
      ->required()
      ->check(CLI::IsMember({"ply", "pcd", "las", "tum", "kitti", "pgm"}));
  sub->add_option("--out", command->out, "File to write")->required();
  sub->add_option("--voxel-m", command->voxel_m,
                  "Keep one point in each voxel of this size (default: the session's own)")
      ->check(CLI::Range(0.01, 100.0));
  sub->add_option("--cell-m", command->plan.cell_m, "pgm: edge of a cell (default: 0.05)")
      ->check(CLI::Range(0.01, 10.0));
  sub->add_option("--lowest-m", command->plan.lowest_m,
                  "pgm: lowest obstacle, above the floor (default: 0.15)");
  sub->add_option("--highest-m", command->plan.highest_m,
                  "pgm: highest obstacle, above the floor (default: 2)");
  sub->callback([command] { run(*command); });
}

}  // namespace glint::cli
