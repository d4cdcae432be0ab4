// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
//
// What Prometheus and supervisors are told, over HTTP and in the protocol.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <boost/asio/connect.hpp>
#include <boost/asio/read.hpp>
#include <boost/asio/write.hpp>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <numeric>
#include <regex>

#include "daemon/metrics_server.hpp"
#include "daemon/metrics_text.hpp"
#include "daemon/test_daemon.hpp"

namespace glint::daemon {
namespace {

using boost::asio::ip::tcp;
using test::TestDaemon;
using testing::HasSubstr;
using testing::StartsWith;

const std::string kScrapeToken = "scrape-0123456789";

std::string metrics_of(TestDaemon& daemon) {
  Client client(daemon.address());
  return client.call("get_metrics")["text"].get<std::string>();
}

/// The HTTP server beside a daemon of its own.
class MetricsServerTest : public testing::Test {
 protected:
  MetricsServerTest() : api_(io_, daemon_.runtime(), Config{}) {
    api_.set_server_counters(counters_);
  }
  void serve(const Config::Server& server = {}) {
    access_.emplace(server);
    metrics_.emplace(io_, api_, *access_, counters_, "127.0.0.1:0");
    metrics_->start();
  }
  /// Everything that comes back for the bytes of a request.
  std::string answer_to(const std::string& request) {
    boost::asio::io_context io;
    tcp::socket socket(io);
    socket.connect({boost::asio::ip::address_v4::loopback(), metrics_->port()});
    boost::asio::write(socket, boost::asio::buffer(request));
    socket.shutdown(tcp::socket::shutdown_send);
    std::string answer;
    bool over = false;
    boost::asio::async_read(socket, boost::asio::dynamic_buffer(answer),
                            [&](auto, std::size_t) { over = true; });
    while (!over) {
      io_.run_for(std::chrono::milliseconds(10));
      io_.restart();
      io.poll();
      io.restart();
    }
    return answer;
  }
  std::string get(const std::string& path, const std::string& header = "") {
    return answer_to(fmt::format("GET {} HTTP/1.1\r\nHost: x\r\n{}\r\n", path, header));
  }

