// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
//
// glint map: fetches the daemon's map, page by page.
#include <fmt/format.h>

#include <cstring>
#include <filesystem>
#include <iostream>
#include <map>
#include <memory>

#include "daemon/base64.hpp"
#include "daemon/cli/client_command.hpp"
#include "daemon/cli/command.hpp"
#include "daemon/export/ply_writer.hpp"

namespace glint::cli {
namespace {

using daemon::Json;
using slam::MapPoint;

struct MapCommand {
  ClientOptions client;
  std::filesystem::path out;
  double voxel_m = 0.0;
};

using Tiles = std::map<slam::TileIndex, std::vector<MapPoint>>;

/// Adds a page's points: a tile that is not continued replaces what was known of it.
void take_page(const Json& page, Tiles& tiles) {
  for (const Json& tile : page.at("tiles")) {
    const auto bytes = daemon::base64_decode(tile.at("points").get_ref<const std::string&>());
    if (!bytes || bytes->size() % sizeof(MapPoint) != 0) {
      throw daemon::ClientError("the daemon sent map points that are no points");
    }
    std::vector<MapPoint>& points = tiles[tile.at("index").get<slam::TileIndex>()];
    if (!tile.at("continued").get<bool>()) points.clear();
    const std::size_t known = points.size();
    points.resize(known + bytes->size() / sizeof(MapPoint));
    if (!bytes->empty()) std::memcpy(points.data() + known, bytes->data(), bytes->size());
  }
}

void run(const MapCommand& command) {
  with_client(command.client, [&](daemon::Client& client) {
    Json params = Json::object();
    if (command.voxel_m > 0.0) params["voxel_m"] = command.voxel_m;
    Tiles tiles;
    Json page;
    std::size_t pages = 0;
    do {
      page = client.call("get_map", params);
      take_page(page, tiles);
      if (page.contains("next_cursor")) params["cursor"] = page["next_cursor"];
      ++pages;
    } while (page.contains("next_cursor"));

    std::vector<MapPoint> points;
    for (const auto& [index, tile] : tiles) points.insert(points.end(), tile.begin(), tile.end());
    write_ply(command.out, points);
    if (command.client.json) {
      std::cout << Json{{"file", command.out.string()},   {"points", points.size()},
                        {"tiles", tiles.size()},          {"revision", page["revision"]},
                        {"map_epoch", page["map_epoch"]}, {"pages", pages}}
                       .dump()
                << '\n';
    } else {
      fmt::print("{}: {} points in {} tiles, map frame\n", command.out.string(), points.size(),
                 tiles.size());
    }
  });
}

}  // namespace

void add_map(CLI::App& app) {
  auto command = std::make_shared<MapCommand>();
  CLI::App* sub = app.add_subcommand("map", "Fetch the daemon's map as a PLY file");
  add_client_options(*sub, command->client);
  sub->add_option("--out", command->out, "PLY file to write")->required();
  sub->add_option("--voxel-m", command->voxel_m, "Keep one point in each voxel of this size")
      ->check(CLI::Range(0.01, 100.0));
  sub->callback([command] { run(*command); });
}

}  // namespace glint::cli
