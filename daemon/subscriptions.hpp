// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "daemon/api.hpp"
#include "daemon/protocol_pose.hpp"
#include "daemon/server_counters.hpp"
#include "daemon/snapshot.hpp"
#include "daemon/told_by_worker.hpp"

namespace glint::daemon {

/// What one client is subscribed to, and the notifications that wait for it. A few may wait so that
/// a client that is a moment late misses nothing; beyond that the oldest goes, and the client is
/// told how many it missed. Lives on the main thread.
class Subscriptions {
 public:
  /// `counters` takes what is missed. `on_line`: called when next_line() has one that did not come
  /// by offer() or tick().
  Subscriptions(Api& api, ServerCounters& counters, std::function<void()> on_line)
      : api_(api), counters_(counters), on_line_(std::move(on_line)) {}

  /// subscribe and unsubscribe; the result is the echo of what is now in effect. @throws RpcError.
  Json subscribe(const Json& params);
  Json unsubscribe(const Json& params);
  [[nodiscard]] bool empty() const { return !pose_ && !status_ && !events_ && !map_ && !image_; }

  /// A new pose is there.
  void offer(const std::shared_ptr<const Snapshot>& snapshot);
  /// Time passes: notifications of other topics may be due.
  void tick(std::int64_t now_ns);

  /// The next line to send, made only now so that its `missed` is true; null when none waits.
  std::optional<std::string> next_line();

 private:
  struct WaitingPose {
    std::uint64_t seq;
    std::shared_ptr<const Snapshot> snapshot;
  };
  struct PoseTopic {
    PoseFrames frames;
    double rate_hz = 0.0;          ///< Effective.
    std::int64_t period_ns = 0;    ///< 0: every scan.
    std::int64_t next_due_ns = 0;  ///< Sensor time.
    std::uint64_t seq = 0;
    std::uint64_t missed = 0;
    std::deque<WaitingPose> waiting;
  };
  struct StatusTopic {
    double rate_hz = 0.0;
    std::int64_t period_ns = 0;
    std::int64_t next_due_ns = 0;  ///< Steady clock.
    std::uint64_t seq = 0;
    std::uint64_t missed = 0;
    bool waiting = false;
  };

  struct EventTopic {
    std::uint64_t begin = 0;  ///< Number of the first event of the subscription; what waits stays
    std::uint64_t next = 0;   ///< in the log, from number `next` on.
    std::uint64_t missed = 0;
  };

  [[nodiscard]] Json echo() const;
  std::optional<std::string> next_pose();
  std::optional<std::string> next_status();
  std::optional<std::string> next_event();

  Api& api_;
  ServerCounters& counters_;
  const std::function<void()> on_line_;
  std::optional<PoseTopic> pose_;
  std::optional<StatusTopic> status_;
  std::optional<EventTopic> events_;
  std::unique_ptr<ToldByWorker> map_;
  std::unique_ptr<ToldByWorker> image_;
};

}  // namespace glint::daemon
