// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "driver/session/sensor_session.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "driver/session/sensor_json.hpp"
#include "driver/session/silence.hpp"

namespace glint {

using nlohmann::json;

SensorSession::SensorSession(SensorClient& client, SessionOptions options,
                             std::function<PacketActivity()> activity, SessionListener listener)
    : client_(client),
      options_(std::move(options)),
      activity_(std::move(activity)),
      listener_(std::move(listener)),
      retry_ns_(options_.times.first_retry_ns),
      stall_ns_(options_.times.stall_ns) {
  if (options_.wanted) check(*options_.wanted);
  status_.host = options_.host;
}

SensorSession::~SensorSession() {
  wake_ = nullptr;
  client_.cancel();
}

std::int64_t SensorSession::step(std::int64_t now_ns) {
  now_ns_ = now_ns;
  if (status_.state_since_ns == 0) status_.state_since_ns = now_ns;
  if (expects_packets()) watch_packets();
  while (true) {
    if (asked_ && reply_->has_value()) {
      asked_ = false;
      const SensorReply reply = std::move(**reply_);
      take(reply);
    } else if (!asked_ && now_ns_ >= due_ns_) {
      ask();
    } else {
      break;
    }
  }
  const std::int64_t look_ns = now_ns_ + options_.times.packet_look_ns;
  if (expects_packets()) return asked_ ? look_ns : std::min(look_ns, due_ns_);
  return asked_ ? now_ns_ + kNsPerSecond : due_ns_;
}

void SensorSession::ask() {
  asked_ = true;
  reply_ = std::make_shared<std::optional<SensorReply>>();
  // The handler may outlive its question, and the session: it owns where its answer goes.
  const auto handler = [this, reply = std::weak_ptr(reply_)](SensorReply answer) {
    const auto place = reply.lock();
    if (!place) return;
    *place = std::move(answer);
    if (wake_) wake_();
  };
  switch (task_) {
    case Task::kIdentify:
    case Task::kAwaitReady:
    case Task::kCheckRestart:
      return client_.read(SensorResource::kSensorInfo, handler);
    case Task::kReadConfig:
      return client_.read(SensorResource::kActiveConfig, handler);
    case Task::kWriteConfig:
      return client_.write_config(plan_.changes, options_.persist, handler);
    case Task::kReadMetadata:
      return client_.read(SensorResource::kMetadata, handler);
    case Task::kAlerts:
      return client_.read(SensorResource::kAlerts, handler);
    case Task::kTelemetry:
      return client_.read(SensorResource::kTelemetry, handler);
    case Task::kPtp:
      return client_.read(SensorResource::kPtp, handler);
    case Task::kTime:
      return client_.read(SensorResource::kTime, handler);
  }
}

void SensorSession::take(const SensorReply& reply) {
  switch (task_) {
    case Task::kIdentify:
      return take_identity(reply);
    case Task::kReadConfig:
      return take_config(reply);
    case Task::kWriteConfig:
      return take_written(reply);
    case Task::kAwaitReady:
      return take_readiness(reply);
    case Task::kReadMetadata:
      return take_metadata(reply);
    case Task::kCheckRestart:
      return take_restart_check(reply);
    case Task::kAlerts:
    case Task::kTelemetry:
    case Task::kPtp:
    case Task::kTime:
      return take_health(reply);
  }
}

void SensorSession::take_identity(const SensorReply& reply) {
  if (!reply.failure.empty()) return fail(reply.failure);
  note_identity(reply.value);
  if (initialising()) {
    if (initialising_since_ns_ < 0) initialising_since_ns_ = now_ns_;
    if (now_ns_ - initialising_since_ns_ > options_.times.initialising_limit_ns) {
      initialising_since_ns_ = -1;
      return fail(fmt::format("{} stays {}; look at its alerts, then restart it", status_.host,
                              status_.sensor_status));
    }
    return next(Task::kIdentify, options_.times.initialising_poll_ns);
  }
  initialising_since_ns_ = -1;
  enter(SessionState::kConfiguring,
        fmt::format("{} is {} {} with firmware {}", status_.host, status_.product_line,
                    status_.serial_number, status_.firmware));
  next(Task::kReadConfig);
}

void SensorSession::take_config(const SensorReply& reply) {
  if (!reply.failure.empty()) return fail(reply.failure);
  if (!reply.value.is_object()) {
    return fail(
        fmt::format("{} does not say its settings; if it stays so, restart it", status_.host));
  }
  active_config_ = reply.value;
  local_address_ = reply.local_address;
  status_.address = reply.sensor_address;
  const bool renamed = !active_config_.contains("udp_dest");
  status_.udp_dest = excerpt(text_member(active_config_, renamed ? "udp_ip" : "udp_dest"), 60);
  const json wanted =
      options_.wanted ? to_sensor_json(*options_.wanted, firmware_) : json::object();
  ConfigPlan plan = plan_changes(wanted, active_config_, local_address_);
  if (plan.changes.empty() || written_) {
    // Written once is enough: what it does not take now it will not take next time either, and
    // each attempt costs a reinitialise.
    status_.unmet = std::move(plan.lines);
    return next(Task::kReadMetadata);
  }
  plan_ = std::move(plan);
  next(Task::kWriteConfig);
}

void SensorSession::take_written(const SensorReply& reply) {
  if (!reply.failure.empty()) return fail(reply.failure);
  written_ = true;
  ++status_.config_writes;
  status_.last_changes = plan_.lines;
  enter(SessionState::kConfiguring,
        fmt::format("{} reinitialises with {}", status_.host, fmt::join(plan_.lines, ", ")));
  initialising_since_ns_ = now_ns_;
  next(Task::kAwaitReady, options_.times.initialising_poll_ns);
}

void SensorSession::take_readiness(const SensorReply& reply) {
  // Its server may go away while it reinitialises.
  if (reply.failure.empty()) note_identity(reply.value);
  if (reply.failure.empty() && !initialising()) {
    initialising_since_ns_ = -1;
    return next(Task::kReadConfig);
  }
  if (now_ns_ - initialising_since_ns_ <= options_.times.initialising_limit_ns) {
    return next(Task::kAwaitReady, options_.times.initialising_poll_ns);
  }
  initialising_since_ns_ = -1;
  fail(reply.failure.empty()
           ? fmt::format("{} stays {} after it was configured; look at its alerts, then restart it",
                         status_.host, status_.sensor_status)
           : reply.failure);
}

void SensorSession::take_metadata(const SensorReply& reply) {
  if (!reply.failure.empty()) return fail(reply.failure);
  if (!reply.value.is_object()) {
    return fail(
        fmt::format("{} does not say its metadata; if it stays so, restart it", status_.host));
  }
  // What failed on the way here has been passed; that no packets come is still to be seen.
  const bool was_on_the_way =
      failed_in_ == SessionState::kDiscovering || failed_in_ == SessionState::kConfiguring;
  if (was_on_the_way) status_.failure.clear();
  enter(SessionState::kWaitingData, fmt::format("{} is configured", status_.host));
  next(Task::kCheckRestart);
  if (listener_.on_metadata) listener_.on_metadata(reply.value.dump());
}

void SensorSession::take_restart_check(const SensorReply& reply) {
  status_.health.failure = reply.failure;
  answers_ = reply.failure.empty();
  if (!answers_) {
    // Packets decide what becomes of it; without them its return is awaited.
    const bool stalled = status_.state == SessionState::kStalled;
    return next(Task::kCheckRestart,
                stalled ? options_.times.initialising_poll_ns : options_.times.health_period_ns);
  }
  const std::uint32_t known = status_.init_id;
  note_identity(reply.value);
  if (initialising() || status_.init_id != known) {
    ++status_.restarts;
    enter(SessionState::kDiscovering, fmt::format("{} has restarted", status_.host));
    return start_over(options_.times.initialising_poll_ns);
  }
  next(Task::kAlerts);
}

void SensorSession::take_health(const SensorReply& reply) {
  SensorHealth& health = status_.health;
  const bool lacking = reply.unsupported;
  if (!lacking && !reply.failure.empty()) health.failure = reply.failure;
  const bool answered = !lacking && reply.failure.empty();
  switch (task_) {
    case Task::kAlerts:
      if (answered) take_alerts(health, parse_alerts(reply.value));
      return next(Task::kTelemetry);
    case Task::kTelemetry:
      if (answered) health.telemetry = parse_telemetry(reply.value);
      return next(Task::kPtp);
    case Task::kPtp:
      if (answered) health.ptp = parse_ptp(reply.value);
      return next(Task::kTime);
    default:
      if (answered) health.time = parse_time(reply.value);
      return next(Task::kCheckRestart, options_.times.health_period_ns);
  }
}

void SensorSession::watch_packets() {
  const PacketActivity activity = activity_ ? activity_() : PacketActivity{};
  if (status_.state == SessionState::kRunning) {
    watch_flow(activity.last_packet_ns);
  } else {
    watch_silence(activity.last_packet_ns);
  }
  if (expects_packets()) watch_init_id(activity.init_id);
}

void SensorSession::watch_flow(std::int64_t last_packet_ns) {
  const std::int64_t silence_ns = now_ns_ - last_packet_ns;
  if (silence_ns <= stall_ns_) return;
  enter(SessionState::kStalled, fmt::format("no packet of {} for {:.3g} s", status_.host,
                                            static_cast<double>(silence_ns) * kSecondsPerNs));
  drop_question();
  next(Task::kCheckRestart);
}

void SensorSession::watch_silence(std::int64_t last_packet_ns) {
  const SessionTimes& times = options_.times;
  const bool stalled = status_.state == SessionState::kStalled;
  if (last_packet_ns > status_.state_since_ns) {
    if (stalled && status_.init_id == 0) {
      // Without an initialization id only its settings tell whether it has restarted.
      enter(SessionState::kDiscovering, fmt::format("packets of {} are back", status_.host));
      return start_over(0);
    }
    status_.failure.clear();
    retry_ns_ = times.first_retry_ns;
    return enter(SessionState::kRunning, fmt::format("packets of {} arrive", status_.host));
  }
  const std::int64_t limit_ns = stalled ? times.reconfigure_ns : times.first_packet_limit_ns;
  // An answer under way may tell why.
  if (!asked_ && now_ns_ - status_.state_since_ns > limit_ns) {
    fail(answers_ ? why_no_packets(status_, active_config_, local_address_)
                  : status_.health.failure);
  }
}

void SensorSession::watch_init_id(std::uint32_t packet_init_id) {
  const bool suspicious = packet_init_id != 0 && status_.init_id != 0 &&
                          packet_init_id != status_.init_id &&
                          packet_init_id != checked_packet_init_id_;
  if (!suspicious) return;
  // It may also be a packet from before the last reinitialise: the sensor knows.
  checked_packet_init_id_ = packet_init_id;
  drop_question();
  next(Task::kCheckRestart);
}

void SensorSession::start_over(std::int64_t after_ns) {
  drop_question();
  written_ = false;
  initialising_since_ns_ = -1;
  checked_packet_init_id_ = 0;
  next(Task::kIdentify, after_ns);
}

void SensorSession::fail(const std::string& sentence) {
  failed_in_ = status_.state;
  std::string failure = fmt::format("{}: {}", to_string(status_.state), sentence);
  // A sensor may be off for days: said once is enough.
  const bool is_news = failure != status_.failure;
  status_.failure = std::move(failure);
  ++status_.failures;
  if (is_news) {
    enter(SessionState::kDiscovering, status_.failure);
  } else {
    set_state(SessionState::kDiscovering);
  }
  start_over(retry_ns_);
  status_.next_attempt_ns = due_ns_;
  retry_ns_ = std::min(2 * retry_ns_, options_.times.longest_retry_ns);
}

void SensorSession::enter(SessionState state, const std::string& sentence) {
  set_state(state);
  if (listener_.on_news) listener_.on_news(state, sentence);
}

void SensorSession::set_state(SessionState state) {
  if (state != status_.state) status_.state_since_ns = now_ns_;
  status_.state = state;
}

void SensorSession::next(Task task, std::int64_t after_ns) {
  task_ = task;
  due_ns_ = now_ns_ + after_ns;
}

void SensorSession::drop_question() {
  if (asked_) client_.cancel();
  asked_ = false;
  reply_.reset();
}

void SensorSession::note_identity(const json& info) {
  status_.product_line = excerpt(text_member(info, "prod_line"), 40);
  status_.serial_number = excerpt(text_member(info, "prod_sn"), 40);
  status_.firmware = excerpt(text_member(info, "build_rev"), 80);
  status_.sensor_status = excerpt(text_member(info, "status"), 40);
  firmware_ = parse_firmware_version(status_.firmware).value_or(FirmwareVersion{});
  const auto init_id = integer_member(info, "initialization_id");
  const bool plausible = init_id && *init_id >= 0 && *init_id <= 0xFFFFFFFF;
  status_.init_id = plausible ? static_cast<std::uint32_t>(*init_id) : 0;
}

bool SensorSession::initialising() const {
  return status_.sensor_status == "INITIALIZING" || status_.sensor_status == "UPDATING";
}

bool SensorSession::expects_packets() const {
  return status_.state != SessionState::kDiscovering && status_.state != SessionState::kConfiguring;
}

}  // namespace glint
