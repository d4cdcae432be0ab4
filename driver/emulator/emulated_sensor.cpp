// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "driver/emulator/emulated_sensor.hpp"

#include <fmt/format.h>

#include <utility>

#include "driver/core/error.hpp"
#include "driver/core/sensor_info.hpp"
#include "driver/core/time.hpp"
#include "driver/session/sensor_json.hpp"

namespace glint::emulator {
namespace {

using nlohmann::json;

/// Metadata in its grouped form, with other settings.
json grouped(const EmulatedSensorOptions& options) {
  const std::string& text = options.metadata_json;
  const SensorInfo info = parse_sensor_info(text, "of the emulated sensor");
  json root = json::parse(text);
  if (!member(root, "sensor_info").is_object()) root = json::parse(to_metadata_json(info));
  if (!options.config_changes.is_object()) return root;
  json& config = root["config_params"];
  if (!config.is_object()) config = json::object();
  config.update(options.config_changes);
  return root;
}

std::string firmware_of(const EmulatedSensorOptions& options, const json& metadata) {
  std::string firmware = options.firmware;
  if (firmware.empty()) firmware = text_member(metadata["sensor_info"], "build_rev");
  if (parse_firmware_version(firmware)) return firmware;
  throw InputError(fmt::format(
      "the emulated sensor's firmware '{}' is no version; write e.g. v3.1.0", firmware));
}

}  // namespace

EmulatedSensor::EmulatedSensor(EmulatedSensorOptions options, Clock clock,
                               std::function<void(const EmulatedStream&)> on_stream)
    : options_(std::move(options)),
      clock_(clock),
      on_stream_(std::move(on_stream)),
      base_metadata_(grouped(options_)),
      firmware_(firmware_of(options_, base_metadata_)),
      form_(api_form(*parse_firmware_version(firmware_))),
      config_(*parse_firmware_version(firmware_), member(base_metadata_, "config_params")),
      init_id_(options_.first_init_id),
      powered_at_ns_(clock_.monotonic_ns()) {}

void EmulatedSensor::power_off() {
  powered_ = false;
  update();
}

void EmulatedSensor::power_on() {
  powered_ = true;
  ++counts_.starts;
  config_.restore_persisted();
  clear_alerts();
  clock_offset_ns_ = 0;
  powered_at_ns_ = clock_.monotonic_ns();
  start(options_.boot_ns);
}

void EmulatedSensor::raise_alert(const std::string& id, const std::string& category,
                                 const std::string& message) {
  json alert = {
      {"id", id},       {"category", category},   {"level", "WARNING"},         {"active", true},
      {"msg", message}, {"msg_verbose", message}, {"cursor", alert_log_.size()}};
  alert["realtime"] = std::to_string(clock_.monotonic_ns());
  active_alerts_.push_back(alert);
  alert_log_.push_back(std::move(alert));
}

void EmulatedSensor::clear_alerts() { active_alerts_ = json::array(); }

void EmulatedSensor::jump_clock(std::int64_t offset_ns) {
  clock_offset_ns_ += offset_ns;
  update();
}

std::optional<std::int64_t> EmulatedSensor::update() {
  const EmulatedStream now = stream();
  if (now != told_) {
    told_ = now;
    if (on_stream_) on_stream_(now);
  }
  return initialising() ? std::optional(ready_at_ns_) : std::nullopt;
}

EmulatedStream EmulatedSensor::stream() const {
  const json& active = config_.active();
  EmulatedStream stream;
  stream.destination = text_member(active, config_.destination_key());
  stream.sending = status() == "RUNNING" && !stream.destination.empty();
  stream.lidar_port = active.value("udp_port_lidar", 0);
  stream.imu_port = active.value("udp_port_imu", 0);
  stream.init_id = init_id_;
  stream.timestamp_mode = text_member(active, "timestamp_mode");
  const bool ptp = stream.timestamp_mode == "TIME_FROM_PTP_1588";
  stream.clock_zero_ns = ptp ? -options_.ptp_minus_monotonic_ns : powered_at_ns_;
  stream.clock_offset_ns = clock_offset_ns_;
  return stream;
}

std::string EmulatedSensor::status() const {
  if (!powered_) return "OFF";
  if (initialising()) return "INITIALIZING";
  return config_.is_standby() ? "STANDBY" : "RUNNING";
}

bool EmulatedSensor::initialising() const {
  return powered_ && clock_.monotonic_ns() < ready_at_ns_;
}

void EmulatedSensor::reinitialise() {
  ++counts_.reinitialises;
  start(options_.reinitialise_ns);
}

void EmulatedSensor::save_flash(const json& changes) {
  ++counts_.flash_writes;
  config_.persist(changes);
}

void EmulatedSensor::start(std::int64_t duration_ns) {
  ready_at_ns_ = clock_.monotonic_ns() + duration_ns;
  constexpr std::uint32_t kLargest = 0xFFFFFF;  // 24 bits in the packets; 0 would mean none.
  init_id_ = init_id_ >= kLargest ? 1 : init_id_ + 1;
  update();
}

json EmulatedSensor::sensor_info() const {
  json info = base_metadata_["sensor_info"];
  info["build_rev"] = firmware_;
  info["image_rev"] = "ousteros-image-prod-emulated-" + firmware_;
  info["status"] = status();
  // Firmware 1 has none.
  if (form_ != ApiForm::kTcp) info["initialization_id"] = init_id_;
  return info;
}

json EmulatedSensor::metadata() const {
  json metadata = base_metadata_;
  metadata["sensor_info"] = sensor_info();
  metadata["config_params"] = config_.active();
  return metadata;
}

json EmulatedSensor::alerts() const {
  return {{"active", active_alerts_}, {"log", alert_log_}, {"next_cursor", alert_log_.size()}};
}

std::int64_t EmulatedSensor::sensor_time_ns() const {
  return stream().sensor_time_ns(clock_.monotonic_ns());
}

json EmulatedSensor::sensor_time() const {
  return {{"timestamp",
           {{"mode", config_.active().value("timestamp_mode", "")},
            {"time", static_cast<double>(sensor_time_ns()) * kSecondsPerNs}}},
          {"sync_pulse_in", {{"locked", 0}}}};
}

}  // namespace glint::emulator
