// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "daemon/cli/job_waiting.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <iostream>
#include <optional>
#include <stdexcept>

namespace glint::cli {
namespace {

using daemon::Json;

/// The status comes once a second: silence for so long is a daemon that hangs.
constexpr std::chrono::seconds kSilence{10};

/// What a notification says of the job; null when it says nothing.
std::optional<Json> news_of(std::uint64_t id, const Json& message) {
  if (!message.contains("params")) return std::nullopt;
  const Json& params = message["params"];
  if (params.contains("job") && params["job"]["id"] == id) return params["job"];
  for (const Json& job : params.value("jobs", Json::array())) {
    if (job["id"] == id) return job;
  }
  return std::nullopt;
}

/// The job as it ended. Events tell its way; the status does, too, were events missed.
Json wait_for_end(daemon::Client& client, Json job, bool show_progress) {
  const auto id = job["id"].get<std::uint64_t>();
  while (job["state"] == "running") {
    const auto news = news_of(id, client.next_message(kSilence));
    if (!news) continue;
    job = *news;
    if (show_progress) fmt::print(stderr, "\r{:3.0f} %", 100.0 * job["progress"].get<double>());
  }
  if (show_progress) fmt::print(stderr, "\r     \r");
  return job;
}

}  // namespace

Json run_job(daemon::Client& client, const ClientOptions& options, const std::string& method,
             const Json& params, const std::string& failure) {
  client.call("subscribe", {{"topics", {"events", "status"}}});
  const Json reply = client.call(method, params);
  const bool show_progress = !options.json && isatty(STDERR_FILENO) != 0;
  Json job = wait_for_end(client, reply.at("job"), show_progress);
  if (options.json) std::cout << job.dump() << '\n';
  if (job["state"] != "done") {
    throw std::runtime_error(
        fmt::format("{}: {}", failure, job.value("error", job["state"].dump())));
  }
  return job;
}

}  // namespace glint::cli
