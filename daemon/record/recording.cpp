// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "daemon/record/recording.hpp"

#include <fmt/format.h>

#include <boost/asio/io_context.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/signal_set.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <cmath>
#include <csignal>
#include <stdexcept>

#include "daemon/doctor/route.hpp"
#include "daemon/record/packet_recorder.hpp"
#include "daemon/steady_clock.hpp"
#include "driver/core/error.hpp"
#include "driver/session/network_client.hpp"
#include "driver/session/sensor_session.hpp"
#include "driver/session/session_runner.hpp"

namespace glint::daemon {
namespace {

namespace asio = boost::asio;
using boost::system::error_code;

constexpr int kUsualLidarPort = 7502;
constexpr int kUsualImuPort = 7503;

std::chrono::nanoseconds duration(double seconds) {
  return std::chrono::nanoseconds(std::llround(seconds / kSecondsPerNs));
}

IpAddress parse_route_address(const std::string& text) {
  // Without the zone of link-local addresses, which captures have no place for.
  return IpAddress::parse(text.substr(0, text.find('%'))).value_or(IpAddress{});
}

/// Everything that runs during a recording.
class Recording {
 public:
  explicit Recording(const RecordingOptions& options)
      : options_(options), address_(parse_sensor_address(options.sensor)) {
    // A file size limit is to be told like a full disk, not by a signal's default.
    std::signal(SIGXFSZ, SIG_IGN);
    signals_.async_wait([this](error_code error, int) {
      if (!error) io_.stop();
    });
    if (options_.metadata_json.empty() || options_.configure) start_session();
    if (!options_.metadata_json.empty()) begin(options_.metadata_json);
  }

  RecordingResult run() {
    io_.run();
    if (recorder_) recorder_->stop();
    io_.restart();
    io_.poll();  // What failed at the very end.
    if (!error_.empty()) throw std::runtime_error(error_);
    return result();
  }

 private:
  void start_session() {
    SessionOptions session;
    session.host = address_.host;
    if (options_.configure) {
      WantedConfig& wanted = session.wanted.emplace();
      wanted.udp_dest = "@auto";
      wanted.udp_port_lidar = options_.lidar_port.value_or(kUsualLidarPort);
      wanted.udp_port_imu = options_.imu_port.value_or(kUsualImuPort);
      wanted.operating_mode = "NORMAL";
    }
    client_.emplace(io_, address_, ClientTimeouts{});
    session_.emplace(
        *client_, session, [this] { return recorder_ ? recorder_->activity() : PacketActivity{}; },
        SessionListener{[this](const std::string& json) { take_metadata(json); },
                        [this](SessionState, const std::string& news) { tell(news); }});
    runner_.emplace(io_, *session_, stage_clock());
    timer_.expires_after(duration(options_.patience_s));
    timer_.async_wait([this](error_code error) {
      if (error || recorder_) return;
      const std::string& failure = session_->status().failure;
      fail(failure.empty() ? fmt::format("{} has not given its metadata within {} s",
                                         options_.sensor, options_.patience_s)
                           : failure);
    });
  }

  void take_metadata(const std::string& json) {
    try {
      if (!recorder_) return begin(json);
      const SensorInfo info = parse_sensor_info(json, options_.sensor);
      if (PacketFormat(info).packet_bytes == packet_bytes_) return;
      packet_bytes_ = PacketFormat(info).packet_bytes;
      tell(options_.files.part_bytes != 0
               ? "the sensor sends other packets from now on; they go to a new part"
               : "the sensor sends other packets from now on, which the metadata beside the "
                 "capture do not describe; record with --split, or end this recording");
      recorder_->set_metadata(json);
    } catch (const InputError& error) {
      fail(error.what());
    }
  }

  void begin(const std::string& metadata_json) {
    const SensorInfo info = parse_sensor_info(metadata_json, options_.sensor);
    packet_bytes_ = PacketFormat(info).packet_bytes;
    const RouteLookup lookup = look_up_route(address_.host);
    if (!lookup.route) throw InputError(lookup.failure);
    PacketRecorder::Line line;
    line.sensor = parse_route_address(lookup.route->address);
    line.host = parse_route_address(lookup.route->local_address);
    line.udp.lidar_port = options_.lidar_port.value_or(static_cast<std::uint16_t>(info.lidar_port));
    line.udp.imu_port = options_.imu_port.value_or(static_cast<std::uint16_t>(info.imu_port));
    line.udp.source_address = to_string(line.sensor);
    line.udp.rcvbuf_bytes = options_.rcvbuf_bytes;
    if (line.udp.lidar_port == 0) {
      throw InputError(
          fmt::format("{} sends no lidar packets, for its udp_port_lidar is 0; record "
                      "with --configure",
                      options_.sensor));
    }
    parts_.emplace(options_.files, metadata_json);
    tell(fmt::format("recording ports {} and {} of {} to {}", line.udp.lidar_port,
                     line.udp.imu_port, line.udp.source_address, parts_->current_file().string()));
    begun_ns_ = steady_now_ns();
    recorder_.emplace(line, info, *parts_, [this](const std::string& error) {
      asio::post(io_, [this, error] { fail(error); });
    });
    if (!options_.seconds) return;
    timer_.expires_after(duration(*options_.seconds));
    timer_.async_wait([this](error_code error) {
      if (!error) io_.stop();
    });
  }

  [[nodiscard]] RecordingResult result() const {
    RecordingResult result;
    if (!recorder_) return result;
    const ReceivedCounts counts = recorder_->counts();
    result.lidar_packets = counts.lidar;
    result.imu_packets = counts.imu;
    result.other_packets = counts.other;
    result.kernel_drops = recorder_->kernel_drops();
    result.disk_drops = recorder_->disk_drops();
    result.granted_rcvbuf_bytes = recorder_->granted_rcvbuf_bytes();
    result.bytes = parts_->bytes();
    result.files = parts_->files();
    result.deleted_files = parts_->deleted_files();
    result.seconds = static_cast<double>(steady_now_ns() - begun_ns_) * kSecondsPerNs;
    return result;
  }

  void tell(const std::string& news) const {
    if (options_.on_news) options_.on_news(news);
  }

  void fail(const std::string& error) {
    error_ = error;
    io_.stop();
  }

  const RecordingOptions& options_;
  const SensorAddress address_;
  std::string error_;
  std::int64_t begun_ns_ = 0;
  std::size_t packet_bytes_ = 0;
  asio::io_context io_{1};
  asio::signal_set signals_{io_, SIGINT, SIGTERM};
  asio::steady_timer timer_{io_};  ///< Of patience, then of the recording's end.
  std::optional<CaptureParts> parts_;
  std::optional<PacketRecorder> recorder_;
  std::optional<NetworkSensorClient> client_;
  std::optional<SensorSession> session_;
  std::optional<SessionRunner> runner_;
};

}  // namespace

RecordingResult record(const RecordingOptions& options) { return Recording(options).run(); }

}  // namespace glint::daemon