  TestDaemon daemon_;
  boost::asio::io_context io_;
  ServerCounters counters_;
  Api api_;
  std::optional<Access> access_;
  std::optional<MetricsServer> metrics_;
};

TEST_F(MetricsServerTest, MetricsAreServedAsText) {
  serve();
  const std::string answer = get("/metrics");
  EXPECT_THAT(answer, StartsWith("HTTP/1.1 200 OK\r\n"));
  EXPECT_THAT(answer, HasSubstr("Content-Type: text/plain; version=0.0.4; charset=utf-8\r\n"));
  EXPECT_THAT(answer, HasSubstr("\nglint_state{state=\"INIT\"} 1\n"));
  EXPECT_THAT(answer, HasSubstr("\nglint_server_scrapes_total 1\n"));
}

TEST_F(MetricsServerTest, ADaemonWithoutAPoseIsHealthyAndNotReady) {
  serve();
  EXPECT_THAT(get("/healthz"), testing::AllOf(StartsWith("HTTP/1.1 200"), HasSubstr("\r\n\r\nok")));
  EXPECT_THAT(get("/readyz"), testing::AllOf(StartsWith("HTTP/1.1 503"), HasSubstr("INIT")));
}

TEST_F(MetricsServerTest, ADaemonThatTracksIsReady) {
  serve();
  daemon_.feed(test::room_packets(daemon_.info(), 5));
  EXPECT_TRUE(daemon_.wait_for("get_status", [](const Json& s) {
    return s["counters"]["poses"] > 2 && s["state"] != "INIT";
  }));
  EXPECT_THAT(get("/readyz"), StartsWith("HTTP/1.1 200"));
}

TEST_F(MetricsServerTest, OtherPathsMethodsAndProtocolsAreRefused) {
  serve();
  EXPECT_THAT(get("/"), StartsWith("HTTP/1.1 404"));
  EXPECT_THAT(get("/../etc/passwd"), StartsWith("HTTP/1.1 404"));
  EXPECT_THAT(answer_to("DELETE /metrics HTTP/1.1\r\nHost: x\r\n\r\n"), StartsWith("HTTP/1.1 405"));
  EXPECT_THAT(answer_to("HEAD /metrics HTTP/1.1\r\nHost: x\r\n\r\n"),
              testing::AllOf(StartsWith("HTTP/1.1 200"), testing::EndsWith("\r\n\r\n")));
  EXPECT_EQ(answer_to("{\"id\":1}\n"), "");
  EXPECT_EQ(get("/metrics", "X: " + std::string(10'000, 'x') + "\r\n"), "");
  EXPECT_EQ(counters_.refused_scrapes, 2U);
}

TEST_F(MetricsServerTest, WhereATokenIsAskedMetricsNeedIt) {
  const auto file =
      std::filesystem::path(testing::TempDir()) / ("scrape_token_" + std::to_string(getpid()));
  std::ofstream(file) << kScrapeToken;
  Config::Server server;
  server.read_token_file = file;
  server.require_token = true;
  serve(server);
  EXPECT_THAT(get("/metrics"), StartsWith("HTTP/1.1 401"));
  EXPECT_THAT(get("/metrics", "Authorization: Bearer wrong\r\n"), StartsWith("HTTP/1.1 401"));
  EXPECT_THAT(get("/metrics", "Authorization: Bearer " + kScrapeToken + "\r\n"),
              StartsWith("HTTP/1.1 200"));
  EXPECT_THAT(get("/healthz"), StartsWith("HTTP/1.1 200"));
  std::filesystem::remove(file);
}

TEST_F(MetricsServerTest, AnAddressThatOthersReachNeedsAToken) {
  const Access access{Config::Server{}};
  EXPECT_THROW(MetricsServer(io_, api_, access, counters_, "0.0.0.0:0"), ConfigError);
  EXPECT_THROW(MetricsServer(io_, api_, access, counters_, "7789"), ConfigError);
}

TEST(MetricsTextTest, EveryCounterOfTheStatusIsThere) {
  TestDaemon daemon;
  daemon.feed(test::room_packets(daemon.info(), 3));
  EXPECT_TRUE(daemon.wait_for("get_status", [](const Json& s) { return test::has_poses(s, 3); }));
  const std::string text = metrics_of(daemon);
  Client client(daemon.address());
  const Json status = client.call("get_status");
  for (const auto& [name, value] : status["counters"].items()) {
    const char* total = name.starts_with("loops_") ? "" : "_total";
    EXPECT_THAT(text, HasSubstr(fmt::format("\nglint_{}{} {}\n", name, total, value.dump())));
  }
  EXPECT_THAT(text, HasSubstr("\nglint_stage_duration_seconds_bucket{stage=\"total\",le=\"+Inf\"} "
                              "3\n"));
  EXPECT_THAT(text, HasSubstr("\nglint_stage_duration_seconds_count{stage=\"total\"} 3\n"));
}

TEST(MetricsTextTest, BucketsCountWhatIsNotLonger) {
  DurationStats stats;
  for (const std::int64_t ns : {50'000, 100'000, 100'001, 2'000'000'000}) stats.add(ns);
  EXPECT_EQ(stats.buckets[0], 2U);
  EXPECT_EQ(stats.buckets[1], 1U);
  EXPECT_EQ(std::accumulate(stats.buckets.begin(), stats.buckets.end(), std::uint64_t{0}), 3U);
}

TEST(MetricsTextTest, TheDashboardAsksForWhatThereIs) {
  TestDaemon daemon;
  daemon.feed(test::room_packets(daemon.info(), 3));
  EXPECT_TRUE(daemon.wait_for("get_status", [](const Json& s) { return test::has_poses(s, 3); }));
  const std::string text = metrics_of(daemon);
  std::ifstream in(std::filesystem::path(GLINT_SOURCE_DIR) / "config" / "grafana-dashboard.json");
  const Json dashboard = Json::parse(in);
  int found = 0;
  for (const Json& panel : dashboard["panels"]) {
    for (const Json& target : panel["targets"]) {
      const auto query = target["expr"].get<std::string>();
      const std::regex name("glint_[a-z_]+");
      for (std::sregex_iterator i(query.begin(), query.end(), name), end; i != end; ++i, ++found) {
        const auto line = fmt::format("\n{}", i->str());
        EXPECT_TRUE(text.find(line + ' ') != std::string::npos ||
                    text.find(line + '{') != std::string::npos)
            << i->str();
      }
    }
  }
  EXPECT_GT(found, 20);
}

TEST(MetricsTextTest, PrometheusOwnCheckerHasNothingToSay) {
  if (std::system("command -v promtool >/dev/null") != 0) GTEST_SKIP() << "no promtool here";
  TestDaemon daemon;
  daemon.feed(test::room_packets(daemon.info(), 3));
  EXPECT_TRUE(daemon.wait_for("get_status", [](const Json& s) { return test::has_poses(s, 3); }));
  const auto file =
      std::filesystem::path(testing::TempDir()) / ("metrics_" + std::to_string(getpid()));
  std::ofstream(file) << metrics_of(daemon);
  const std::string command = "promtool check metrics < " + file.string();
  EXPECT_EQ(std::system(command.c_str()), 0);
  std::filesystem::remove(file);
}

}  // namespace
}  // namespace glint::daemon
