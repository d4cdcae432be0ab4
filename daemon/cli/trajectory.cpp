// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
//
// glint trajectory: the daemon's past poses as a TUM file.
#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <filesystem>
#include <iostream>
#include <memory>
#include <vector>

#include "daemon/cli/client_command.hpp"
#include "daemon/cli/command.hpp"
#include "daemon/cli/trajectory_writer.hpp"

namespace glint::cli {
namespace {

using daemon::Json;

struct TrajectoryCommand {
  ClientOptions client;
  std::filesystem::path out;
  std::string frame = "map";
  std::string child = "sensor";
};

StampedPose stamped_pose(const Json& told) {
  const auto p_m = told.at("p_m").get<std::array<double, 3>>();
  const auto q = told.at("q_xyzw").get<std::array<double, 4>>();
  return {{told.at("t_ns").get<std::int64_t>()},
          {Eigen::Quaterniond(q[3], q[0], q[1], q[2]), {p_m[0], p_m[1], p_m[2]}}};
}

void run(const TrajectoryCommand& command) {
  with_client(command.client, [&](daemon::Client& client) {
    Json params = {{"frame", command.frame}, {"child", command.child}};
    std::vector<StampedPose> poses;
    Json page;
    do {
      page = client.call("get_trajectory", params);
      for (const Json& told : page.at("poses")) poses.push_back(stamped_pose(told));
      if (page.contains("next_cursor")) params["cursor"] = page["next_cursor"];
    } while (page.contains("next_cursor"));
    write_tum(command.out, poses);
    if (command.client.json) {
      std::cout << Json{{"file", command.out.string()},
                        {"poses", poses.size()},
                        {"frame", command.frame},
                        {"map_epoch", page["map_epoch"]}}
                       .dump()
                << '\n';
    } else {
      fmt::print("{}: {} poses in frame {}\n", command.out.string(), poses.size(), command.frame);
    }
  });
}

}  // namespace

void add_trajectory(CLI::App& app) {
  auto command = std::make_shared<TrajectoryCommand>();
  CLI::App* sub = app.add_subcommand("trajectory", "Fetch the daemon's past poses as a TUM file");
  add_client_options(*sub, command->client);
  sub->add_option("--out", command->out, "TUM file to write: t x y z qx qy qz qw")->required();
  sub->add_option("--frame", command->frame, "map or odom")
      ->check(CLI::IsMember({"map", "odom"}))
      ->capture_default_str();
  sub->add_option("--child", command->child, "sensor or base")
      ->check(CLI::IsMember({"sensor", "base"}))
      ->capture_default_str();
  sub->callback([command] { run(*command); });
}

}  // namespace glint::cli
