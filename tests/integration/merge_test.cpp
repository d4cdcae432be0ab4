// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
//
// glint merge: two walks of one world, and of two.
#include <gmock/gmock.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "pcap/test_capture.hpp"
#include "slam/store/session_reader.hpp"
#include "tests/integration/glint_command.hpp"

namespace glint::test {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

/// A pose of a ground truth.
struct TruePose {
  double t_s = 0.0;
  Pose T_world_sensor;
};

class MergeCommand : public ::testing::Test {
 protected:
  void make_session(const std::string& name, std::vector<std::string> options) const {
    options.insert(options.begin(), "simulate");
    options.emplace_back("--out");
    options.push_back(dir_ / name);
    const CommandResult simulated = run_glint(options);
    ASSERT_EQ(simulated.exit_code, 0) << simulated.out;
    const CommandResult replayed =
        run_glint({"replay", dir_ / name / "capture.pcap", "--out", dir_ / name});
    ASSERT_EQ(replayed.exit_code, 0) << replayed.out;
  }
  [[nodiscard]] fs::path session(const std::string& name) const {
    return dir_ / name / "session.glint";
  }
  [[nodiscard]] std::vector<TruePose> truth(const std::string& name) const {
    std::ifstream in(dir_ / name / "groundtruth_100hz.tum");
    std::vector<TruePose> poses;
    for (std::string line; std::getline(in, line);) {
      std::istringstream text(line);
      TruePose pose;
      Eigen::Vector3d& at_m = pose.T_world_sensor.translation_m;
      Eigen::Vector4d q;
      if (!(text >> pose.t_s >> at_m.x() >> at_m.y() >> at_m.z() >> q.x() >> q.y() >> q.z() >>
            q.w())) {
        continue;
      }
      pose.T_world_sensor.rotation = Eigen::Quaterniond(q.w(), q.x(), q.y(), q.z());
      poses.push_back(pose);
    }
    return poses;
  }
  /// The walk of `name` from its end back to `until_s` after its start, as a file.
  [[nodiscard]] fs::path backwards(const std::string& name, double until_s) const {
    const std::vector<TruePose> poses = truth(name);
    const fs::path file = dir_ / "backwards.tum";
    std::ofstream out(file);
    out.precision(12);
    for (auto pose = poses.rbegin(); pose != poses.rend(); ++pose) {
      if (pose->t_s - poses.front().t_s < until_s) break;
      const auto& [q, at_m] = pose->T_world_sensor;
      out << poses.back().t_s - pose->t_s << ' ' << at_m.x() << ' ' << at_m.y() << ' ' << at_m.z()
          << ' ' << q.x() << ' ' << q.y() << ' ' << q.z() << ' ' << q.w() << '\n';
    }
    return file;
  }
  static Pose pose_at(const std::vector<TruePose>& truth, SensorTime stamp) {
    const double t_s = static_cast<double>(stamp.ns) * kSecondsPerNs;
    const auto at = std::ranges::lower_bound(truth, t_s, {}, &TruePose::t_s);
    return at == truth.end() ? truth.back().T_world_sensor : at->T_world_sensor;
  }

  const TempDir dir_;
};

TEST_F(MergeCommand, TwoWalksOfOneWorldMakeOneMapThatAgreesWithTheTruth) {
  make_session("a", {"--world", "room", "--seed", "1", "--seconds", "24"});
  make_session("b", {"--world", "room", "--seed", "1", "--trajectory", backwards("a", 8.0)});
  const fs::path merged = dir_ / "merged.glint";
  const CommandResult result =
      run_glint({"merge", session("a"), session("b"), "--out", merged, "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.out;
  const auto summary = nlohmann::json::parse(result.out);
  EXPECT_EQ(summary["sessions"], 2);
  EXPECT_GE(summary["joints"], 3);
  EXPECT_GE(summary["keyframes_thinned"], 5);

  const slam::SessionReader map(merged);
  const auto poses = map.poses();
  EXPECT_EQ(poses.size(), summary["keyframes_kept"].get<std::size_t>() +
                              summary["keyframes_thinned"].get<std::size_t>());
  const std::array<std::vector<TruePose>, 2> truths = {truth("a"), truth("b")};
  const Pose T_world_map =
      pose_at(truths[0], poses.front().stamp) * poses.front().T_map_sensor.inverse();
  std::size_t of_b = 0;
  for (const slam::KeyframePose& pose : poses) {
    const Pose there = pose_at(truths.at(pose.segment), pose.stamp);
    of_b += pose.segment;
    EXPECT_LT(((T_world_map * pose.T_map_sensor).translation_m - there.translation_m).norm(), 0.1)
        << "keyframe " << pose.id;
  }
  EXPECT_GT(of_b, 10U);

  const CommandResult again = run_glint({"merge", session("a"), session("b"), "--out", merged});
  EXPECT_EQ(again.exit_code, 3) << again.out;
  EXPECT_THAT(again.out, HasSubstr("--force"));
  const CommandResult onto_itself =
      run_glint({"merge", session("a"), session("b"), "--force", "--out", session("a")});
  EXPECT_EQ(onto_itself.exit_code, 3) << onto_itself.out;
}

TEST_F(MergeCommand, WalksOfTwoWorldsAreRefused) {
  make_session("a", {"--world", "room", "--seed", "1", "--seconds", "10"});
  make_session("b", {"--world", "corridor", "--seed", "2", "--seconds", "10"});
  const CommandResult result =
      run_glint({"merge", session("a"), session("b"), "--out", dir_ / "merged.glint"});
  EXPECT_EQ(result.exit_code, 1) << result.out;
  EXPECT_THAT(result.out, HasSubstr(session("a").string()));
  EXPECT_THAT(result.out, HasSubstr(session("b").string()));
  EXPECT_FALSE(fs::exists(dir_ / "merged.glint"));
}

}  // namespace
}  // namespace glint::test
