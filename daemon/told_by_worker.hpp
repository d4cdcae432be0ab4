// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "daemon/api.hpp"
#include "daemon/protocol_map.hpp"

namespace glint::daemon {

/// A topic that somebody is subscribed to and whose notifications the worker makes: images, and
/// what has changed of the map. One at a time: the next is made when the client has taken the last,
/// so that a slow one costs no more than it takes. Lives on the main thread.
class ToldByWorker {
 public:
  /// `on_line`: called when a line has come that waits to be taken.
  ToldByWorker(Api& api, std::string topic, double rate_hz, std::function<void()> on_line);
  virtual ~ToldByWorker() = default;
  ToldByWorker(const ToldByWorker&) = delete;
  ToldByWorker& operator=(const ToldByWorker&) = delete;

  /// What is in effect, for the echo.
  [[nodiscard]] virtual Json settings() const = 0;
  /// Time passes (steady clock): another notification may be due. True where it is missed.
  bool tick(std::int64_t now_ns);
  /// The line that waits, if any.
  std::optional<std::string> take_line();

 protected:
  /// Whether there may be something to tell.
  [[nodiscard]] virtual bool has_news() const = 0;
  /// Whether more is to follow without waiting for the next time.
  [[nodiscard]] virtual bool goes_on() const { return false; }
  /// What tells it, on the worker.
  virtual Api::WorkerStep next_step() = 0;

  [[nodiscard]] Api& api() const { return api_; }
  [[nodiscard]] double rate_hz() const { return rate_hz_; }

 private:
  void ask();

  Api& api_;
  const std::string topic_;
  const double rate_hz_;
  const std::int64_t period_ns_;
  const std::function<void()> on_line_;
  std::int64_t next_due_ns_ = 0;
  std::uint64_t seq_ = 0;
  std::uint64_t missed_ = 0;
  bool asked_ = false;  ///< The worker is at it.
  std::string line_;    ///< Waits to be taken; empty: none does.
  /// Who answers after this is gone finds nobody.
  const std::shared_ptr<ToldByWorker*> self_ = std::make_shared<ToldByWorker*>(this);
};

/// The latest image of a kind, at most five times a second.
std::unique_ptr<ToldByWorker> tell_images(Api& api, const Json& params, double rate_hz,
                                          std::function<void()> on_line);
/// What has changed of the map since the client was told last, in pages as of get_map, at most
/// twice a second. Where the points moved or the map is another one, all of it is told `anew`.
std::unique_ptr<ToldByWorker> tell_map(Api& api, const Json& params, double rate_hz,
                                       std::function<void()> on_line);

}  // namespace glint::daemon
