// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstdint>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "driver/core/clock.hpp"
#include "driver/emulator/emulated_config.hpp"
#include "driver/session/api_form.hpp"

namespace glint::emulator {

struct EmulatedSensorOptions {
  std::string metadata_json;      ///< What it says of itself, in either form.
  std::string firmware;           ///< "v3.1.0"; decides its interface. Empty: that of the metadata.
  nlohmann::json config_changes;  ///< To the metadata's settings; keys as of firmware 2 and later.
  std::int64_t reinitialise_ns = 1'000'000'000;
  std::int64_t boot_ns = 2'000'000'000;
  std::uint32_t first_init_id = 0x5EED01;  ///< Each start has the next.
  /// Its PTP master's clock less the monotonic clock; TAI if the master is a good one.
  std::int64_t ptp_minus_monotonic_ns = 0;
};

/// What the sensor sends over UDP just now. Value type.
struct EmulatedStream {
  bool sending = false;  ///< False while it is off, initialises, or is in standby.
  std::string destination;
  int lidar_port = 0;
  int imu_port = 0;
  std::uint32_t init_id = 0;
  std::string timestamp_mode;
  std::int64_t clock_zero_ns = 0;    ///< Monotonic time at which its clock began, at 0.
  std::int64_t clock_offset_ns = 0;  ///< Sum of the clock's jumps.

  /// What its clock shows.
  [[nodiscard]] std::int64_t sensor_time_ns(std::int64_t monotonic_ns) const {
    return monotonic_ns - clock_zero_ns + clock_offset_ns;
  }

  friend bool operator==(const EmulatedStream&, const EmulatedStream&) = default;
};

/// What was done to the sensor.
struct EmulatorCounts {
  std::uint64_t requests = 0;
  std::uint64_t config_writes = 0;  ///< Requests that set something.
  std::uint64_t reinitialises = 0;
  std::uint64_t flash_writes = 0;
  std::uint64_t starts = 0;  ///< Of its power.
};

/// One HTTP request, as far as the sensor cares.
struct EmulatedRequest {
  std::string method;
  std::string target;  ///< Path and query.
  std::string body;
  std::string client_address;  ///< What "@auto" means.
};

struct EmulatedAnswer {
  int status = 200;
  std::string body;
};

/// The control side of a sensor without its network: settings, status, alerts, and answers to
/// requests. Needs update() when something is due, else it acts in its calls. Thread-compatible.
class EmulatedSensor {
 public:
  /// `on_stream` is called when what is sent changes, also from within other calls.
  /// @throws MetadataError, InputError when the metadata or the firmware cannot be used.
  EmulatedSensor(EmulatedSensorOptions options, Clock clock,
                 std::function<void(const EmulatedStream&)> on_stream);

  EmulatedAnswer answer(const EmulatedRequest& request);
  /// One line of the TCP port to its answer, both without the newline.
  std::string answer_line(std::string_view line, const std::string& client_address);

  void power_off();
  /// Boots with the settings in flash; also from on (a restart).
  void power_on();
  /// `category` as sensors name it, e.g. "OVERTEMP".
  void raise_alert(const std::string& id, const std::string& category, const std::string& message);
  void clear_alerts();
  void jump_clock(std::int64_t offset_ns);

  /// Tells of a stream that has begun by now. Returns when to call again; null when nothing is due.
  std::optional<std::int64_t> update();
  [[nodiscard]] EmulatedStream stream() const;
  [[nodiscard]] const EmulatorCounts& counts() const { return counts_; }
  [[nodiscard]] const EmulatedConfig& config() const { return config_; }
  [[nodiscard]] ApiForm form() const { return form_; }
  [[nodiscard]] std::string status() const;

 private:
  struct Query;
  EmulatedAnswer answer_sensor(const EmulatedRequest& request, const Query& query);
  EmulatedAnswer answer_config(const EmulatedRequest& request, const Query& query);
  EmulatedAnswer post_config(const nlohmann::json& changes, const Query& query);
  EmulatedAnswer answer_command(const Query& query, const std::string& client_address);
  EmulatedAnswer answer_time(std::string_view what) const;
  /// A command of the old interface: its answer as JSON, an echo as a string.
  /// @throws InputError with the sensor's complaint.
  nlohmann::json run_command(const std::vector<std::string>& words, const std::string& client);
  void set_param(const std::vector<std::string>& words);
  void reinitialise();
  void save_flash(const nlohmann::json& changes);
  void start(std::int64_t duration_ns);
  [[nodiscard]] bool initialising() const;
  [[nodiscard]] std::int64_t sensor_time_ns() const;
  [[nodiscard]] nlohmann::json sensor_info() const;
  [[nodiscard]] nlohmann::json metadata() const;
  [[nodiscard]] nlohmann::json alerts() const;
  [[nodiscard]] nlohmann::json sensor_time() const;

  const EmulatedSensorOptions options_;
  const Clock clock_;
  const std::function<void(const EmulatedStream&)> on_stream_;
  nlohmann::json base_metadata_;
  std::string firmware_;
  ApiForm form_;
  EmulatedConfig config_;
  EmulatorCounts counts_;
  EmulatedStream told_;
  nlohmann::json active_alerts_ = nlohmann::json::array();
  nlohmann::json alert_log_ = nlohmann::json::array();
  bool powered_ = true;
  std::int64_t ready_at_ns_ = 0;
  std::uint32_t init_id_;
  std::int64_t powered_at_ns_;
  std::int64_t clock_offset_ns_ = 0;
};

}  // namespace glint::emulator
