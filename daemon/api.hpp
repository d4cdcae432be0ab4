// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <array>
#include <boost/asio/io_context.hpp>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "daemon/config.hpp"
#include "daemon/protocol.hpp"
#include "daemon/protocol_image.hpp"
#include "daemon/protocol_pose.hpp"
#include "daemon/protocol_status.hpp"
#include "daemon/runtime.hpp"
#include "daemon/saved_maps.hpp"

namespace glint::daemon {

class SensorLink;

/// The methods that any client may call and that concern no one else: requests in, lines out.
/// Lives on the main thread; what takes time, or looks at the disk, runs on the worker and comes
/// back by the io_context; what takes long is a job of the runtime.
class Api {
 public:
  /// Takes the line that answers a request. Called once, at once or later, on the main thread.
  using Reply = std::function<void(std::string line)>;

  Api(boost::asio::io_context& io, Runtime& runtime, const Config& config);

  /// Answers a request that has an id. @throws RpcError, then there is no other reply.
  void call(const Request& request, Reply reply);

  /// A step of a query on the worker: its fields, or null when it is to be called again, after the
  /// queries of others. May throw RpcError.
  using WorkerStep = std::function<std::optional<Json>()>;
  /// A notification that the worker makes.
  struct Notification {
    std::string method;
    Json params;      ///< What it has beside the fields of the step.
    WorkerStep step;  ///< No fields: there is nothing to tell.
  };
  /// `reply` takes its line, later; an empty one where there is nothing to tell, or too many
  /// queries wait.
  void make(Notification notification, Reply reply);
  /// The latest image for one who is told them: nothing where it is the one of `told`, the stamp of
  /// the last one, which it keeps.
  [[nodiscard]] WorkerStep next_image(const std::string& kind,
                                      std::shared_ptr<std::optional<SensorTime>> told);
  /// The map now; immutable.
  [[nodiscard]] std::shared_ptr<const slam::MapSnapshot> map() const {
    return runtime_.status().map->map;
  }

  /// The first line of a connection. `asks_token`: nothing but authenticate works before it.
  [[nodiscard]] std::string hello_line(bool asks_token) const;
  [[nodiscard]] Json status() const;
  /// The status for Prometheus, see metrics_text().
  [[nodiscard]] std::string metrics() const;
  /// Why the daemon is not well; empty when all of its threads live.
  [[nodiscard]] std::string health_problem() const;
  [[nodiscard]] Json pose(const Snapshot& snapshot, PoseFrames frames) const;
  /// The same as text, made once for all who are told it at the same time. Valid until the next
  /// call.
  const std::string& pose_text(const std::shared_ptr<const Snapshot>& snapshot, PoseFrames frames);
  /// sensor, state and time: what every answer has.
  [[nodiscard]] Json head() const;
  [[nodiscard]] const EventLog& events() const { return runtime_.events(); }
  [[nodiscard]] double scan_rate_hz() const { return runtime_.scan_rate_hz(); }
  /// The session with the sensor, for status; must outlive the calls.
  void set_sensor(const SensorLink& sensor) { sensor_ = &sensor; }
  /// Clients connected now, for status.
  void set_client_count(std::size_t count) { client_count_ = count; }
  /// What the server counts, for status; must outlive the calls.
  void set_server_counters(const ServerCounters& counters) { server_counters_ = &counters; }
  /// Old session files that were removed at start, for status.
  void set_sessions_removed(std::size_t count) { sessions_removed_ = count; }

 private:
  using Method = Json (Api::*)(const Json& params);
  static Method find_method(std::string_view name);
  using WorkerMethod = WorkerStep (Api::*)(const Json& params);
  static WorkerMethod find_worker_method(std::string_view name);
  /// A line that the worker makes, and who waits for it.
  struct WorkerCall {
    WorkerStep step;
    std::function<std::string(Json fields)> line;  ///< May throw RpcError.
    std::function<std::string(const RpcError& error)> refusal;
    Reply reply;
  };

  Json call_get_pose(const Json& params);
  Json call_get_status(const Json& params);
  Json call_get_metrics(const Json& params);
  Json call_get_trajectory(const Json& params);
  Json call_get_config(const Json& params);
  Json call_pause(const Json& params);
  Json call_resume(const Json& params);
  Json call_reset_odometry(const Json& params);
  Json call_save_map(const Json& params);
  Json call_load_map(const Json& params);
  Json call_clear_map(const Json& params);
  Json call_relocalize(const Json& params);
  Json call_set_initial_pose(const Json& params);
  Json search_place(PlaceSearchRequest request);
  void expect_a_map_to_search() const;
  Json change_map(const std::string& kind, SessionPlan plan);
  [[noreturn]] void refuse_job() const;
  WorkerStep call_get_map(const Json& params);
  WorkerStep call_get_image(const Json& params);
  WorkerStep call_list_maps(const Json& params);
  WorkerStep call_delete_map(const Json& params);
  Json post_command(Command command);
  Json start_job(const std::string& kind, JobBody body);
  void run_on_worker(const std::shared_ptr<WorkerCall>& call);
  static std::optional<std::string> take_step(const WorkerCall& call);
  void expect_a_place_for_maps() const;
  [[nodiscard]] PoseContext context() const;

  boost::asio::io_context& io_;
  Runtime& runtime_;
  const Config config_;
  const SensorLink* sensor_ = nullptr;  ///< Null: there is no session with the sensor.
  const std::string instance_;
  const std::int64_t start_ns_;
  const SavedMaps maps_;
  std::size_t client_count_ = 0;
  const ServerCounters* server_counters_ = nullptr;  ///< Null: there is no server.
  std::size_t sessions_removed_ = 0;
  ImageCache images_;  ///< The worker's.
  /// A pose as text, and of when it is.
  struct PoseText {
    std::shared_ptr<const Snapshot> snapshot;
    std::int64_t made_ns = 0;
    std::string text;
  };
  std::array<PoseText, 4> pose_texts_;  ///< By frames.
};

}  // namespace glint::daemon
