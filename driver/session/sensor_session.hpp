// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "driver/core/time.hpp"
#include "driver/session/config_plan.hpp"
#include "driver/session/firmware_version.hpp"
#include "driver/session/sensor_client.hpp"
#include "driver/session/session_status.hpp"
#include "driver/session/wanted_config.hpp"

namespace glint {

/// The session's waits, ns.
struct SessionTimes {
  std::int64_t first_retry_ns = kNsPerSecond / 2;  ///< Doubles with each failure.
  std::int64_t longest_retry_ns = 10 * kNsPerSecond;
  std::int64_t initialising_poll_ns = kNsPerSecond / 2;
  /// A reinitialise takes some 20 s, a start from cold a minute.
  std::int64_t initialising_limit_ns = 90 * kNsPerSecond;
  std::int64_t first_packet_limit_ns = 10 * kNsPerSecond;
  std::int64_t stall_ns = 300'000'000;  ///< Silence that is a stall: three scans at 10 Hz.
  std::int64_t reconfigure_ns = 10 * kNsPerSecond;  ///< Stall after which all is done anew.
  std::int64_t health_period_ns = 5 * kNsPerSecond;
  std::int64_t packet_look_ns = 100'000'000;  ///< How often arrivals are looked at.
};

struct SessionOptions {
  std::string host;                    ///< For messages.
  std::optional<WantedConfig> wanted;  ///< Null: the sensor is left as it is.
  bool persist = false;                ///< Keep what is written in the sensor's flash.
  SessionTimes times;
};

/// What has arrived over UDP, as the session's caller knows it. Value type.
struct PacketActivity {
  std::int64_t last_packet_ns = 0;  ///< On the clock of step(); 0: none yet.
  std::uint32_t init_id = 0;        ///< Of that packet; 0: its format has none.
};

/// What the session tells its caller, from within step(). Empty functions are not called.
struct SessionListener {
  /// The sensor's metadata after each configuration: it may differ from the last.
  std::function<void(const std::string& metadata_json)> on_metadata;
  /// A change of state or a failure, as one sentence for the log.
  std::function<void(SessionState state, const std::string& sentence)> on_news;
};

/// Brings a sensor to send what is wanted and keeps it doing so: DISCOVERING -> CONFIGURING ->
/// WAITING_DATA -> RUNNING -> STALLED. Starts before the sensor has power, never gives up, writes
/// only settings that differ and writes all anew when the sensor has restarted.
/// Has no thread and reads no clock: step() does what is due. Thread-compatible.
class SensorSession {
 public:
  /// `client` must outlive the session; `activity` is asked in step().
  /// @throws InputError for settings that no sensor takes.
  SensorSession(SensorClient& client, SessionOptions options,
                std::function<PacketActivity()> activity, SessionListener listener);
  ~SensorSession();
  SensorSession(const SensorSession&) = delete;
  SensorSession& operator=(const SensorSession&) = delete;

  /// Does what is due at `now_ns` (monotonic). Returns when to call again at the latest; earlier is
  /// harmless.
  std::int64_t step(std::int64_t now_ns);
  /// Called when the client has answered, from within its handler: step() has something to do.
  void set_wake(std::function<void()> wake) { wake_ = std::move(wake); }

  /// Silence that is a stall from here on: it depends on the sensor's rate.
  void set_stall_ns(std::int64_t stall_ns) { stall_ns_ = stall_ns; }

  [[nodiscard]] const SessionStatus& status() const { return status_; }

 private:
  /// The next question to the sensor.
  enum class Task {
    kIdentify,
    kReadConfig,
    kWriteConfig,
    kAwaitReady,
    kReadMetadata,
    kCheckRestart,
    kAlerts,
    kTelemetry,
    kPtp,
    kTime,
  };

  void ask();
  void take(const SensorReply& reply);
  void take_identity(const SensorReply& reply);
  void take_config(const SensorReply& reply);
  void take_written(const SensorReply& reply);
  void take_readiness(const SensorReply& reply);
  void take_metadata(const SensorReply& reply);
  void take_restart_check(const SensorReply& reply);
  void take_health(const SensorReply& reply);

  void watch_packets();
  void watch_flow(std::int64_t last_packet_ns);
  void watch_silence(std::int64_t last_packet_ns);
  void watch_init_id(std::uint32_t packet_init_id);
  /// Forgets how far things had come; the sensor is asked who it is after so long.
  void start_over(std::int64_t after_ns);
  void fail(const std::string& sentence);
  void enter(SessionState state, const std::string& sentence);
  void set_state(SessionState state);
  void next(Task task, std::int64_t after_ns = 0);
  void drop_question();
  void note_identity(const nlohmann::json& info);
  [[nodiscard]] bool initialising() const;
  [[nodiscard]] bool expects_packets() const;

  SensorClient& client_;
  const SessionOptions options_;
  const std::function<PacketActivity()> activity_;
  const SessionListener listener_;
  std::function<void()> wake_;

  SessionStatus status_;
  SessionState failed_in_ = SessionState::kDiscovering;
  std::int64_t now_ns_ = 0;
  std::int64_t retry_ns_;
  std::int64_t stall_ns_;

  Task task_ = Task::kIdentify;
  std::int64_t due_ns_ = 0;
  bool asked_ = false;
  std::uint64_t question_ = 0;
  std::shared_ptr<std::optional<SensorReply>> reply_;  ///< Also held by the handler under way.

  FirmwareVersion firmware_;
  nlohmann::json active_config_;
  std::string local_address_;
  ConfigPlan plan_;
  bool answers_ = true;                       ///< To the last look at it.
  bool written_ = false;                      ///< Since the last start over.
  std::int64_t initialising_since_ns_ = -1;   ///< -1: it is not.
  std::uint32_t checked_packet_init_id_ = 0;  ///< Already compared with the sensor's own.
};

}  // namespace glint
