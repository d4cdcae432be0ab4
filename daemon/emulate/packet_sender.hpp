// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "daemon/emulate/emulation_counts.hpp"
#include "daemon/emulate/udp_sender.hpp"
#include "driver/emulator/emulated_sensor.hpp"
#include "driver/emulator/packet_feed.hpp"
#include "driver/emulator/scenario_player.hpp"
#include "pcap/synth/network_faults.hpp"

namespace glint::daemon {

struct PacketSenderOptions {
  std::optional<double> rate = 1.0;  ///< Times the recorded speed; null: as fast as it goes.
  std::string from;                  ///< Own address to send from; empty: that of the route.
  std::uint64_t seed = 1;            ///< Of the network's faults.
};

/// Sends an emulated sensor's packets over a bad line, on a thread of its own, each at its time.
/// Thread-safe.
class PacketSender final : public emulator::PacketFaultSink {
 public:
  /// `feed` is used on the sender's thread only and must outlive it. `restamper` makes foreign
  /// packets. `on_end` is called on the sender's thread when it has nothing more to send, with a
  /// sentence if that is for an error.
  PacketSender(emulator::PacketFeed& feed, const emulator::PacketRestamper& restamper,
               PacketSenderOptions options, std::function<void(const std::string&)> on_end);
  /// Stops.
  ~PacketSender() override;
  PacketSender(const PacketSender&) = delete;
  PacketSender& operator=(const PacketSender&) = delete;

  void set_stream(const emulator::EmulatedStream& stream);
  void set_faults(const emulator::PacketFaults& faults) override;
  void send_foreign(std::uint64_t count) override;
  /// What is on the way arrives, then the thread ends. The counts stay.
  void stop();

  [[nodiscard]] EmulationCounts counts() const;

 private:
  struct Wanted {
    bool stop = false;
    emulator::EmulatedStream stream;
    emulator::PacketFaults faults;
    std::uint64_t foreign = 0;  ///< Still to be sent.
  };

  void run();
  void send_all();
  // These with mutex_ held.
  SourceStatus pull(RawPacket& packet, std::unique_lock<std::mutex>& lock);
  bool follow();
  void start_stream();
  void end_stream();
  void adapt_stream();
  void open_sockets();
  bool take_next(RawPacket& packet);
  void count_fate(const RawPacket& packet, synth::DatagramFate fate);
  [[nodiscard]] std::int64_t due_ns() const;
  [[nodiscard]] std::uint64_t silent_packets() const;
  void deliver_foreign(const std::vector<std::byte>& lidar_packet);
  // And this without.
  void deliver(const RawPacket& packet);

  emulator::PacketFeed& feed_;
  const emulator::PacketRestamper& restamper_;
  const PacketSenderOptions options_;
  const std::function<void(const std::string&)> on_end_;

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  // Guarded by mutex_.
  Wanted wanted_;
  EmulationCounts counts_;
  emulator::EmulatedStream stream_;  ///< As it is followed by now.
  std::int64_t silent_since_ns_;

  // The thread's own.
  synth::FaultyNetwork network_;
  std::optional<UdpSender> lidar_;
  std::optional<UdpSender> imu_;
  std::optional<UdpSender> stranger_;
  emulator::FedPacket next_;
  bool has_next_ = false;
  bool feed_ended_ = false;
  std::int64_t began_ns_ = 0;         ///< Of the stream,
  std::int64_t first_offset_ns_ = 0;  ///< and its clock's offset then.
  std::uint64_t sent_of_scan_ = 0;
  std::uint64_t foreign_sent_ = 0;
  std::vector<std::byte> foreign_;
  std::thread thread_;  ///< Last: it uses all of the above.
};

}  // namespace glint::daemon
