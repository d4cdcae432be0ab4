// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "daemon/emulate/emulation.hpp"

#include <boost/asio/io_context.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/signal_set.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <csignal>
#include <memory>
#include <stdexcept>

#include "daemon/cli/text_file.hpp"
#include "daemon/emulate/packet_sender.hpp"
#include "daemon/steady_clock.hpp"
#include "driver/emulator/looped_capture.hpp"
#include "driver/emulator/packet_feed.hpp"

namespace glint::daemon {
namespace {

namespace asio = boost::asio;
using boost::system::error_code;
using Json = nlohmann::ordered_json;

constexpr std::size_t kMostLoopedBytes = std::size_t{1} << 30U;
constexpr std::chrono::seconds kReportPeriod(1);

/// What is sent, with what it is made of.
struct Feed {
  Feed(PacketSource& capture, const SensorInfo& info, const EmulationOptions& options)
      : restamper(PacketFormat(info), ImuPacketFormat(info), false) {
    if (!options.control && options.loops == 1) {
      packets = std::make_unique<emulator::VerbatimFeed>(capture, info);
      return;
    }
    looped.emplace(capture, info, kMostLoopedBytes);
    restamper = looped->restamper();
    packets = std::make_unique<emulator::LoopedFeed>(*looped, options.loops);
  }

  std::optional<emulator::LoopedCapture> looped;
  emulator::PacketRestamper restamper;
  std::unique_ptr<emulator::PacketFeed> packets;
};

/// Everything that runs during an emulation.
class Emulation {
 public:
  Emulation(PacketSource& capture, const SensorInfo& info, const EmulationOptions& options)
      : options_(options),
        feed_(capture, info, options),
        start_ns_(steady_now_ns()),
        sender_(*feed_.packets, feed_.restamper, {options.rate, options.from, options.seed},
                [this](const std::string& error) {
                  asio::post(io_, [this, error] { finish(error); });
                }) {
    sender_.set_faults(options.faults);
    watch_end();
    if (options_.control) {
      start_control();
    } else {
      start_plainly();
    }
    if (!options_.report.empty()) report_regularly();
  }

  EmulationResult run() {
    io_.run();
    sender_.stop();
    const EmulationResult done = result();
    if (!options_.report.empty()) write_report(done);
    if (!error_.empty()) throw std::runtime_error(error_);
    return done;
  }

 private:
  void watch_end() {
    signals_.async_wait([this](error_code error, int) {
      if (!error) finish({});
    });
    if (!options_.seconds) return;
    end_timer_.expires_after(
        std::chrono::nanoseconds(std::llround(*options_.seconds / kSecondsPerNs)));
    end_timer_.async_wait([this](error_code error) {
      if (!error) finish({});
    });
  }

  void start_control() {
    emulator::SensorEmulatorOptions control = *options_.control;
    // A PTP master has TAI, which is ahead of UTC by so many seconds since 2017.
    constexpr std::int64_t kTaiMinusUtc_ns = 37 * kNsPerSecond;
    control.sensor.ptp_minus_monotonic_ns =
        read_clock_ns(CLOCK_REALTIME) + kTaiMinusUtc_ns - steady_now_ns();
    emulator_.emplace(io_, control, stage_clock(), [this](const emulator::EmulatedStream& stream) {
      sender_.set_stream(stream);
    });
    if (options_.on_listening) {
      options_.on_listening(emulator_->http_port(), emulator_->tcp_port());
    }
    player_.emplace(options_.scenario, *emulator_, sender_, options_.faults);
    play();
  }

  void start_plainly() {
    emulator::EmulatedStream stream;
    stream.sending = true;
    stream.destination = options_.destination;
    stream.lidar_port = options_.lidar_port;
    stream.imu_port = options_.imu_port;
    stream.clock_zero_ns = steady_now_ns() - kNsPerSecond;  // Time 0 would mean none.
    sender_.set_stream(stream);
  }

  void play() {
    const auto due_ns = player_->play(steady_now_ns() - start_ns_);
    if (!due_ns) return;
    scenario_timer_.expires_after(std::chrono::nanoseconds(start_ns_ + *due_ns - steady_now_ns()));
    scenario_timer_.async_wait([this](error_code error) {
      if (!error) play();
    });
  }

  void report_regularly() {
    write_report(result());
    report_timer_.expires_after(kReportPeriod);
    report_timer_.async_wait([this](error_code error) {
      if (!error) report_regularly();
    });
  }

  void write_report(const EmulationResult& result) const {
    cli::write_text_file(options_.report, to_json(result).dump(2) + '\n');
  }

  [[nodiscard]] EmulationResult result() const {
    EmulationResult result;
    result.packets = sender_.counts();
    if (emulator_) result.sensor = emulator_->sensor().counts();
    result.seconds = static_cast<double>(steady_now_ns() - start_ns_) * kSecondsPerNs;
    return result;
  }

  void finish(const std::string& error) {
    error_ = error;
    io_.stop();
  }

  const EmulationOptions& options_;
  Feed feed_;
  const std::int64_t start_ns_;
  std::string error_;
  asio::io_context io_{1};
  asio::signal_set signals_{io_, SIGINT, SIGTERM};
  asio::steady_timer end_timer_{io_};
  asio::steady_timer scenario_timer_{io_};
  asio::steady_timer report_timer_{io_};
  PacketSender sender_;
  std::optional<emulator::SensorEmulator> emulator_;
  std::optional<emulator::ScenarioPlayer> player_;
};

}  // namespace

Json to_json(const EmulationResult& result) {
  Json json = to_json(result.packets);
  json["sensor"] = {{"requests", result.sensor.requests},
                    {"config_writes", result.sensor.config_writes},
                    {"reinitialises", result.sensor.reinitialises},
                    {"flash_writes", result.sensor.flash_writes},
                    {"restarts", result.sensor.starts}};
  json["seconds"] = result.seconds;
  return json;
}

EmulationResult emulate(PacketSource& capture, const SensorInfo& info,
                        const EmulationOptions& options) {
  return Emulation(capture, info, options).run();
}

}  // namespace glint::daemon
