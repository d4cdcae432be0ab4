// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
//
// `glint doctor` with an emulated sensor, and without any.
#include <gmock/gmock.h>

#include <fstream>

#include "tests/integration/glint_command.hpp"
#include "tests/integration/small_world.hpp"

namespace glint {
namespace {

using ::testing::HasSubstr;
using Json = nlohmann::json;

class DoctorTest : public ::testing::Test {
 protected:
  DoctorTest() {
    std::ofstream(config_) << "[sensor]\nlidar_port = " << port_ << "\nimu_port = " << port_
                           << "\n";
  }

  /// What it found, by JSON; the level of each step.
  std::map<std::string, std::string> examine(const std::string& sensor) {
    // The JSON is on standard output, the sentence of a failure after it.
    const auto result = test::run_glint(
        {"doctor", "--sensor", sensor, "--config", config_, "--seconds", "1.5", "--json"});
    exit_code_ = result.exit_code;
    const Json json = Json::parse(result.out.substr(0, result.out.rfind('}') + 1));
    std::map<std::string, std::string> levels;
    for (const Json& finding : json["findings"]) {
      levels[finding["step"]] = finding["level"];
      EXPECT_EQ(finding.contains("mend"), finding["level"] != "OK") << finding;
    }
    failure_ = json.value("first_failure", "");
    return levels;
  }

  const test::SmallWorld world_{LidarProfile::kRng19Rfl8Sig16Nir16};
  const std::uint16_t port_ = test::free_udp_ports();
  const std::filesystem::path config_ = world_.dir / "glint.toml";
  int exit_code_ = -1;
  std::string failure_;
};

TEST_F(DoctorTest, AGoodSensorPasses) {
  test::GlintProcess sensor({"emulate", world_.capture, "--http", "0", "--to",
                             "127.0.0.1:" + std::to_string(port_), "--imu-port",
                             std::to_string(port_)});
  const auto levels = examine("127.0.0.1:" + std::to_string(sensor.number_after("HTTP on port ")));
  EXPECT_EQ(exit_code_, 0) << failure_;
  for (const char* step : {"route", "interface", "status", "destination", "metadata", "alerts",
                           "clock", "ports", "packets", "MTU", "gravity"}) {
    EXPECT_EQ(levels.count(step), 1U) << step;
    if (levels.count(step) == 1) {
      EXPECT_EQ(levels.at(step), "OK") << step;
    }
  }
}

TEST_F(DoctorTest, ASensorThatSendsElsewhereFailsAtItsDestination) {
  test::GlintProcess sensor({"emulate", world_.capture, "--http", "0", "--to", "192.0.2.9:7502"});
  const auto levels = examine("127.0.0.1:" + std::to_string(sensor.number_after("HTTP on port ")));
  EXPECT_EQ(exit_code_, 1);
  EXPECT_EQ(levels.at("destination"), "FAIL");
  EXPECT_THAT(failure_, HasSubstr("destination: the sensor sends to 192.0.2.9"));
}

TEST_F(DoctorTest, NoSensorIsTheFirstFailure) {
  examine("127.0.0.1:9");
  EXPECT_EQ(exit_code_, 1);
  EXPECT_THAT(failure_, HasSubstr("interface: 127.0.0.1 refuses connections on port 9"));
}

TEST_F(DoctorTest, TheHostAloneIsExaminedInLines) {
  const auto result = test::run_glint({"doctor", "--config", config_, "--seconds", "0.2"});
  EXPECT_EQ(result.exit_code, 0) << result.out;
  EXPECT_THAT(result.out, HasSubstr("receive buffer"));
  EXPECT_THAT(result.out, HasSubstr("OK   ports"));
  EXPECT_THAT(result.out, HasSubstr("Nothing fails."));
}

}  // namespace
}  // namespace glint
