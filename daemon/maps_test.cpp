// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
//
// Maps that clients save, list and delete, and jobs, over real TCP.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <filesystem>
#include <fstream>
#include <span>
#include <thread>

#include "daemon/map_saving.hpp"
#include "daemon/test_daemon.hpp"
#include "driver/core/crc64.hpp"
#include "slam/store/session_reader.hpp"
#include "slam/store/session_store.hpp"
#include "slam/store/test_session.hpp"

namespace glint::daemon {
namespace {

namespace fs = std::filesystem;
using test::has_poses;
using test::room_packets;
using test::TestDaemon;
using testing::HasSubstr;
using namespace std::chrono_literals;

class MapsTest : public slam::test::InDirectory {
 protected:
  MapsTest() {
    config_.state.directory = directory_.string();
    // A keyframe from each second scan.
    config_.slam.keyframe_distance_m = 0.01;
    options_.session.file = directory_ / "session-now.glint";
    daemon_.emplace(config_, options_);
  }

  Client client() const { return Client(daemon_->address()); }
  [[nodiscard]] fs::path map_file(const std::string& name) const {
    return directory_ / "maps" / (name + ".glint");
  }
  /// The first `scans` of the room are in the map; packets of earlier calls are not sent again.
  void map_scans(int scans) {
    const auto packets = room_packets(daemon_->info(), scans);
    daemon_->feed({packets.begin() + static_cast<std::ptrdiff_t>(fed_), packets.end()});
    fed_ = packets.size();
    ASSERT_TRUE(daemon_->wait_for("get_status", [&](const Json& s) {
      return has_poses(s, scans) && s["map"]["keyframes"].get<int>() >= scans / 2;
    }));
  }
  /// Begins a save and waits for its end.
  Json save(const std::string& name) {
    Client asking(daemon_->address());
    const Json reply = asking.call("save_map", {{"name", name}});
    EXPECT_EQ(reply["accepted"], true);
    return wait_for_end(reply["job"]["id"].get<int>());
  }
  Json wait_for_end(int id) {
    Json ended;
    EXPECT_TRUE(daemon_->wait_for("get_status", [&](const Json& status) {
      for (const Json& job : status["jobs"]) {
        if (job["id"] == id && job["state"] != "running") ended = job;
      }
      return !ended.is_null();
    }));
    return ended;
  }
  /// What a method is refused with.
  Json refusal(const std::string& method, const Json& params = Json::object()) {
    Client asking(daemon_->address());
    try {
      asking.call(method, params);
    } catch (const ReplyError& error) {
      return error.error();
    }
    return nullptr;
  }
  /// A job that runs until stop_ is set, or until it is given up.
  std::uint64_t run_job() {
    const auto begun = daemon_->runtime().start_job("walk", [this](RunningJob& job) {
      while (!stop_) {
        if (!job.progress(0.5)) return std::optional<Json>();
        std::this_thread::sleep_for(1ms);
      }
      return std::optional<Json>(Json{{"steps", 7}});
    });
    EXPECT_TRUE(begun);
    return begun ? begun->id : 0;
  }

