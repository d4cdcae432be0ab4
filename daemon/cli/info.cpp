// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
//
// glint info: what a capture holds, as JSON.
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "daemon/cli/capture_input.hpp"
#include "daemon/cli/capture_json.hpp"
#include "daemon/cli/command.hpp"
#include "daemon/cli/scan_reader.hpp"
#include "driver/core/packet_view.hpp"
#include "pcap/flow_survey.hpp"
#include "pcap/recording/recording_files.hpp"
#include "pcap/recording/recording_format.hpp"
#include "pcap/recording/topic_survey.hpp"

namespace glint::cli {
namespace {

using Json = nlohmann::ordered_json;

Json describe_flows(const FlowSurvey& survey) {
  Json flows = Json::array();
  for (const Flow& flow : survey.flows) {
    flows.push_back({{"source", to_string(flow.source)},
                     {"port", flow.port},
                     {"bytes", flow.bytes},
                     {"datagrams", flow.datagrams}});
    if (flow.serial != 0) flows.back()["serial_number"] = std::to_string(flow.serial);
  }
  return flows;
}

Json describe_capture(const std::string& file, const FlowSurvey& survey) {
  return {{"capture", file},
          {"link_type", survey.link_type},
          {"first_time_ns", survey.first_time.ns},
          {"last_time_ns", survey.last_time.ns},
          {"duration_s", static_cast<double>(survey.last_time - survey.first_time) * kSecondsPerNs},
          {"flows", describe_flows(survey)},
          {"records", to_json(survey.counters)}};
}

Json describe_sensor(const SensorInfo& info) {
  return {{"product_line", info.product_line},
          {"serial_number", info.serial_number},
          {"firmware", info.firmware},
          {"lidar_mode", info.lidar_mode},
          {"beams", info.pixels_per_column},
          {"columns_per_frame", info.columns_per_frame},
          {"columns_per_packet", info.columns_per_packet},
          {"column_window", {info.column_window.first, info.column_window.second}},
          {"lidar_port", info.lidar_port},
          {"imu_port", info.imu_port}};
}

/// Passes a source on and counts the lidar packets that overtook others.
class ReorderCounter : public PacketSource {
 public:
  ReorderCounter(PacketSource& source, const SensorInfo& info) : source_(source), format_(info) {}

  SourceStatus read(RawPacket& packet) override {
    const SourceStatus status = source_.read(packet);
    if (status != SourceStatus::kPacket) return status;
    if (const auto view = PacketView::parse(format_, packet.bytes)) look_at(*view);
    return status;
  }
  void stop() override { source_.stop(); }
  [[nodiscard]] std::uint64_t reorders() const { return reorders_; }

 private:
  void look_at(const PacketView& view) {
    const std::uint32_t frame = view.frame_id();
    const std::uint16_t column = view.column(0).measurement_id();
    // Frame ids wrap: half their range is "before".
    const std::uint32_t ahead = frame - frame_;
    const std::int64_t frames_on = format_.frame_id_bits() == 16
                                       ? std::int64_t{static_cast<std::int16_t>(ahead)}
                                       : std::int64_t{static_cast<std::int32_t>(ahead)};
    if (any_ && (frames_on < 0 || (frames_on == 0 && column < column_))) {
      ++reorders_;
      return;
    }
    any_ = true;
    frame_ = frame;
    column_ = column;
  }

  PacketSource& source_;
  const PacketFormat format_;
  bool any_ = false;
  std::uint32_t frame_ = 0;
  std::uint16_t column_ = 0;
  std::uint64_t reorders_ = 0;
};

Json describe_recording(const std::string& file, const recording::TopicSurvey& survey) {
  Json topics = Json::array();
  for (const recording::TopicFlow& flow : survey.flows) {
    topics.push_back({{"topic", flow.topic},
                      {"type", flow.type},
                      {"packet_bytes", flow.bytes},
                      {"messages", flow.messages}});
  }
  Json metadata = Json::array();
  for (const recording::RecordedMetadata& found : survey.metadata) metadata.push_back(found.topic);
  return {{"capture", file},
          {"format", recording::to_string(recording::recording_format(file))},
          {"messages", survey.messages},
          {"duration_s", static_cast<double>(survey.last_time - survey.first_time) * kSecondsPerNs},
          {"topics", topics},
          {"metadata_topics", metadata}};
}

/// Adds what can only be told with the sensor's metadata.
void add_frames(const CaptureInput& input, Json& out) {
  const SensorInfo info = load_capture_info(input);
  const auto source = open_capture(input, info);
  ReorderCounter ordered(*source, info);
  ScanReader reader(ordered, info);
  std::uint64_t frames = 0;
  double completeness = 0.0;
  while (const LidarScan* scan = reader.next()) {
    ++frames;
    completeness += scan->completeness();
  }
  const AssemblerCounters& counters = reader.assembler().counters();
  out["sensor"] = describe_sensor(info);
  out["profile"] = to_string(info.profile);
  out["frames"] = frames;
  out["incomplete_frames"] = counters.incomplete_scans;
  out["completeness"] = frames == 0 ? 0.0 : completeness / static_cast<double>(frames);
  out["losses"] = counters.missing_packets;
  out["reorders"] = ordered.reorders();
  out["restarts"] = counters.restarts;
  if (const auto* pcap = dynamic_cast<const PcapSource*>(source.get())) {
    out["lidar_source"] = to_string(pcap->flow().source);
  }
  out["packets"] = to_json(counters);
  out["datagrams"] = source_json(*source);
  out["notices"] = source->notices();
}

void print_info(const CaptureInput& input) {
  const bool has_metadata = has_capture_info(input);
  std::string problem;
  Json out;
  if (recording::is_recording(input.capture)) {
    const recording::TopicSurvey survey = recording::survey_topics(input.capture);
    problem = survey.problem;
    out = describe_recording(input.capture, survey);
  } else {
    const FlowSurvey survey = survey_flows(input.capture);
    problem = survey.problem;
    out = describe_capture(input.capture, survey);
  }
  if (has_metadata) {
    add_frames(input, out);
  } else {
    out["notices"] =
        Json::array({"No metadata beside the capture: name the sensor's with --meta "
                     "to have its frames counted."});
    if (!problem.empty()) out["notices"].push_back(problem);
  }
  std::cout << out.dump(2) << '\n';
}

}  // namespace

void add_info(CLI::App& app) {
  CLI::App* const command = app.add_subcommand("info", "Say what a capture holds, as JSON");
  const auto input = std::make_shared<CaptureInput>();
  add_capture_options(*command, *input);
  command->callback([input] { print_info(*input); });
}

}  // namespace glint::cli
