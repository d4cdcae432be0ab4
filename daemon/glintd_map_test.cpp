// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
//
// The process and the map of an earlier run.
#include <gmock/gmock.h>

#include "daemon/test_glintd.hpp"

namespace glint::daemon {
namespace {

namespace fs = std::filesystem;

using testing::HasSubstr;

class GlintdMapTest : public GlintdTest {
 protected:
  /// Arguments for a daemon that walks through a world, four times as fast as one would, and goes
  /// on with the latest map.
  [[nodiscard]] std::vector<std::string> walk(const std::string& world) const {
    return {"--source", "synth:" + world + ",seconds=30,columns=512,beams=32",
            "--rate",   "4",
            "--set",    "server.listen=",
            "--set",    "server.unix_socket=" + socket(),
            "--set",    "state.directory=" + (directory_ / "state").string(),
            "--set",    "map.on_start=continue",
            "--set",    "map.search_s=6"};
  }
};

TEST_F(GlintdMapTest, AfterAKillItFindsItselfInItsMapAndGoesOnInTheSameFrame) {
  constexpr int kMapped = 12;
  std::string session;
  {
    Process process(walk("room"), directory_);
    const Json status = poll_status([](const Json& s) { return s["map"]["keyframes"] > kMapped; });
    ASSERT_FALSE(status.is_null()) << process.log();
    session = status["session_file"];
    std::this_thread::sleep_for(std::chrono::seconds(1));
    process.signal(SIGKILL);
    process.wait();
  }
  Process process(walk("room"), directory_);
  const Json waking = poll_status([](const Json& s) { return s["state"] == "LOCALIZING"; });
  ASSERT_FALSE(waking.is_null()) << process.log();
  EXPECT_EQ(waking["session_file"], "");
  EXPECT_TRUE(waking.contains("localization"));
  const int known = waking["map"]["keyframes"];
  EXPECT_GE(known, kMapped);
  const Json found = poll_status(
      [&](const Json& s) { return s["state"] == "TRACKING" && s["map"]["keyframes"] > known; });
  ASSERT_FALSE(found.is_null()) << process.log();
  EXPECT_EQ(found["session_file"], session);
  // The same walk: it began where the map's frame does.
  Client client(socket());
  const Json path = client.call("get_trajectory")["poses"];
  ASSERT_FALSE(path.empty());
  for (const Json& x_m : path[0]["p_m"]) EXPECT_LT(std::abs(x_m.get<double>()), 0.1);
  process.signal(SIGTERM);
  EXPECT_EQ(process.wait(), 0);
  EXPECT_THAT(process.log(), HasSubstr("going on with the map of " + session));
}

TEST_F(GlintdMapTest, AMapThatWasSavedIsLoadedAndTheSensorFoundInIt) {
  Process process(walk("room"), directory_);
  ASSERT_FALSE(poll_status([](const Json& s) { return s["map"]["keyframes"] > 15; }).is_null());
  Client client(socket());
  const auto idle = [](const Json& s) { return s["jobs"][0]["state"] == "done"; };
  client.call("save_map", {{"name", "room"}});
  ASSERT_FALSE(poll_status(idle).is_null()) << process.log();
  client.call("load_map", {{"name", "room"}});
  const Json found = poll_status([&](const Json& s) {
    return idle(s) && s["jobs"][0]["kind"] == "load_map" && s["state"] == "TRACKING" &&
           s["session_file"] != "";
  });
  ASSERT_FALSE(found.is_null()) << process.log();
  EXPECT_EQ(fs::path(found["session_file"].get<std::string>()).parent_path().filename(), "state");
}

TEST_F(GlintdMapTest, WhereItsMapIsNotItBeginsAnother) {
  std::string session;
  {
    Process process(walk("room"), directory_);
    const Json status = poll_status([](const Json& s) { return s["map"]["keyframes"] > 5; });
    ASSERT_FALSE(status.is_null()) << process.log();
    session = status["session_file"];
    process.signal(SIGTERM);
    process.wait();
  }
  const auto bytes = fs::file_size(session);
  Process process(walk("corridor"), directory_);
  ASSERT_FALSE(poll_status([](const Json& s) { return s["state"] == "LOCALIZING"; }).is_null());
  Client watching(socket());
  watching.call("subscribe", {{"topics", {"events"}}});
  Json event = Json::object();
  while (event.value("kind", "") != "map") {
    event = watching.next_message(std::chrono::seconds(10))["params"];
  }
  EXPECT_EQ(event["action"], "begun");
  const Json status = poll_status([](const Json& s) { return s["state"] == "TRACKING"; });
  ASSERT_FALSE(status.is_null()) << process.log();
  EXPECT_NE(status["session_file"], session);
  EXPECT_TRUE(fs::exists(status["session_file"].get<std::string>()));
  EXPECT_EQ(fs::file_size(session), bytes);
  process.signal(SIGTERM);
  EXPECT_EQ(process.wait(), 0);
  EXPECT_THAT(process.log(), HasSubstr("a map of its own is begun"));
}

}  // namespace
}  // namespace glint::daemon