  Config config_;
  RuntimeOptions options_;
  std::atomic<bool> stop_{false};  ///< For a job, which may outlive its test's function.
  std::optional<TestDaemon> daemon_;
  std::size_t fed_ = 0;
};

TEST_F(MapsTest, ALoadedMapIsThereAndTheSensorLooksForItsPlaceInIt) {
  map_scans(8);
  ASSERT_EQ(save("office")["state"], "done");
  const Json before = client().call("get_status");
  const Json reply = client().call("load_map", {{"name", "office"}, {"mode", "extend"}});
  EXPECT_EQ(reply["job"]["kind"], "load_map");
  const Json job = wait_for_end(reply["job"]["id"].get<int>());
  ASSERT_EQ(job["state"], "done") << job;
  EXPECT_EQ(job["result"]["keyframes"], before["map"]["keyframes"]);
  ASSERT_TRUE(
      daemon_->wait_for("get_status", [](const Json& s) { return s["state"] == "LOCALIZING"; }));
  const Json after = client().call("get_status");
  EXPECT_GT(after["map_epoch"], before["map_epoch"]);
  EXPECT_EQ(after["session_file"], "") << "nothing is written before it is found";
  EXPECT_EQ(refusal("save_map", {{"name", "other"}})["data"]["code"], "NOT_TRACKING");
  EXPECT_EQ(slam::SessionReader(map_file("office")).keyframe_count(),
            before["map"]["keyframes"].get<std::size_t>());
}

TEST_F(MapsTest, AMapThatIsOnlyReadHasNoSessionAndNothingToSave) {
  map_scans(8);
  ASSERT_EQ(save("office")["state"], "done");
  const std::string bytes = slam::test::read_bytes(map_file("office"));
  const Json reply = client().call("load_map", {{"name", "office"}, {"mode", "localize"}});
  ASSERT_EQ(wait_for_end(reply["job"]["id"].get<int>())["state"], "done");
  ASSERT_TRUE(daemon_->wait_for("get_status", [](const Json& s) {
    return s["state"] == "LOCALIZING" && s["map"]["only_read"] == true;
  }));
  EXPECT_EQ(client().call("get_status")["session_file"], "");
  EXPECT_EQ(refusal("save_map", {{"name", "other"}})["data"]["code"], "NOT_TRACKING");
  EXPECT_EQ(client().call("relocalize")["accepted"], true);
  EXPECT_EQ(client().call("set_initial_pose", {{"p_m", {0, 0, 0}}})["accepted"], true);
  daemon_.reset();
  EXPECT_EQ(slam::test::read_bytes(map_file("office")), bytes);
}

TEST_F(MapsTest, ASearchThatIsAskedForBeginsInTheMapThereIs) {
  EXPECT_EQ(refusal("relocalize")["data"]["code"], "NOT_TRACKING");
  map_scans(8);
  const Json before = client().call("get_status");
  EXPECT_EQ(refusal("set_initial_pose")["data"]["field"], "p_m");
  EXPECT_EQ(client().call("relocalize")["accepted"], true);
  ASSERT_TRUE(
      daemon_->wait_for("get_status", [](const Json& s) { return s["state"] == "LOCALIZING"; }));
  const Json after = client().call("get_status");
  EXPECT_EQ(after["map"]["keyframes"], before["map"]["keyframes"]);
  EXPECT_GT(after["map_epoch"], before["map_epoch"]);
}

TEST_F(MapsTest, AMapThatIsNotThereOrDamagedChangesNothing) {
  map_scans(4);
  EXPECT_EQ(refusal("load_map", {{"name", "office"}})["data"]["code"], "NO_SUCH_MAP");
  EXPECT_EQ(refusal("load_map", {{"name", "../x"}})["data"]["field"], "name");
  EXPECT_EQ(refusal("load_map", {{"name", "x"}, {"mode", "fly"}})["data"]["field"], "mode");
  fs::create_directories(map_file("office").parent_path());
  std::ofstream(map_file("office")) << "no map";
  const Json before = client().call("get_status");
  const Json reply = client().call("load_map", {{"name", "office"}});
  const Json job = wait_for_end(reply["job"]["id"].get<int>());
  EXPECT_EQ(job["state"], "failed");
  EXPECT_THAT(job["error"].get<std::string>(), HasSubstr("office.glint"));
  const Json after = client().call("get_status");
  EXPECT_EQ(after["map_epoch"], before["map_epoch"]);
  EXPECT_EQ(after["map"], before["map"]);
  EXPECT_EQ(after["session_file"], before["session_file"]);
}

TEST_F(MapsTest, AClearedMapIsEmptyAndItsSessionStays) {
  map_scans(6);
  const Json before = client().call("get_status");
  const int kept = before["map"]["keyframes"];
  Client watching(daemon_->address());
  watching.call("subscribe", {{"topics", {"events"}}});
  const Json reply = client().call("clear_map");
  ASSERT_EQ(wait_for_end(reply["job"]["id"].get<int>())["state"], "done");
  ASSERT_TRUE(daemon_->wait_for(
      "get_status", [&](const Json& s) { return s["map_epoch"] > before["map_epoch"]; }));
  const Json after = client().call("get_status");
  EXPECT_EQ(after["map"]["keyframes"], 0);
  // Degraded, where a busy machine is late with the next pose.
  EXPECT_THAT(after["state"], testing::AnyOf("TRACKING", "DEGRADED"));
  EXPECT_NE(after["session_file"], before["session_file"]);
  EXPECT_EQ(slam::SessionReader(before["session_file"].get<std::string>()).keyframe_count(), kept);
  EXPECT_EQ(client().call("get_map")["tiles"], Json::array());
  Json event = Json::object();
  while (event.value("kind", "") != "map") event = watching.next_message(5s)["params"];
  EXPECT_EQ(event["action"], "cleared");
  EXPECT_EQ(event["map_epoch"], after["map_epoch"]);
}

TEST_F(MapsTest, SavingAnswersAtOnceAndGivesAFileWithEveryKeyframe) {
  map_scans(4);
  Client asking(daemon_->address());
  const Json reply = asking.call("save_map", {{"name", "office"}});
  EXPECT_EQ(reply["accepted"], true);
  EXPECT_EQ(reply["job"]["kind"], "save_map");
  EXPECT_EQ(reply["job"]["state"], "running");
  const Json job = wait_for_end(reply["job"]["id"].get<int>());
  ASSERT_EQ(job["state"], "done") << job;
  EXPECT_EQ(job["progress"], 1.0);
  EXPECT_EQ(job["result"]["name"], "office");
  EXPECT_GE(job["result"]["seconds"], 0.0);

  const std::string bytes = slam::test::read_bytes(map_file("office"));
  EXPECT_EQ(job["result"]["bytes"], bytes.size());
  EXPECT_EQ(job["result"]["checksum"],
            fmt::format("{:016x}", crc64(std::as_bytes(std::span(bytes)))));
  // What was made within the last moment, too: the store writes every 0.4 s by itself.
  EXPECT_EQ(slam::SessionReader(map_file("office")).keyframe_count(),
            asking.call("get_status")["map"]["keyframes"].get<std::size_t>());
}

TEST_F(MapsTest, MappingGoesOnWhileAndAfterItIsSaved) {
  map_scans(3);
  const auto packets = room_packets(daemon_->info(), 8);
  daemon_->feed({packets.begin() + static_cast<std::ptrdiff_t>(fed_), packets.end()});
  ASSERT_EQ(save("first")["state"], "done");
  ASSERT_TRUE(daemon_->wait_for(
      "get_status", [](const Json& s) { return has_poses(s, 8) && s["map"]["keyframes"] >= 4; }));
  ASSERT_EQ(save("second")["state"], "done");
  const Json status = client().call("get_status");
  const auto first = slam::SessionReader(map_file("first")).keyframe_count();
  const auto second = slam::SessionReader(map_file("second")).keyframe_count();
  EXPECT_GE(first, 1U);
  EXPECT_LE(first, second);
  EXPECT_EQ(second, status["map"]["keyframes"].get<std::size_t>());
  EXPECT_EQ(status["counters"]["dropped_keyframes"], 0);
}

TEST_F(MapsTest, SavingAgainReplacesTheMap) {
  map_scans(2);
  ASSERT_EQ(save("office")["state"], "done");
  const auto before = slam::SessionReader(map_file("office")).keyframe_count();
  map_scans(6);
  ASSERT_EQ(save("office")["state"], "done");
  EXPECT_GT(slam::SessionReader(map_file("office")).keyframe_count(), before);
  EXPECT_EQ(client().call("list_maps")["maps"].size(), 1U);
}

TEST_F(MapsTest, TheJobsWayIsToldInEvents) {
  map_scans(3);
  Client asking(daemon_->address());
  asking.call("subscribe", {{"topics", {"events"}}});
  const Json reply = asking.call("save_map", {{"name", "office"}});
  std::vector<Json> told;
  while (told.empty() || told.back()["state"] == "running") {
    const Json event = asking.next_message(10s)["params"];
    if (event["kind"] != "job") continue;
    EXPECT_TRUE(event.contains("t_host_ns"));
    told.push_back(event["job"]);
  }
  EXPECT_EQ(told.front()["state"], "running");
  EXPECT_EQ(told.back()["state"], "done");
  EXPECT_EQ(told.back()["id"], reply["job"]["id"]);
  EXPECT_EQ(told.back()["kind"], "save_map");
  EXPECT_EQ(told.back()["result"]["name"], "office");
}

TEST_F(MapsTest, WhatIsNoNameIsRefusedAndTouchesNoFile) {
  map_scans(2);
  const std::vector<Json> bad = {"",
                                 ".",
                                 "..",
                                 "../office",
                                 "/tmp/office",
                                 "a/b",
                                 "a b",
                                 ".hidden",
                                 "-x",
                                 "b\xc3\xbcro",
                                 std::string(65, 'x'),
                                 std::string("a\0b", 3),
                                 7,
                                 nullptr,
                                 Json::array({"a"})};
  for (const char* method : {"save_map", "delete_map"}) {
    for (const Json& name : bad) {
      const Json error = refusal(method, {{"name", name}});
      ASSERT_FALSE(error.is_null()) << method << name;
      EXPECT_EQ(error["code"], kInvalidParams);
      EXPECT_EQ(error["data"]["field"], "name");
    }
    EXPECT_EQ(refusal(method)["data"]["field"], "name");
  }
  EXPECT_FALSE(fs::exists(directory_ / "maps"));
  EXPECT_TRUE(client().call("get_status")["jobs"].empty());
}

TEST_F(MapsTest, MapsAreListedWithWhatTheyHoldAndDamagedOnesWithWhy) {
  EXPECT_EQ(client().call("list_maps")["maps"], Json::array());
  map_scans(5);
  const Json job = save("office");
  std::ofstream(map_file("broken")) << "no session";
  const Json reply = client().call("list_maps");
  EXPECT_EQ(reply["sensor"], 0);
  ASSERT_EQ(reply["maps"].size(), 2U);
  EXPECT_EQ(reply["maps"][0]["name"], "broken");
  EXPECT_TRUE(reply["maps"][0].contains("error"));
  const Json& office = reply["maps"][1];
  EXPECT_EQ(office["name"], "office");
  EXPECT_EQ(office["bytes"], job["result"]["bytes"]);
  EXPECT_EQ(office["keyframes"], slam::SessionReader(map_file("office")).keyframe_count());
  EXPECT_EQ(office["segments"], 1);
  EXPECT_EQ(office["loops"], 0);
  EXPECT_GT(office["way_m"], 0.05);
  EXPECT_GT(office["duration_s"], 0.2);
  const auto saved_ns = office["saved_ns"].get<std::int64_t>();
  EXPECT_LT(std::abs(saved_ns - read_clock_ns(CLOCK_REALTIME)), 60 * kNsPerSecond);
  EXPECT_EQ(office["saved"], time_string(saved_ns));
}

TEST_F(MapsTest, AMapIsDeletedOnceAndThenThereIsNone) {
  map_scans(2);
  save("office");
  save("attic");
  EXPECT_EQ(client().call("delete_map", {{"name", "office"}})["deleted"], "office");
  EXPECT_FALSE(fs::exists(map_file("office")));
  const Json error = refusal("delete_map", {{"name", "office"}});
  EXPECT_EQ(error["data"]["code"], "NO_SUCH_MAP");
  EXPECT_EQ(error["data"]["field"], "name");
  EXPECT_EQ(client().call("list_maps")["maps"].size(), 1U);
  EXPECT_TRUE(fs::exists(map_file("attic")));
}

TEST_F(MapsTest, WhileAJobRunsAnotherIsBusyAndQueriesAreAnswered) {
  map_scans(2);
  const auto id = run_job();
  const Json error = refusal("save_map", {{"name", "office"}});
  EXPECT_EQ(error["data"]["code"], "BUSY");
  EXPECT_EQ(error["data"]["job"]["id"], id);
  EXPECT_EQ(error["data"]["job"]["kind"], "walk");
  Client asking(daemon_->address());
  EXPECT_FALSE(asking.call("get_map")["tiles"].empty());
  EXPECT_EQ(asking.call("list_maps")["maps"], Json::array());
  const Json jobs = asking.call("get_status")["jobs"];
  ASSERT_EQ(jobs.size(), 1U);
  EXPECT_EQ(jobs[0]["state"], "running");
  EXPECT_EQ(jobs[0]["progress"], 0.5);
  stop_ = true;
  EXPECT_EQ(wait_for_end(static_cast<int>(id))["result"]["steps"], 7);
  EXPECT_EQ(save("office")["state"], "done");
}

TEST_F(MapsTest, ALongJobIsNoDeadThread) {
  run_job();
  std::this_thread::sleep_for(2200ms);
  EXPECT_TRUE(daemon_->runtime().alive(2'000'000'000));
  stop_ = true;
}

TEST_F(MapsTest, AJobMayBeDoneByAnotherThread) {
  const auto job = daemon_->runtime().jobs().begin("load_map");
  ASSERT_TRUE(job);
  EXPECT_EQ(refusal("save_map", {{"name", "a"}})["data"]["code"], "NOT_TRACKING");
  map_scans(2);
  EXPECT_EQ(refusal("save_map", {{"name", "a"}})["data"]["code"], "BUSY");
  std::thread([job] {
    static_cast<void>(job->progress(0.3));
    job->done({{"keyframes", 3}});
  }).join();
  EXPECT_EQ(wait_for_end(1)["result"]["keyframes"], 3);
}

TEST_F(MapsTest, AJobThatThrowsHasFailedAndTheNextOneRuns) {
  map_scans(2);
  const auto begun = daemon_->runtime().start_job(
      "walk", [](RunningJob&) -> std::optional<Json> { throw InputError("no shoes"); });
  ASSERT_TRUE(begun);
  const Json job = wait_for_end(static_cast<int>(begun->id));
  EXPECT_EQ(job["state"], "failed");
  EXPECT_EQ(job["error"], "no shoes");
  EXPECT_EQ(daemon_->runtime().fault(), "");
  EXPECT_EQ(save("office")["state"], "done");
}

TEST_F(MapsTest, APlaceThatCannotBeWrittenIsToldByTheJob) {
  map_scans(2);
  std::ofstream(directory_ / "maps") << "in the way";
  const Json job = save("office");
  EXPECT_EQ(job["state"], "failed");
  EXPECT_THAT(job["error"].get<std::string>(), HasSubstr("maps"));
  EXPECT_EQ(refusal("list_maps")["code"], kInternalError);
  EXPECT_EQ(daemon_->runtime().fault(), "");
}

TEST_F(MapsTest, StoppingGivesUpTheJobThatRuns) {
  run_job();
  const std::shared_ptr<EventLog> events = options_.events;
  const auto start = std::chrono::steady_clock::now();
  daemon_.reset();
  EXPECT_LT(std::chrono::steady_clock::now() - start, 5s);
  Json last;
  std::uint64_t cursor = 0;
  while (const auto event = events->next(cursor)) {
    if (event->kind == "job") last = event->fields["job"];
  }
  EXPECT_EQ(last["state"], "cancelled");
}

TEST_F(MapsTest, ASaveThatIsGivenUpLeavesWhatWasThere) {
  const fs::path large = directory_ / "large.glint";
  {
    slam::SessionStore store(large);
    // Some 10 MB, so that a copy takes several steps.
    for (std::uint64_t id = 0; id < 60; ++id) {
      store.add(slam::test::sample_keyframe(id, 20'000, 500), {});
    }
  }
  const SavedMaps maps(directory_);
  maps.make_place();
  std::ofstream(map_file("office")) << "before";
  RunningJob* running = nullptr;
  RunningJob job({}, [&](const JobReport& report) {
    if (report.progress > 0.0) running->give_up();
  });
  running = &job;
  EXPECT_FALSE(save_map({large, "office", maps}, daemon_->runtime(), job));
  EXPECT_LT(job.report().progress, 1.0);
  EXPECT_EQ(slam::test::read_bytes(map_file("office")), "before");
  EXPECT_EQ(std::distance(fs::directory_iterator(directory_ / "maps"), {}), 1);
}

TEST_F(MapsTest, BeforeTheFirstKeyframeThereIsNothingToSave) {
  const Json error = refusal("save_map", {{"name", "office"}});
  EXPECT_EQ(error["data"]["code"], "NOT_TRACKING");
  EXPECT_FALSE(fs::exists(map_file("office"))) << "nor is a good map replaced by an empty one";
}

TEST(MapsWithoutAPlaceTest, EveryMethodNamesTheKeyToSet) {
  Config config;
  config.state.directory = "";
  TestDaemon daemon(config);
  Client client(daemon.address());
  for (const char* method : {"save_map", "list_maps", "delete_map"}) {
    try {
      client.call(method, {{"name", "office"}});
      FAIL() << method;
    } catch (const ReplyError& error) {
      EXPECT_EQ(error.error()["data"]["code"], "NOT_CONFIGURED");
      EXPECT_EQ(error.error()["data"]["field"], "state.directory");
    }
  }
}

}  // namespace
}  // namespace glint::daemon
