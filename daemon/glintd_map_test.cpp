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

TEST_F(GlintdMapTest, InAMapThatIsOnlyReadItFindsItselfFollowsItAndWritesNothing) {
  std::vector<std::string> arguments = walk("room");
  {
    Process process(arguments, directory_);
    ASSERT_FALSE(poll_status([](const Json& s) { return s["map"]["keyframes"] > 20; }).is_null());
    Client(socket()).call("save_map", {{"name", "room"}});
    const auto saved = [](const Json& s) { return s["jobs"][0]["state"] == "done"; };
    ASSERT_FALSE(poll_status(saved).is_null()) << process.log();
    process.signal(SIGTERM);
    process.wait();
  }
  const fs::path state = directory_ / "state";
  const auto files = std::distance(fs::recursive_directory_iterator(state), {});
  const std::string bytes = read_file(state / "maps" / "room.glint");
  arguments.insert(arguments.end(), {"--set", "map.on_start=localize:room"});
  Process process(arguments, directory_);
  const Json found = poll_status([](const Json& s) { return s["state"] == "TRACKING"; });
  ASSERT_FALSE(found.is_null()) << process.log();
  EXPECT_EQ(found["map"]["only_read"], true);
  EXPECT_EQ(found["session_file"], "");
  const int known = found["map"]["keyframes"];
  std::this_thread::sleep_for(std::chrono::seconds(1));
  Client client(socket());
  // The same walk: it begins where the map's frame does, and what odometry errs by is millimetres.
  const Json pose = client.call("get_pose");
  ASSERT_TRUE(pose.contains("T_map_odom")) << pose;
  for (const Json& x_m : pose["T_map_odom"]["p_m"]) EXPECT_LT(std::abs(x_m.get<double>()), 0.1);
  EXPECT_GT(pose["confidence"], 0.9);
  const auto epoch = client.call("get_status")["map_epoch"].get<int>();
  // It is found again.
  client.call("set_initial_pose", {{"p_m", pose["p_m"]}, {"q_xyzw", pose["q_xyzw"]}});
  const Json again = poll_status([&](const Json& s) {
    return s["state"] == "TRACKING" && s["map_epoch"].get<int>() >= epoch + 2;
  });
  ASSERT_FALSE(again.is_null()) << process.log();
  EXPECT_EQ(again["map"]["keyframes"], known);
  process.signal(SIGTERM);
  EXPECT_EQ(process.wait(), 0);
  EXPECT_EQ(read_file(state / "maps" / "room.glint"), bytes);
  EXPECT_EQ(std::distance(fs::recursive_directory_iterator(state), {}), files);
}

TEST_F(GlintdMapTest, WhereTheMapIsOnlyReadAndAnotherPlacesItSaysSoAndGoesOnSearching) {
  std::vector<std::string> arguments = walk("room");
  {
    Process process(arguments, directory_);
    ASSERT_FALSE(poll_status([](const Json& s) { return s["map"]["keyframes"] > 5; }).is_null());
    Client(socket()).call("save_map", {{"name", "room"}});
    const auto saved = [](const Json& s) { return s["jobs"][0]["state"] == "done"; };
    ASSERT_FALSE(poll_status(saved).is_null()) << process.log();
    process.signal(SIGTERM);
    process.wait();
  }
  arguments = walk("corridor");
  arguments.insert(arguments.end(), {"--set", "map.on_start=localize:room"});
  Process process(arguments, directory_);
  ASSERT_FALSE(poll_status([](const Json& s) { return s["state"] == "LOCALIZING"; }).is_null());
  Client watching(socket());
  watching.call("subscribe", {{"topics", {"events"}}});
  Json event = Json::object();
  while (event.value("kind", "") != "map") {
    event = watching.next_message(std::chrono::seconds(10))["params"];
  }
  EXPECT_EQ(event["action"], "not_found");
  const Json status = Client(socket()).call("get_status");
  EXPECT_EQ(status["state"], "LOCALIZING");
  EXPECT_EQ(status["session_file"], "");
  EXPECT_TRUE(Client(socket()).call("get_pose", {{"frame", "odom"}}).contains("p_m"));
}

TEST_F(GlintdMapTest, AMapThatIsNotThereIsABadConfiguration) {
  std::vector<std::string> arguments = walk("room");
  arguments.insert(arguments.end(), {"--set", "map.on_start=localize:attic"});
  EXPECT_EQ(exit_code(arguments), 78);
  EXPECT_THAT(log_, HasSubstr("there is no map 'attic'"));
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
