// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
//
// Writes the inputs that the fuzzers start from: usage: fuzz_make_corpus tests/fuzz/corpus
#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <iostream>
#include <random>

#include "daemon/config.hpp"
#include "driver/core/imu_packet_writer.hpp"
#include "driver/core/test_sensor.hpp"
#include "pcap/capture_writer.hpp"
#include "pcap/recording/test_recording.hpp"
#include "pcap/test_capture.hpp"

namespace {

namespace fs = std::filesystem;
namespace rec = glint::recording;
using glint::LidarProfile;
using glint::SensorInfo;
using glint::test::make_sensor;

fs::path corpus;  // Where all goes, as the command line says.

fs::path folder(const std::string& target) {
  fs::create_directories(corpus / target);
  return corpus / target;
}

void save(const std::string& target, const std::string& name, std::string_view text) {
  std::ofstream(folder(target) / name, std::ios::binary) << text;
}

void save(const std::string& target, const std::string& name, std::span<const std::byte> bytes) {
  save(target, name, std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
}

/// Of every profile: two scans in order, then swapped, repeated, damaged and foreign datagrams, in
/// fuzz_packets' language.
void write_packets() {
  const auto profiles = glint::lidar_profiles();
  for (std::size_t p = 0; p < profiles.size(); ++p) {
    for (const char sensor : {'\x8E', '\x47'}) {
      std::string input{
          static_cast<char>(p), sensor, static_cast<char>(p % 2 == 0 ? 0 : 8), 1, 14, 4};
      for (const char frame : {'\0', '\1'}) {
        for (char index = 0; index < 8; ++index) input += {1, frame, index};
      }
      input += {1, 2, 1, 1, 2, 0, 1, 2, 0, 1, 1, 7};
      input += {2, 2, 2, 12, 0, 1, 3, 7, 11, 1, 2, 3};
      input += {0, 9, 0, 'n', 'o', 'p', 'a', 'c', 'k', 'e', 't', 's'};
      save("packets", fmt::format("{}_{}", glint::to_string(profiles[p]), sensor == '\x47'), input);
    }
  }
}

std::vector<std::byte> imu_packet(const SensorInfo& info) {
  const glint::ImuPacketWriter writer(info);
  std::vector<glint::ImuSample> samples(static_cast<std::size_t>(writer.format().measurements));
  for (glint::ImuSample& sample : samples) {
    sample.accel_time = sample.gyro_time = {1'000'000'000};
    sample.acceleration_mps2 = {0.1, 0.2, 9.8};
    sample.angular_rate_radps = {0.01, 0.02, 0.03};
  }
  std::vector<std::byte> packet;
  writer.write(samples, 7, 0, packet);
  return packet;
}

void write_imu_packets() {
  SensorInfo info = make_sensor(LidarProfile::kRng19Rfl8Sig16Nir16, 1, 512);
  for (const int options : {0x00, 0x01, 0x03, 0x73}) {
    info.imu_profile =
        (options & 1) != 0 ? glint::ImuProfile::kAccel32Gyro32Nmea : glint::ImuProfile::kLegacy;
    info.imu_measurements_per_packet = 1 + options / 16;
    std::vector<std::byte> input{static_cast<std::byte>(options)};
    for (int i = 0; i < 2; ++i) {
      const auto packet = imu_packet(info);
      input.insert(input.end(), packet.begin(), packet.end());
    }
    save("imu_packets", fmt::format("options_{:02x}", options), input);
  }
}

// Metadata of the grouped form, and by hand the flat one and what firmware 1.x says.
void write_metadata() {
  for (const LidarProfile profile : glint::lidar_profiles()) {
    SensorInfo info = make_sensor(profile, 4, 512);
    if (profile != LidarProfile::kLegacy) info.imu_profile = glint::ImuProfile::kAccel32Gyro32Nmea;
    save("metadata", fmt::format("grouped_{}", glint::to_string(profile)), to_metadata_json(info));
  }
  save(
      "metadata", "flat",
      R"({"prod_line":"OS-1-64","prod_sn":"991913000010","build_rev":"v2.1.2","lidar_mode":"512x10",
"beam_altitude_angles":[3,1,-1,-3],"beam_azimuth_angles":[3.1,0.9,-1.3,-3.4],"lidar_origin_to_beam_origin_mm":12.163,
"lidar_to_sensor_transform":[-1,0,0,0,0,-1,0,0,0,0,1,36.18,0,0,0,1],
"data_format":{"columns_per_frame":512,"columns_per_packet":16,"pixels_per_column":4,
"pixel_shift_by_row":[9,6,3,0],"column_window":[500,11]},"azimuth_window":[300000,100000]})");
  save("metadata", "barest",
       R"({"lidar_mode":"1024x10","beam_altitude_angles":[1,-1],"beam_azimuth_angles":[0,0]})");
  save("metadata", "sentences_for_groups",
       R"({"sensor_info":{"prod_line":"OS-1-64","build_rev":"v1.13.0"},"lidar_data_format":
"error: Command not recognized.","lidar_intrinsics":"error","config_params":{"lidar_mode":"2048x10",
"azimuth_window":[0,36000],"udp_ip":"10.0.0.1","auto_start_flag":1,"udp_port_lidar":60823},
"beam_intrinsics":{"beam_altitude_angles":[1,-1],"beam_azimuth_angles":[0,0]}})");
}

std::vector<rec::test::TestMessage> messages() {
  using Kind = rec::test::TestMessage::Kind;
  SensorInfo info = make_sensor(LidarProfile::kRng15Rfl8Nir8, 1, 32);
  std::mt19937 random(1);
  std::vector<rec::test::TestMessage> made{
      {Kind::kText, "/ouster/metadata", 0, rec::test::to_bytes(to_metadata_json(info))}};
  for (const auto& packet : glint::test::encode(info, glint::test::random_scan(info, 1, random))) {
    made.push_back({Kind::kPacket, "/ouster/lidar_packets", 1'000'000, packet});
  }
  made.push_back({Kind::kPacket, "/ouster/imu_packets", 2'000'000, imu_packet(info)});
  made.push_back({Kind::kOther, "/tf", 3'000'000, rec::test::Buffer(20)});
  return made;
}

void write_recordings() {
  using rec::Compression;
  const auto all = messages();
  const std::vector<rec::test::TestMessage> few(all.begin() + 1, all.begin() + 3);
  save("recording", "ros1", rec::test::ros1_bag(few));
  save("recording", "ros1_bzip2", rec::test::ros1_bag(all, {.compression = Compression::kBzip2}));
  save("recording", "ros1_lz4", rec::test::ros1_bag(few, {.compression = Compression::kLz4}));
  save("recording", "mcap", rec::test::mcap(all));
  save("recording", "mcap_lz4", rec::test::mcap(all, {.compression = Compression::kLz4}));
  save("recording", "mcap_zstd", rec::test::mcap(all, {.compression = Compression::kZstd}));
  save("recording", "mcap_unchunked", rec::test::mcap(few, {.messages_per_chunk = 0}));
  save("recording", "mcap_unfinished", rec::test::mcap(few, {.finished = false}));
  save("recording", "mcap_messages_packed", rec::test::mcap(few, {.pack_messages = true}));
  save("recording", "mcap_big_endian", rec::test::mcap(few, {.big_endian = true}));
  save("recording", "zstd", rec::test::compress(Compression::kZstd, rec::test::mcap(few)));
  const std::string metadata = to_metadata_json(make_sensor(LidarProfile::kLegacy, 2, 512));
  save("recording", "osf", rec::test::osf({metadata, metadata}));
  save("recording", "osf_unfinished", rec::test::osf({}, false));
  save("recording", "osf_metadata", rec::test::osf_metadata({metadata, "{}"}));
  const glint::test::TempDir temporary;
  rec::test::write_sqlite(temporary / "sqlite", few);
  save("recording", "sqlite", rec::test::load_file(temporary / "sqlite"));
}

/// The packets of fuzz_capture's sensor.
std::vector<std::vector<std::byte>> capture_packets() {
  const SensorInfo info = make_sensor(LidarProfile::kRng19Rfl8Sig16Nir16, 8, 32);
  std::mt19937 random(1);
  auto packets = glint::test::encode(info, glint::test::random_scan(info, 1, random));
  packets.push_back(imu_packet(info));
  return packets;
}

void write_capture(const std::string& name, int mtu, bool is_v6) {
  const glint::test::TempDir temporary;
  glint::CaptureWriter writer(temporary / name, {mtu});
  std::int64_t time_ns = 1'700'000'000'000'000'000;
  for (const auto& packet : capture_packets()) {
    glint::Endpoint to = glint::test::receiver(is_v6);
    to.port = packet.size() == glint::kLegacyImuPacketBytes ? 7503 : 7502;
    writer.write({time_ns += 1'000'000}, glint::test::sender(is_v6), to, packet);
  }
  writer.finish();
  save("capture", name, rec::test::load_file(temporary / name));
}

void write_captures() {
  write_capture("ethernet", 0, false);
  write_capture("ethernet_v6", 0, true);
  write_capture("fragments", 576, false);
  using namespace glint::test;
  const Buffer payload = pattern(20, 1);
  const Buffer whole = udp(payload);
  const std::vector<std::pair<std::uint32_t, Buffer>> records{
      {kLinkRaw, ipv4(whole)},
      {kLinkIpv6, ipv6(udp(payload, true))},
      {kLinkNull, join({{2, 0, 0, 0}, ipv4(whole)})},
      {kLinkLoop, join({{0, 0, 0, 2}, ipv4(whole)})},
      {kLinkCooked, join({Buffer(14), {8, 0}, ipv4(whole)})},
      {kLinkCooked2, join({{8, 0}, Buffer(18), ipv4(whole)})},
      {kLinkEthernet, ethernet(join({{0, 7, 8, 0}, ipv4(whole)}), 0x8100)},
      {kLinkRaw, ipv6_fragment(Buffer(whole.begin(), whole.begin() + 16), 9, 0, true)}};
  for (std::size_t i = 0; i < records.size(); ++i) {
    PcapBytes file(records[i].first, i % 2 == 0);
    file.record(1'000'000'000, records[i].second);
    file.save(folder("capture") / fmt::format("link_{}_{}", i, records[i].first));
  }
  glint::test::save(folder("capture") / "pcapng", pcapng({ethernet(ipv4(whole)), ethernet(whole)}));
}

void write_replies() {
  const std::string json =
      R"({"fw":"v2.1","status":"RUNNING","initialization_id":7109750,"prod_sn":"12",)"
      R"("active":[{"id":"0x01000015","category":"OVERTEMP"}],"udp_ip":"10.0.0.1","udp_dest":"10.0.0.1",)"
      R"("operating_mode":"NORMAL","auto_start_flag":1,"lidar_mode":"1024x10",)"
      R"("port_data_set":{"port_identity":"a-1","port_state":"SLAVE"}})";
  save("sensor_json", "all", json);
  save("sensor_json", "text", "\"set_config_param\"");
  save("sensor_json", "error", R"({"error":{"title":"no","description":"such path"}})");
  const auto http = [](std::string_view head, std::string_view body) {
    return fmt::format("\x01{}\r\n\r\n{}", head, body);
  };
  save("http_reply", "length", http("HTTP/1.1 200 OK\r\nContent-Length: 2\r\nServer: x", "{}"));
  save("http_reply", "to_the_end", http("HTTP/1.0 200 OK\r\nContent-Type: application/json", json));
  save("http_reply", "chunked",
       http("HTTP/1.1 200 OK\r\nTransfer-Encoding: chunked", "2;a=b\r\n{}\r\n0\r\nX: y\r\n\r\n"));
  save("http_reply", "not_found", http("HTTP/1.1 404 Not Found\r\nContent-Length: 0", ""));
  save("http_reply", "continue", http("HTTP/1.1 100 Continue\r\n\r\nHTTP/1.1 204 No", ""));
  save("http_reply", "line", std::string("\x02") + json + "\r\n");
  save("http_reply", "error_line",
       "\x02"
       "error: Command not recognized.\n");
}

void write_texts() {
  save("scenario", "all",
       "[[event]]\nat_s = 30.0\naction = \"loss\"\nshare = 0.05\n[[event]]\nat_s = 60\nevery_s = "
       "60\n"
       "action = 'restart'\n[[event]]\nat_s = 70\naction = 'clock_jump'\nseconds = -3.0\n"
       "[[event]]\nat_s = 1\naction = 'foreign_packets'\ncount = 5\n[[event]]\nat_s = 2\n"
       "action = 'alert'\ncategory = 'OVERTEMP'\nid = '0x01000015'\n");
  const glint::daemon::Config config;
  for (const char* group : {"sensor", "mount", "slam", "server", "state", "log"}) {
    save("config", group, to_toml(config, group));
  }
  save("config", "setting", "slam.orb_features=500");
  save("config", "mount", "[mount]\nT_base_sensor = [0.1, 0, 1, 0, 0, 0, 1]\n");
  const auto request = [](const std::string& name, std::string_view params) {
    save("requests", name,
         fmt::format(R"({{"jsonrpc":"2.0","id":1,"method":"{}","params":{}}})", name, params));
  };
  request("get_pose", R"({"frame":"map","child":"base","at_ns":1500000000,"predict_ms":20})");
  request("get_pose_at", R"({"frame":"odom","at":"1.550000000"})");
  request("get_trajectory", R"({"since_ns":1000000000,"limit":3,"cursor":"4"})");
  request("get_map", R"({"voxel_m":0.2,"region":[[-1,-1,-1],[5,5,5]],"since_revision":0,)"
                     R"("encoding":"base64","cursor":"1:0:0:0:3"})");
  save("requests", "batch", "[{},{}]");
  save("emulator_requests", "http",
       "\x03GET\n/api/v1/sensor/metadata\n\nGET\n/api/v1/sensor/config?staging=true\n\nPOST\n"
       "/api/v1/sensor/config?reinit=true&persist=false\n{\"udp_dest\":\"@auto\"}\n"
       "GET\n/api/v1/sensor/alerts\n\nGET\n/api/v1/time/ptp\n\n");
  save("emulator_requests", "commands",
       "\x02GET\n/api/v1/sensor/cmd/set_config_param?args=udp_port_lidar+7000\n\nGET\n"
       "/api/v1/sensor/cmd/get_config_param?args=staged\n\nGET\n/api/v1/sensor/cmd/"
       "reinitialize\n\n");
  save("emulator_requests", "lines",
       "\x01\nget_sensor_info\n\nget_config_param active udp_ip\n\nset_config_param lidar_mode "
       "512x10\n"
       "\nreinitialize\n\nwrite_config_txt\n");
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: fuzz_make_corpus FOLDER\n";
    return 2;
  }
  corpus = argv[1];
  write_packets();
  write_imu_packets();
  write_metadata();
  write_recordings();
  write_captures();
  write_replies();
  write_texts();
  return 0;
}
