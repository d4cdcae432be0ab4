// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "driver/core/clock_model.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace glint {
namespace {

constexpr std::int64_t kPeriod_ns = 100'000'000;
constexpr std::int64_t kPacketGap_ns = kPeriod_ns / 64;
constexpr std::int64_t kMs = 1'000'000;

/// Packets of a 1024x10 sensor over a network with queues: exponential delays, and some packets
/// that are late by tens of milliseconds.
class Network {
 public:
  Network(double queue_ms, double skew_ppm, double outliers = 0.05)
      : delay_ns_(1e-6 / queue_ms), skew_(skew_ppm * 1e-6), outlier_(outliers) {}

  /// Sends packets for so long; the jumps that the model told meanwhile.
  std::vector<ClockJump> run(ClockModel& model, double seconds) {
    std::vector<ClockJump> jumps;
    const auto packets = static_cast<std::int64_t>(seconds * 1e9) / kPacketGap_ns;
    for (std::int64_t i = 0; i < packets; ++i) {
      elapsed_ns_ += kPacketGap_ns;
      double delay_ns = delay_ns_(random_);
      if (outlier_(random_)) delay_ns += late_ns_(random_);
      const HostTime host{truth().ns + std::llround(delay_ns)};
      if (const auto jump = model.add(sensor(), host)) jumps.push_back(*jump);
    }
    return jumps;
  }
  void step_sensor(std::int64_t by_ns) { sensor_start_ns_ += by_ns; }
  void step_host(std::int64_t by_ns) { host_start_ns_ += by_ns; }
  void set_skew_ppm(double skew_ppm) {
    host_start_ns_ = truth().ns;
    sensor_start_ns_ += elapsed_ns_;
    elapsed_ns_ = 0;
    skew_ = skew_ppm * 1e-6;
  }

  [[nodiscard]] SensorTime sensor() const { return {sensor_start_ns_ + elapsed_ns_}; }
  /// The host time at which a packet of now would come if it were not delayed.
  [[nodiscard]] HostTime truth() const {
    const double ahead_ns = skew_ * static_cast<double>(elapsed_ns_);
    return {host_start_ns_ + elapsed_ns_ + std::llround(ahead_ns)};
  }
  [[nodiscard]] double error_us(const ClockModel& model) const {
    return static_cast<double>(*model.to_host(sensor()) - truth()) * 1e-3;
  }

