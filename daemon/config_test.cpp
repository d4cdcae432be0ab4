// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "daemon/config.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <regex>

namespace glint::daemon {
namespace {

using testing::AllOf;
using testing::HasSubstr;

const std::filesystem::path kConfigDirectory = std::filesystem::path(GLINT_SOURCE_DIR) / "config";

std::string read_file(const std::filesystem::path& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

class ConfigTest : public testing::Test {
 protected:
  std::string load_error(const std::string& text) {
    // Tests of this fixture may run beside each other, each in a process.
    const auto directory = std::filesystem::path(testing::TempDir()) / std::to_string(getpid());
    std::filesystem::create_directory(directory);
    const auto file = directory / "config_test.toml";
    std::ofstream(file) << text;
    try {
      load_config(file, config_);
    } catch (const ConfigError& error) {
      return error.what();
    }
    return "";
  }
  void TearDown() override {
    std::filesystem::remove_all(std::filesystem::path(testing::TempDir()) /
                                std::to_string(getpid()));
  }
  std::string setting_error(const std::string& setting) {
    try {
      apply_setting(config_, setting);
    } catch (const ConfigError& error) {
      return error.what();
    }
    return "";
  }
  Config config_;
};

TEST_F(ConfigTest, ValuesOfEveryTypeAreRead) {
  EXPECT_EQ(load_error("[sensor]\nlidar_port = 7600\n[slam]\ndeskew = false\nmap_voxel_m = 1\n"
                       "[server]\nlisten = \"[::1]:7000\"\n"
                       "[mount]\nT_base_sensor = [1, 2, 3, 0, 0, 1, 0]\n"),
            "");
  EXPECT_EQ(config_.sensor.lidar_port, 7600);
  EXPECT_FALSE(config_.slam.deskew);
  EXPECT_EQ(config_.slam.map_voxel_m, 1.0);
  EXPECT_EQ(config_.server.listen, "[::1]:7000");
  EXPECT_EQ(config_.mount.T_base_sensor.translation_m, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(config_.mount.T_base_sensor.rotation.z(), 1.0);
}

TEST_F(ConfigTest, AWindowIsTwoNumbersOrNone) {
  EXPECT_EQ(load_error("[sensor]\nazimuth_window_mdeg = [300000, 60000]\n"), "");
  EXPECT_EQ(config_.sensor.azimuth_window_mdeg, (std::vector<int>{300'000, 60'000}));
  apply_setting(config_, "sensor.azimuth_window_mdeg=[]");
  EXPECT_TRUE(config_.sensor.azimuth_window_mdeg.empty());
  for (const char* bad : {"[0]", "[0, 1, 2]", "[0, 360001]", "[0, 0.5]", "360000"}) {
    EXPECT_THAT(setting_error(std::string("sensor.azimuth_window_mdeg=") + bad),
                AllOf(HasSubstr("two whole numbers [start, end] from 0 to 360000 thousandths")));
  }
}

TEST_F(ConfigTest, ANumberThatGlintCanFindItselfMayBeAuto) {
  EXPECT_EQ(to_json(config_)["slam"]["sensor_height_m"], "auto");
  EXPECT_EQ(load_error("[slam]\nsensor_height_m = 1.2\n"), "");
  EXPECT_EQ(config_.slam.sensor_height_m, 1.2);
  EXPECT_EQ(setting_error("slam.sensor_height_m=auto"), "");
  EXPECT_EQ(config_.slam.sensor_height_m, 0.0);
  EXPECT_THAT(setting_error("slam.sensor_height_m=low"),
              HasSubstr("\"auto\" or a number from 0.05 to 100 m"));
  EXPECT_THAT(setting_error("slam.max_speed_mps=auto"), HasSubstr("a number from 0.1"));
}

TEST_F(ConfigTest, AnUnknownKeyIsAnErrorWithLineAndNearestKey) {
  EXPECT_THAT(load_error("[slam]\n# comment\norb_feature = 3\n"),
              AllOf(HasSubstr("config_test.toml:3"), HasSubstr("'slam.orb_feature'"),
                    HasSubstr("'slam.orb_features'")));
}

TEST_F(ConfigTest, AWrongTypeIsAnErrorWithLineAndAllowedRange) {
  EXPECT_THAT(load_error("[sensor]\nlidar_port = \"7502\"\n"),
              AllOf(HasSubstr("config_test.toml:2"), HasSubstr("a whole number from 0 to 65535")));
  EXPECT_THAT(load_error("[slam]\norb_features = 1.5\n"), HasSubstr("whole number"));
  EXPECT_THAT(load_error("[slam]\ndeskew = 1\n"), HasSubstr("true or false"));
}

TEST_F(ConfigTest, AValueOutOfRangeIsAnErrorWithTheRange) {
  EXPECT_THAT(load_error("[slam]\nmin_completeness = 1.5\n"), HasSubstr("from 0 to 1"));
  EXPECT_THAT(load_error("[slam]\nmap_voxel_m = nan\n"), HasSubstr("from 0 to 10 m"));
  EXPECT_THAT(load_error("[sensor]\nlidar_port = 70000\n"), HasSubstr("65535"));
  EXPECT_THAT(load_error("[log]\nlevel = \"loud\"\n"), HasSubstr("debug|info|warn|error"));
}

TEST_F(ConfigTest, EveryNumberIsHeldAgainstItsRange) {
  int numbers = 0;
  for (const ConfigKey& key : config_keys()) {
    const bool whole = std::holds_alternative<int& (*)(Config&)>(key.field);
    if (!whole && !std::holds_alternative<double& (*)(Config&)>(key.field)) continue;
    ++numbers;
    ASSERT_LT(key.min, key.max) << key.name;
    const auto dot = key.name.find('.');
    const auto with = [&](double value) {
      const std::string text = whole ? fmt::format("{}", static_cast<std::int64_t>(value))
                                     : fmt::format("{:.9f}", value);
      return load_error(
          fmt::format("[{}]\n{} = {}\n", key.name.substr(0, dot), key.name.substr(dot + 1), text));
    };
    EXPECT_EQ(with(key.max), "") << key.name;
    for (const double outside : {key.min - 1.0, key.max + 1.0}) {
      EXPECT_THAT(with(outside), AllOf(HasSubstr("config_test.toml:2: "), HasSubstr(key.name)));
    }
  }
  EXPECT_GT(numbers, 40);
}

TEST_F(ConfigTest, ValuesThatNothingCouldMakeRightAreErrorsWithLine) {
  struct Case {
    const char* key;
    std::vector<const char*> good;
    std::vector<const char*> bad;
  };
  const std::string too_long(108, 'x');
  const std::vector<Case> cases = {
      {"sensor.udp_dest", {"auto", "10.0.0.1", ""}, {"localhost", "10.0.0"}},
      {"sensor.source_address", {"any", "fe80::1%eth0", ""}, {"auto", "eth0"}},
      {"sensor.bind_address", {"0.0.0.0", "::1", ""}, {"any", "10.0.0.256"}},
      {"sensor.multicast_group", {"239.201.3.4", "ff02::7%eth0"}, {"192.0.2.1", "fe80::1"}},
      {"sensor.lidar_mode", {"1024x10", "4096x5", ""}, {"1024", "1024x", "1024 x 10"}},
      {"sensor.timestamp_mode", {"TIME_FROM_PTP_1588", ""}, {"PTP"}},
      {"sensor.operating_mode", {"STANDBY", ""}, {"FAST"}},
      {"server.listen",
       {"127.0.0.1:0", "[::1]:7788", "glint:1", ""},
       {"7788", "::1:7788", "a:99999"}},
      {"server.unix_socket", {"auto", "/run/glintd.sock", ""}, {too_long.c_str()}},
  };
  for (const auto& [key, good, bad] : cases) {
    const std::string name(key);
    const auto load = [&](const char* value) {
      return load_error(
          fmt::format("[{}]\n{} = \"{}\"\n", name.substr(0, 6), name.substr(7), value));
    };
    for (const char* value : good) EXPECT_EQ(load(value), "") << key;
    for (const char* value : bad) {
      EXPECT_THAT(load(value), AllOf(HasSubstr("config_test.toml:2: '" + name), HasSubstr(value)));
    }
  }
  EXPECT_EQ(setting_error("sensor.signal_multiplier=0.25"), "");
  EXPECT_THAT(setting_error("sensor.signal_multiplier=1.7"), HasSubstr("0, 0.25, 0.5, 1, 2 or 3"));
}

TEST_F(ConfigTest, AMountThatIsNoPoseIsAnError) {
  EXPECT_THAT(load_error("[mount]\nT_base_sensor = [0, 0, 0, 0, 0, 1.57, 0]\n"),
              HasSubstr("qx, qy, qz, qw"));
  EXPECT_THAT(load_error("[mount]\nT_base_sensor = [0, 0, 0]\n"), HasSubstr("seven numbers"));
}

TEST_F(ConfigTest, ASyntaxErrorNamesItsLine) {
  EXPECT_THAT(load_error("[slam]\n\npreset = paper\n"), HasSubstr("config_test.toml:3"));
}

TEST_F(ConfigTest, AMissingFileIsAnErrorThatNamesIt) {
  try {
    load_config("/nonexistent/glint.toml", config_);
    FAIL();
  } catch (const ConfigError& error) {
    EXPECT_THAT(error.what(), HasSubstr("/nonexistent/glint.toml"));
  }
}

TEST_F(ConfigTest, AStartBeginsWithAnEmptyMapOrTheLatestOne) {
  EXPECT_EQ(load_error("[map]\non_start = \"continue\"\n"), "");
  EXPECT_EQ(config_.map.on_start, "continue");
  EXPECT_THAT(load_error("[map]\non_start = \"resume\"\n"), HasSubstr("new|continue"));
  EXPECT_EQ(load_error("[map]\non_start = \"localize:office-2\"\n"), "");
  EXPECT_EQ(config_.map.on_start, "localize:office-2");
  for (const char* bad : {"localize", "localize:", "localize:../x", "localize:a/b",
                          "localize:NAME|", "new:x", "", "localize:a:b"}) {
    EXPECT_NE(load_error(fmt::format("[map]\non_start = \"{}\"\n", bad)), "") << bad;
  }
}

TEST_F(ConfigTest, ThePresetIsAppliedBeforeOtherKeysWhereverItStands) {
  EXPECT_EQ(load_error("[slam]\norb_features = 777\npreset = \"paper\"\n"), "");
  EXPECT_EQ(config_.slam.orb_features, 777);
  EXPECT_FALSE(config_.slam.deskew);
  const std::vector<std::string> settings = {"slam.deskew=true", "slam.preset=paper"};
  apply_settings(config_, settings);
  EXPECT_TRUE(config_.slam.deskew);
}

TEST_F(ConfigTest, SettingsTakeTomlValuesAndBareStrings) {
  apply_setting(config_, "slam.preset=paper");
  apply_setting(config_, "state.directory=/var/tmp/glint");
  apply_setting(config_, "server.unix_socket=\"\"");
  apply_setting(config_, "server.listen=127.0.0.1:7000");
  apply_setting(config_, "slam.map_voxel_m=0.25");
  EXPECT_EQ(config_.slam.preset, "paper");
  EXPECT_EQ(config_.state.directory, "/var/tmp/glint");
  EXPECT_EQ(config_.server.unix_socket, "");
  EXPECT_EQ(config_.server.listen, "127.0.0.1:7000");
  EXPECT_EQ(config_.slam.map_voxel_m, 0.25);
}

TEST_F(ConfigTest, BadSettingsNameTheSetting) {
  EXPECT_THAT(setting_error("slam.deskew"), HasSubstr("KEY=VALUE"));
  EXPECT_THAT(setting_error("slam.deskew=maybe"), HasSubstr("--set slam.deskew=maybe"));
  EXPECT_THAT(setting_error("slam.preset=fast"), HasSubstr("paper|full"));
}

TEST_F(ConfigTest, PrintedAndReadAgainAConfigurationIsTheSame) {
  apply_setting(config_, "mount.T_base_sensor=[0.1, 0.2, 0.3, 0, 0.6, 0, 0.8]");
  apply_setting(config_, "slam.min_range_m=0.123456789012345678");
  apply_setting(config_, "sensor.azimuth_window_mdeg=[1000, 2000]");
  const Json before = to_json(config_);
  const std::string text = to_toml(config_);
  config_ = {};
  EXPECT_EQ(load_error(text), "");
  EXPECT_EQ(to_json(config_), before);
}

TEST_F(ConfigTest, DefaultsLieInTheirRanges) { EXPECT_EQ(load_error(to_toml(Config{})), ""); }

TEST_F(ConfigTest, TheShippedFileIsTheTableOfKeys) {
  const auto file = kConfigDirectory / "glint.toml";
  EXPECT_THAT(read_file(file), testing::EndsWith(to_toml(Config{})))
      << "run config/regenerate.sh build/glintd";
  load_config(file, config_);
  EXPECT_EQ(to_json(config_), to_json(Config{}));
}

TEST_F(ConfigTest, TheShippedPresetsAreThePresets) {
  for (const char* preset : {"paper", "full"}) {
    const auto file = kConfigDirectory / (std::string(preset) + ".toml");
    Config expected;
    expected.slam = slam::preset_config(preset);
    EXPECT_THAT(read_file(file), testing::EndsWith(to_toml(expected, "slam")))
        << "run config/regenerate.sh build/glintd";
    Config loaded;
    loaded.slam.orb_features = 51;
    load_config(file, loaded);
    EXPECT_EQ(to_json(loaded), to_json(expected));
  }
}

TEST_F(ConfigTest, EveryMemberOfSlamConfigHasAKey) {
  std::ifstream header(std::filesystem::path(GLINT_SOURCE_DIR) / "slam" / "config.hpp");
  const std::regex member(R"(^  [\w:]+ (\w+) = .*;.*$)");
  std::size_t members = 0;
  for (std::string line; std::getline(header, line);) {
    std::smatch match;
    if (!std::regex_match(line, match, member)) continue;
    ++members;
    // One of them belongs to the map by its key.
    const std::string key =
        match[1] == "map_memory_mb" ? "map.memory_mb" : "slam." + match[1].str();
    EXPECT_TRUE(std::ranges::any_of(config_keys(), [&](const auto& k) { return k.name == key; }))
        << key << " is missing in the table of daemon/config.cpp";
  }
  EXPECT_GT(members, 20U) << "the header is written in another way; this test must follow";
}

}  // namespace
}  // namespace glint::daemon
