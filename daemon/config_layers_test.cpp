// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "daemon/config_layers.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

namespace glint::daemon {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

/// A configuration file and its drop-ins in a directory of the test's own.
class ConfigLayersTest : public testing::Test {
 protected:
  void SetUp() override { fs::create_directories(drop_ins_); }
  void TearDown() override { fs::remove_all(directory_); }

  static void write(const fs::path& file, const std::string& text) { std::ofstream(file) << text; }

  std::string error() {
    try {
      read_config_layers(file_, {});
    } catch (const ConfigError& error) {
      return error.what();
    }
    return "";
  }

  const fs::path directory_ =
      fs::path(testing::TempDir()) / ("config_layers_test_" + std::to_string(getpid()));
  const fs::path file_ = directory_ / "glint.toml";
  const fs::path drop_ins_ = directory_ / "glint.toml.d";
};

TEST_F(ConfigLayersTest, LaterLayersWinAndEachValueKnowsItsOwn) {
  write(file_, "[server]\nmax_clients = 1\nidle_timeout_s = 10\n[map]\nsearch_s = 11\n");
  write(drop_ins_ / "20-b.toml", "[server]\nmax_clients = 3\n");
  write(drop_ins_ / "10-a.toml", "[server]\nmax_clients = 2\nidle_timeout_s = 20\n");
  write(drop_ins_ / "30-c.toml.bak", "no TOML");
  const std::vector<std::string> settings = {"map.search_s=12"};
  const LayeredConfig layered = read_config_layers(file_, settings);
  EXPECT_EQ(layered.config.server.max_clients, 3);
  EXPECT_EQ(layered.config.server.idle_timeout_s, 20.0);
  EXPECT_EQ(layered.config.map.search_s, 12.0);
  EXPECT_THAT(layered.files, ElementsAre(file_, drop_ins_ / "10-a.toml", drop_ins_ / "20-b.toml"));
  EXPECT_EQ(layered.origins.at("server.max_clients"), (drop_ins_ / "20-b.toml").string() + ":2");
  EXPECT_EQ(layered.origins.at("server.idle_timeout_s"), (drop_ins_ / "10-a.toml").string() + ":3");
  EXPECT_EQ(layered.origins.at("map.search_s"), "--set");
  EXPECT_FALSE(layered.origins.contains("log.level"));
}

TEST_F(ConfigLayersTest, APresetReplacesWhatEarlierLayersSaid) {
  write(file_, "[slam]\norb_features = 777\n");
  write(drop_ins_ / "a.toml", "[slam]\nmatch_max = 99\npreset = \"paper\"\n");
  const LayeredConfig layered = read_config_layers(file_, {});
  EXPECT_EQ(layered.config.slam.orb_features, slam::preset_config("paper").orb_features);
  EXPECT_EQ(layered.config.slam.match_max, 99);
  EXPECT_EQ(layered.origins.at("slam.orb_features"), "preset paper");
  EXPECT_EQ(layered.origins.at("slam.preset"), (drop_ins_ / "a.toml").string() + ":3");
  EXPECT_EQ(layered.origins.at("slam.match_max"), (drop_ins_ / "a.toml").string() + ":2");
}

TEST_F(ConfigLayersTest, ErrorsOfDropInsNameFileAndLine) {
  write(file_, "");
  write(drop_ins_ / "a.toml", "[server]\nmax_client = 3\n");
  EXPECT_THAT(error(), AllOf(HasSubstr("glint.toml.d/a.toml:2"), HasSubstr("'server.max_client'"),
                             HasSubstr("'server.max_clients'")));
  write(drop_ins_ / "a.toml", "[server]\n\nmax_clients = 0\n");
  EXPECT_THAT(error(), AllOf(HasSubstr("glint.toml.d/a.toml:3"), HasSubstr("from 1 to 1000")));
}

TEST_F(ConfigLayersTest, WithoutDropInsTheFileStandsAlone) {
  fs::remove(drop_ins_);
  write(file_, "[log]\nlevel = \"warn\"\n");
  EXPECT_EQ(read_config_layers(file_, {}).config.log.level, "warn");
  write(drop_ins_, "");
  EXPECT_THAT(error(), AllOf(HasSubstr("glint.toml.d"), HasSubstr("must be a directory")));
  fs::remove(file_);
  fs::remove(drop_ins_);
  EXPECT_THAT(error(), HasSubstr("glint.toml"));
}

}  // namespace
}  // namespace glint::daemon