 private:
  std::mt19937_64 random_{1};
  std::exponential_distribution<double> delay_ns_;
  std::uniform_real_distribution<double> late_ns_{10e6, 45e6};
  double skew_;
  std::bernoulli_distribution outlier_;
  std::int64_t sensor_start_ns_ = 5'000'000'000;
  std::int64_t host_start_ns_ = 1'790'000'000'123'456'789;
  std::int64_t elapsed_ns_ = 0;
};

struct Condition {
  double queue_ms;
  double skew_ppm;
};

class ClockModelAccuracy : public testing::TestWithParam<Condition> {};

// What the README's figures rest on.
TEST_P(ClockModelAccuracy, IsOfMicrosecondsThoughPacketsAreLateByMilliseconds) {
  const Condition condition = GetParam();
  Network network(condition.queue_ms, condition.skew_ppm);
  ClockModel model(kPeriod_ns);
  const auto worst_us = [&](int seconds) {
    double worst = 0.0;
    for (int i = 0; i < 10 * seconds; ++i) {
      EXPECT_TRUE(network.run(model, 0.1).empty());
      worst = std::max(worst, std::abs(network.error_us(model)));
    }
    return worst;
  };
  const double first_s_us = worst_us(1);
  worst_us(7);
  const double after_8_s_us = worst_us(2);
  worst_us(45);
  const double after_a_minute_us = worst_us(5);
  const double later_us = worst_us(540);
  RecordProperty("first_s_us", std::to_string(first_s_us));
  RecordProperty("after_10_s_us", std::to_string(after_8_s_us));
  RecordProperty("after_60_s_us", std::to_string(after_a_minute_us));
  RecordProperty("after_600_s_us", std::to_string(later_us));
  EXPECT_LT(first_s_us, 100.0 + 20.0 * condition.queue_ms);
  EXPECT_LT(after_8_s_us, 1.0 + 2.0 * condition.queue_ms);
  EXPECT_LT(after_a_minute_us, 1.0 + 1.0 * condition.queue_ms);
  EXPECT_LT(later_us, 1.0 + 1.5 * condition.queue_ms);
  EXPECT_NEAR(model.status().skew_ppm, condition.skew_ppm, 0.1);
  EXPECT_EQ(model.status().jumps, 0U);
}

INSTANTIATE_TEST_SUITE_P(Conditions, ClockModelAccuracy,
                         testing::Values(Condition{0.1, 0.0}, Condition{0.1, 100.0},
                                         Condition{0.5, -100.0}, Condition{2.0, 0.0},
                                         Condition{2.0, 100.0}));

TEST(ClockModelTest, SigmaIsOfTheSizeOfTheErrorFromTheFirstPacketOn) {
  Network network(0.5, 50.0);
  ClockModel model(kPeriod_ns);
  int within = 0;
  constexpr int kLooks = 300;
  for (int i = 0; i < kLooks; ++i) {
    network.run(model, i < 100 ? 0.01 : 0.2);
    const double sigma_us = static_cast<double>(model.status().sigma_ns) * 1e-3;
    if (std::abs(network.error_us(model)) <= 2.0 * sigma_us) ++within;
  }
  EXPECT_GT(within, kLooks * 9 / 10);
  EXPECT_LT(model.status().sigma_ns, 100'000);
}

struct Step {
  std::int64_t sensor_ns;
  std::int64_t host_ns;
};

class ClockModelJump : public testing::TestWithParam<Step> {};

TEST_P(ClockModelJump, IsToldOnceAndTheModelIsRightAgain) {
  const auto [sensor_ns, host_ns] = GetParam();
  Network network(0.5, 80.0);
  ClockModel model(kPeriod_ns);
  network.run(model, 30.0);
  network.step_sensor(sensor_ns);
  network.step_host(host_ns);
  const auto jumps = network.run(model, 1.5);
  ASSERT_EQ(jumps.size(), 1U);
  EXPECT_NEAR(static_cast<double>(jumps[0].jump_ns), static_cast<double>(host_ns - sensor_ns), 2e6);
  EXPECT_EQ(model.status().jumps, 1U);
  EXPECT_LT(std::abs(network.error_us(model)), 200.0);
  EXPECT_TRUE(network.run(model, 30.0).empty());
  EXPECT_LT(std::abs(network.error_us(model)), 20.0);
}

INSTANTIATE_TEST_SUITE_P(Steps, ClockModelJump,
                         testing::Values(Step{3000 * kMs, 0}, Step{-3000 * kMs, 0},
                                         Step{0, 3000 * kMs}, Step{0, -3000 * kMs},
                                         Step{60 * kMs, 0}, Step{-60 * kMs, 0},
                                         Step{3'600'000 * kMs, 0}, Step{-34'000 * kMs, 0},
                                         Step{1'790'000'000'000 * kMs, 0}));

TEST(ClockModelTest, AStepOfTheSensorIsFoundWithinAFifthOfAScan) {
  for (const std::int64_t step_ns : {3000 * kMs, -3000 * kMs}) {
    Network network(0.1, 0.0, 0.0);
    ClockModel model(kPeriod_ns);
    network.run(model, 10.0);
    network.step_sensor(step_ns);
    EXPECT_EQ(network.run(model, 0.02).size(), 1U) << step_ns;
  }
}

TEST(ClockModelTest, WhilePacketsContradictItSigmaTellsByHowMuch) {
  Network network(0.1, 0.0, 0.0);
  ClockModel model(kPeriod_ns);
  network.run(model, 10.0);
  network.step_sensor(3000 * kMs);
  network.run(model, 0.004);
  EXPECT_EQ(model.status().jumps, 0U);
  EXPECT_NEAR(static_cast<double>(model.status().sigma_ns), 3e9, 1e7);
}

TEST(ClockModelTest, StallsAndDamagedTimesAreNoJumps) {
  Network network(0.5, 20.0);
  ClockModel model(kPeriod_ns);
  network.run(model, 10.0);
  const SensorTime now = network.sensor();
  const HostTime host = network.truth();
  model.add(SensorTime{0}, host);
  model.add(SensorTime{std::int64_t{1} << 62}, host);
  // The network holds everything back for 0.4 s, then delivers it at once.
  for (int i = 0; i < 256; ++i) {
    EXPECT_FALSE(model.add(now + i * kPacketGap_ns, host + 400 * kMs + i * 10'000).has_value());
  }
  EXPECT_EQ(model.status().jumps, 0U);
  EXPECT_LT(std::abs(network.error_us(model)), 50.0);
}

TEST(ClockModelTest, APauseOfTheStreamIsNoJump) {
  Network network(0.5, 90.0);
  ClockModel model(kPeriod_ns);
  network.run(model, 20.0);
  ClockModel elsewhere(kPeriod_ns);
  network.run(elsewhere, 600.0);
  EXPECT_TRUE(network.run(model, 1.0).empty());
  EXPECT_LT(std::abs(network.error_us(model)), 2000.0);
}

TEST(ClockModelTest, AFirstPacketThatIsVeryLateIsForgottenWithoutAJump) {
  Network network(0.5, 0.0);
  ClockModel model(kPeriod_ns);
  model.add(network.sensor(), network.truth() + 800 * kMs);
  EXPECT_TRUE(network.run(model, 2.0).empty());
  EXPECT_LT(std::abs(network.error_us(model)), 100.0);
  EXPECT_EQ(model.status().jumps, 0U);
}

TEST(ClockModelTest, AnotherRateIsFollowed) {
  Network network(0.1, 0.0);
  ClockModel model(kPeriod_ns);
  network.run(model, 120.0);
  network.set_skew_ppm(20.0);
  EXPECT_TRUE(network.run(model, 120.0).empty());
  EXPECT_LT(std::abs(network.error_us(model)), 10.0);
  EXPECT_NEAR(model.status().skew_ppm, 20.0, 0.5);
}

TEST(ClockModelTest, WithoutHostTimesThereIsNoHostTime) {
  ClockModel model(kPeriod_ns);
  for (int i = 0; i < 1000; ++i) {
    EXPECT_FALSE(model.add(SensorTime{i * kPacketGap_ns}, HostTime{}).has_value());
  }
  EXPECT_FALSE(model.to_host(SensorTime{7}).has_value());
  EXPECT_FALSE(model.status().known);
}

TEST(ClockModelTest, TimesAtTheEndsOfTheirRangeAreSafe) {
  constexpr std::int64_t kLatest = std::int64_t{1} << 62;
  constexpr std::int64_t kMost = std::numeric_limits<std::int64_t>::max();
  constexpr std::int64_t kLeast = std::numeric_limits<std::int64_t>::min();
  for (const std::int64_t sensor : {std::int64_t{0}, kLatest, kMost, kLeast, std::int64_t{-1}}) {
    for (const std::int64_t host : {std::int64_t{1}, kLatest, kMost}) {
      ClockModel model(kPeriod_ns);
      for (int round = 0; round < 40; ++round) {
        for (const std::int64_t other : {sensor, std::int64_t{0}, kLatest, kMost, kLeast}) {
          for (int i = 0; i < 10; ++i) model.add(SensorTime{other}, HostTime{host});
          EXPECT_TRUE(model.to_host(SensorTime{other}).has_value());
          EXPECT_GE(model.status().sigma_ns, 0);
        }
      }
    }
  }
}

TEST(ClockModelTest, AnExactClockNearTheLatestTimeIsConvertedExactly) {
  constexpr std::int64_t kLatest = std::int64_t{1} << 62;
  ClockModel model(kPeriod_ns);
  for (std::int64_t i = 10'000; i > 0; --i) {
    model.add(SensorTime{kLatest - i * kPacketGap_ns}, HostTime{kLatest - i * kPacketGap_ns + 77});
  }
  EXPECT_EQ(model.to_host(SensorTime{kLatest})->ns, kLatest + 77);
  EXPECT_EQ(model.status().offset_ns, 77);
}

}  // namespace
}  // namespace glint
