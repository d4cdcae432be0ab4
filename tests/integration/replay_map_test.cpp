// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
//
// `glint replay --map`: a capture in the map of another one.
#include <gmock/gmock.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "pcap/test_capture.hpp"
#include "tests/integration/glint_command.hpp"

namespace glint {
namespace {

namespace fs = std::filesystem;
using test::run_glint;
using ::testing::HasSubstr;

class ReplayMap : public ::testing::Test {
 protected:
  ReplayMap() {
    simulate("room", "1");
    EXPECT_EQ(replay("room1", "first", {}).exit_code, 0);
  }

  void simulate(const std::string& world, const std::string& seed) const {
    const auto result =
        run_glint({"simulate", "--world", world, "--seed", seed, "--seconds", "12", "--columns",
                   "512", "--beams", "32", "--out", dir_ / (world + seed)});
    EXPECT_EQ(result.exit_code, 0) << result.out;
  }
  [[nodiscard]] test::CommandResult replay(const std::string& capture, const std::string& out,
                                           const std::vector<std::string>& more) const {
    std::vector<std::string> arguments = {"replay", dir_ / capture / "capture.pcap", "--out",
                                          dir_ / out};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_glint(arguments);
  }
  [[nodiscard]] nlohmann::json summary(const std::string& out) const {
    std::ifstream in(dir_ / out / "summary.json");
    return nlohmann::json::parse(in);
  }
  [[nodiscard]] std::vector<std::string> lines(const std::string& out) const {
    std::ifstream in(dir_ / out / "trajectory.tum");
    std::vector<std::string> all;
    for (std::string line; std::getline(in, line);) all.push_back(line);
    return all;
  }

  const test::TempDir dir_;
};

TEST_F(ReplayMap, TheTrajectoryIsInTheFrameOfThatMap) {
  const auto reference = lines("first");
  ASSERT_GT(reference.size(), 100U);
  const auto result =
      replay("room1", "second", {"--map", (dir_ / "first" / "session.glint").string()});
  ASSERT_EQ(result.exit_code, 0) << result.out;
  EXPECT_EQ(summary("second")["placed_in_map"], true);
  EXPECT_GT(summary("second")["keyframes"], summary("first")["keyframes"]);
  const auto found = lines("second");
  ASSERT_EQ(found.size(), reference.size());
  for (std::size_t i = 0; i < found.size(); i += 10) {
    std::istringstream a(reference[i]);
    std::istringstream b(found[i]);
    double t = 0.0;
    double square_m2 = 0.0;
    double x = 0.0;
    double y = 0.0;
    a >> t;
    b >> t;
    for (int axis = 0; axis < 3; ++axis) {
      a >> x;
      b >> y;
      square_m2 += (x - y) * (x - y);
    }
    EXPECT_LT(std::sqrt(square_m2), 0.1) << reference[i] << '\n' << found[i];
  }
}

TEST_F(ReplayMap, ACaptureFromElsewhereIsSaidNotToBeInIt) {
  simulate("corridor", "1");
  const auto result =
      replay("corridor1", "other", {"--map", (dir_ / "first" / "session.glint").string()});
  EXPECT_EQ(result.exit_code, 0) << result.out;
  EXPECT_THAT(result.out, HasSubstr("was not found in the map"));
  EXPECT_EQ(summary("other")["placed_in_map"], false);
  EXPECT_TRUE(lines("other").empty());
  EXPECT_GT(fs::file_size(dir_ / "other" / "odometry.tum"), 1000U);
}

TEST_F(ReplayMap, AMapThatIsNoneIsRefused) {
  const auto result =
      replay("room1", "none", {"--map", (dir_ / "room1" / "capture.pcap").string()});
  EXPECT_EQ(result.exit_code, 3) << result.out;
  EXPECT_THAT(result.out, HasSubstr("capture.pcap"));
}

}  // namespace
}  // namespace glint
