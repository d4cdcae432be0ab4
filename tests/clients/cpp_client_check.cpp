// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
//
// What the C++ client gets from a glintd, as JSON for cpp_client_test.py to compare.
// usage: cpp_client_check TARGET ask|follow
#include <iostream>

#include "clients/cpp/glint_client.hpp"

namespace {

using glint_client::Client;
using glint_client::ConnectionLost;
using glint_client::Json;
using glint_client::Map;
using glint_client::RequestError;

Json describe(const Map& map) {
  std::size_t points = 0;
  double sum_m = 0.0;
  for (const auto& [index, tile] : map.tiles) {
    points += tile.size();
    for (const auto& p : tile)
      sum_m += static_cast<double>(p.x_m) + 2.0 * static_cast<double>(p.z_m);
  }
  return {{"points", points}, {"sum_m", sum_m}, {"revision", map.revision}};
}

Json error_of(Client& client, const std::string& method, const Json& params) {
  try {
    client.call(method, params);
  } catch (const RequestError& error) {
    return {{"number", error.number()}, {"code", error.code()}, {"field", error.field()}};
  }
  return nullptr;
}

void ask(const std::string& target) {
  Client client(target);
  Json out;
  out["instance"] = client.hello()["instance"];
  const auto pose = client.get_pose({{"frame", "odom"}});
  out["pose"] = {{"state", pose.state}, {"t_ns", pose.t_ns}, {"p_m", pose.p_m}, {"q", pose.q_xyzw}};
  Map map = client.get_map();
  out["map"] = describe(map);
  client.update(map);
  out["updated"] = describe(map);
  out["coarse"] = describe(client.get_map({{"voxel_m", 2.0}}));
  out["bad_frame"] = error_of(client, "get_pose", {{"frame", "moon"}});
  out["no_map"] = error_of(client, "load_map", {{"name", "none"}});
  std::cout << out << std::endl;
}

/// A line a pose, and one when the map was taken over after a reconnection.
void follow(const std::string& target) {
  Client client(target);
  Map map = client.get_map();
  auto poses = client.subscribe({"pose"}, {{"frame", "odom"}});
  std::uint64_t reconnects = 0;
  while (auto pose = poses.next()) {
    std::cout << pose->params["t"] << std::endl;
    if (poses.reconnects() == reconnects) continue;
    reconnects = poses.reconnects();
    try {
      client.get_status();
    } catch (const ConnectionLost&) {
      client.get_status();
    }
    client.update(map);
    std::cout << "reconnected " << (map.instance == client.hello()["instance"]) << std::endl;
  }
}

}  // namespace

int main(int argc, char** argv) {
  try {
    if (argc != 3) return 2;
    std::string(argv[2]) == "ask" ? ask(argv[1]) : follow(argv[1]);
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
  }
  return 0;
}
