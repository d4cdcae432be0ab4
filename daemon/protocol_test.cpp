// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "daemon/protocol.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "daemon/protocol_pose.hpp"
#include "daemon/protocol_status.hpp"

namespace glint::daemon {
namespace {

Request request_of(std::string_view line) { return std::get<Request>(parse_request(line)); }
int error_of(std::string_view line) {
  const auto parsed = parse_request(line);
  const auto* bad = std::get_if<BadRequest>(&parsed);
  return bad == nullptr ? 0 : bad->error.code();
}

TEST(ProtocolTest, ARequestIsReadAndUnknownFieldsIgnored) {
  const Request request =
      request_of(R"({"jsonrpc":"2.0","id":"x7","method":"m","params":{"a":1},"more":true})");
  EXPECT_TRUE(request.has_id);
  EXPECT_EQ(request.id, "x7");
  EXPECT_EQ(request.method, "m");
  EXPECT_EQ(request.params["a"], 1);
  EXPECT_FALSE(request_of(R"({"method":"m"})").has_id);
}

TEST(ProtocolTest, EachKindOfBadRequestHasItsCode) {
  EXPECT_EQ(error_of("GET / HTTP/1.1"), kParseError);
  EXPECT_EQ(error_of("{\"id\":1,"), kParseError);
  EXPECT_EQ(error_of("{\"id\":1,\"method\":\"\xff\"}"), kParseError);
  EXPECT_EQ(error_of("{\"id\":1,\"method\":\"m\",\"params\":{\"x\":1e999}}"), kParseError);
  EXPECT_EQ(error_of("[{\"id\":1,\"method\":\"m\"}]"), kInvalidRequest);
  EXPECT_EQ(error_of("7"), kInvalidRequest);
  EXPECT_EQ(error_of(R"({"id":[1],"method":"m"})"), kInvalidRequest);
  EXPECT_EQ(error_of(R"({"id":1,"method":7})"), kInvalidRequest);
  EXPECT_EQ(error_of(R"({"id":1})"), kInvalidRequest);
  EXPECT_EQ(error_of(R"({"id":1,"method":"m","params":[1]})"), kInvalidParams);
}

TEST(ProtocolTest, DeepNestingIsRefusedBeforeItIsParsed) {
  EXPECT_EQ(error_of(std::string(500'000, '[')), kInvalidRequest);
  EXPECT_EQ(error_of(R"({"id":1,"method":"[[[[[[[[[[[[[[[[[[[[[["})"), 0) << "inside a string";
}

TEST(ProtocolTest, RandomBytesNeverThrow) {
  std::mt19937 random(7);
  const std::string alphabet = "{}[]\",:\\ntrue0123456789.eE-+idmethodparams \x01\xff";
  for (int i = 0; i < 20'000; ++i) {
    std::string line;
    for (std::size_t n = random() % 60; n > 0; --n) line += alphabet[random() % alphabet.size()];
    EXPECT_NO_THROW(parse_request(line));
  }
}

TEST(ProtocolTest, TimesAreToldAndTakenExactly) {
  EXPECT_EQ(time_string(1'317'000'004'901'023'001), "1317000004.901023001");
  EXPECT_EQ(time_string(5), "0.000000005");
  EXPECT_EQ(time_string(-1), "-0.000000001");
  const auto at = [](const Json& value) { return time_param({{"at_ns", value}}, "at").value().ns; };
  EXPECT_EQ(at(1'317'000'004'901'023'001), 1'317'000'004'901'023'001);
  EXPECT_EQ(at("1317000004.901023001"), 1'317'000'004'901'023'001);
  EXPECT_EQ(at("12.5"), 12'500'000'000);
  EXPECT_EQ(time_param({{"at", "3"}}, "at").value().ns, 3'000'000'000);
  EXPECT_FALSE(time_param(Json::object(), "at").has_value());
  for (const Json& bad : {Json("x"), Json("1.2.3"), Json(""), Json(1.5), Json(true),
                          Json("1.0000000001"), Json("99999999999999"), Json(UINT64_MAX)}) {
    EXPECT_THROW(at(bad), RpcError) << bad;
  }
}

TEST(ProtocolTest, AnErrorCarriesItsNameAndField) {
  const Json error = RpcError(kOutOfRange, "sentence", "at_ns", {{"from_ns", 1}}).to_json();
  EXPECT_EQ(error, Json::parse(R"({"code":-32006,"message":"sentence",
      "data":{"from_ns":1,"code":"OUT_OF_RANGE","field":"at_ns"}})"));
}

class PoseJsonTest : public testing::Test {
 protected:
  PoseJsonTest() {
    slam::OdometryEstimate& e = snapshot_.estimate.emplace();
    e.stamp.ns = 1'000'000'000;
    e.T_odom_sensor = {so3_exp({0.1, 0.2, 1.5}), {1.0 / 3.0, -2.0, 0.7}};
    e.velocity << 1.0, 0.5, 0.0, 0.0, 0.0, 0.3;
    e.covariance.setIdentity();
    e.state = slam::TrackingState::kTracking;
    snapshot_.arrival_ns = kArrivalNs;
    snapshot_.correction.T_map_odom = {so3_exp({0, 0, 0.5}), {10, 0, 0}};
    snapshot_.correction.epoch = 3;
    context_.T_base_sensor = {so3_exp({0, 0.3, 0}), {0.2, 0.0, 0.9}};
    context_.scan_period_ns = 100'000'000;
  }
  Json pose(const Json& params, std::int64_t age_ns = 0) {
    return get_pose(params, snapshot_, context_, kArrivalNs + age_ns);
  }
  static Eigen::Vector3d vector(const Json& v) {
    return {v[0].get<double>(), v[1].get<double>(), v[2].get<double>()};
  }

  static constexpr std::int64_t kArrivalNs = 5'000'000'000;
  Snapshot snapshot_;
  PoseContext context_;
};

TEST_F(PoseJsonTest, DoublesSurviveTheWireBitForBit) {
  const Json read = Json::parse(pose({{"frame", "odom"}}).dump());
  EXPECT_EQ(vector(read["p_m"]), snapshot_.estimate->T_odom_sensor.translation_m);
  EXPECT_EQ(read["q_xyzw"][2].get<double>(), snapshot_.estimate->T_odom_sensor.rotation.z());
}

TEST_F(PoseJsonTest, FramesCompose) {
  const Eigen::Vector3d point(1, 2, 3);
  const Pose T_map_base = snapshot_.correction.T_map_odom * snapshot_.estimate->T_odom_sensor *
                          context_.T_base_sensor.inverse();
  const Json json = pose({{"frame", "map"}, {"child", "base"}});
  EXPECT_TRUE(vector(json["p_m"]).isApprox(T_map_base.translation_m, 1e-12));
  EXPECT_EQ(json["map_epoch"], 3);
  EXPECT_EQ(json["frame"], "map");
  EXPECT_EQ(json["child"], "base");
}

TEST_F(PoseJsonTest, InAMapThatIsOnlyReadThePoseIsAsSureAsItsPlaceThere) {
  auto certainty = std::make_shared<slam::PlaceCertainty>();
  certainty->T_odom_sensor = snapshot_.estimate->T_odom_sensor;
  certainty->covariance.diagonal().setConstant(0.04);
  snapshot_.correction.certainty = certainty;
  snapshot_.correction.confidence = 0.75;
  const Json map = pose({{"frame", "map"}});
  EXPECT_NEAR(map["cov"][0].get<double>(), 0.04, 1e-12);
  EXPECT_NEAR(map["cov"][35].get<double>(), 0.04, 1e-12);
  EXPECT_EQ(map["confidence"], 0.75);
  EXPECT_NEAR(pose({{"frame", "odom"}})["cov"][0].get<double>(),
              snapshot_.estimate->covariance(0, 0), 1e-12);
  // Some way on it is less sure.
  snapshot_.estimate->T_odom_sensor.translation_m.x() += 0.4;
  EXPECT_GT(pose({{"frame", "map"}})["cov"][0].get<double>(), 0.04);
}

TEST_F(PoseJsonTest, WhileItsPlaceIsLookedForNothingIsKnownInTheMap) {
  snapshot_.correction.placed = false;
  snapshot_.correction.confidence = 1.0 / 3.0;
  const Json map = pose({{"frame", "map"}});
  EXPECT_EQ(map["state"], "LOCALIZING");
  EXPECT_EQ(map["confidence"], 1.0 / 3.0);
  for (const char* unknown : {"p_m", "q_xyzw", "cov", "T_map_odom"}) {
    EXPECT_FALSE(map.contains(unknown)) << unknown;
  }
  EXPECT_TRUE(map.contains("v_mps"));
  EXPECT_FALSE(pose({{"frame", "map"}, {"predict_ms", 50}}).contains("p_m"));
  const Json odom = pose({{"frame", "odom"}});
  EXPECT_EQ(odom["state"], "LOCALIZING");
  EXPECT_EQ(vector(odom["p_m"]), snapshot_.estimate->T_odom_sensor.translation_m);
  snapshot_.estimate->state = slam::TrackingState::kLost;
  EXPECT_EQ(pose({{"frame", "odom"}})["state"], "LOST") << "it goes before";
}

TEST_F(PoseJsonTest, OnlyAxesThatNothingHoldsAreDegenerate) {
  EXPECT_EQ(pose(Json::object())["degenerate_axes"], Json::array());
  slam::OdometryEstimate& estimate = *snapshot_.estimate;
  const Eigen::Vector3d axis = estimate.T_odom_sensor.rotation * Eigen::Vector3d::UnitX();
  estimate.covariance.setZero();
  estimate.covariance(0, 0) = 0.25;
  estimate.weak_axes.add({.rotation = false, .axis = axis, .critical = true});
  estimate.weak_axes.add({.rotation = true, .axis = axis, .critical = false});
  const Json axes = pose({{"frame", "map"}})["degenerate_axes"];
  ASSERT_EQ(axes.size(), 1U);
  EXPECT_EQ(axes[0]["kind"], "translation");
  EXPECT_NEAR(axes[0]["sigma_m"].get<double>(), 0.5, 1e-9);
  EXPECT_TRUE(
      vector(axes[0]["axis"]).isApprox(snapshot_.correction.T_map_odom.rotation * axis, 1e-9));
}

TEST_F(PoseJsonTest, TheBaseMovesAsTheRigidBodyDoes) {
  // Finite difference of the base's pose, for a sensor moving at the estimate's velocity.
  const double dt = 1e-6;
  const Pose T_sensor_base = context_.T_base_sensor.inverse();
  const Pose& start = snapshot_.estimate->T_odom_sensor;
  const Pose later = start * se3_exp(snapshot_.estimate->velocity * dt);
  const Twist expected = se3_log((start * T_sensor_base).inverse() * (later * T_sensor_base)) / dt;
  const Json json = pose({{"frame", "odom"}, {"child", "base"}});
  EXPECT_TRUE(vector(json["v_mps"]).isApprox(expected.head<3>(), 1e-5));
  EXPECT_TRUE(vector(json["w_radps"]).isApprox(expected.tail<3>(), 1e-5));
}

TEST_F(PoseJsonTest, APoseOlderThanThreeScanPeriodsIsNeverTracking) {
  EXPECT_EQ(pose(Json::object(), 299'000'000)["state"], "TRACKING");
  const Json old = pose(Json::object(), 301'000'000);
  EXPECT_EQ(old["state"], "DEGRADED");
  EXPECT_EQ(old["stale"], true);
  EXPECT_EQ(old["age_ms"], 301.0);
  snapshot_.estimate->state = slam::TrackingState::kLost;
  EXPECT_EQ(pose(Json::object(), 301'000'000)["state"], "LOST");
  snapshot_.paused = true;
  EXPECT_EQ(pose(Json::object())["state"], "PAUSED");
}

TEST_F(PoseJsonTest, PredictionMovesAtConstantVelocityAndIsBounded) {
  const Json json = pose({{"frame", "odom"}, {"predict_ms", 100}});
  const Pose expected =
      snapshot_.estimate->T_odom_sensor * se3_exp(snapshot_.estimate->velocity * 0.1);
  EXPECT_TRUE(vector(json["p_m"]).isApprox(expected.translation_m, 1e-12));
  EXPECT_EQ(json["t_ns"], 1'100'000'000);
  EXPECT_EQ(json["t"], "1.100000000");
  EXPECT_THROW(pose({{"predict_ms", 201}}), RpcError);
  EXPECT_THROW(pose({{"predict_ms", -1}}), RpcError);
  EXPECT_THROW(pose({{"predict_ms", 10}, {"at_ns", 5}}), RpcError);
}

TEST_F(PoseJsonTest, WhatIsNotFiniteIsAbsent) {
  snapshot_.estimate->covariance(2, 2) = NAN;
  const Json json = pose(Json::object());
  EXPECT_FALSE(json.contains("cov"));
  EXPECT_EQ(json.dump().find("null"), std::string::npos);
}

TEST_F(PoseJsonTest, ATrajectoryIsPagedWithoutLossOrRepetition) {
  for (std::int64_t k = 0; k < 4500; ++k) {
    PoseRecord record;
    record.stamp.ns = k;
    snapshot_.history.append(record);
  }
  Json params = Json::object();
  std::int64_t expected = 0;
  int pages = 0;
  while (true) {
    const Json page = get_trajectory(params, snapshot_, context_, kArrivalNs);
    EXPECT_LT(page.dump().size(), kMaxLineBytes);
    for (const Json& p : page["poses"]) EXPECT_EQ(p["t_ns"], expected++);
    ++pages;
    if (!page.contains("next_cursor")) break;
    params["cursor"] = page["next_cursor"];
  }
  EXPECT_EQ(expected, 4500);
  EXPECT_EQ(pages, 3);
  const Json since = get_trajectory({{"since_ns", 4497}}, snapshot_, context_, kArrivalNs);
  ASSERT_EQ(since["poses"].size(), 2U);
  EXPECT_EQ(since["poses"][0]["t_ns"], 4498);
  EXPECT_THROW(get_trajectory({{"cursor", "x"}}, snapshot_, context_, kArrivalNs), RpcError);
}

TEST_F(PoseJsonTest, StatusHasStateTimeAndCountersAndNothingUnknown) {
  RuntimeStatus runtime;
  snapshot_.packets.missing_packets = 7;
  runtime.snapshot = std::make_shared<const Snapshot>(snapshot_);
  auto map = std::make_shared<MapState>();
  map->map = std::make_shared<const slam::MapSnapshot>();
  runtime.map = map;
  ServiceStatus service;
  service.scan_period_ns = context_.scan_period_ns;
  const Json json = status_json(runtime, service, kArrivalNs);
  EXPECT_EQ(json["sensor"], 0);
  EXPECT_EQ(json["state"], "TRACKING");
  EXPECT_EQ(json["t_ns"], 1'000'000'000);
  EXPECT_EQ(json["counters"]["missing_packets"], 7);
  EXPECT_EQ(json.dump().find("null"), std::string::npos);
}

}  // namespace
}  // namespace glint::daemon
