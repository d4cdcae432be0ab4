// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "driver/session/fuzz_reply.hpp"

#include <string>

#include "driver/session/sensor_json.hpp"
#include "driver/session/sensor_session.hpp"

namespace glint {
namespace {

/// Answers every question with the same value.
class EchoClient final : public SensorClient {
 public:
  explicit EchoClient(nlohmann::json value) : value_(std::move(value)) {}

  void read(SensorResource, Handler handler) override {
    handler({value_, {}, false, "10.0.0.1", "10.0.0.2"});
  }
  void write_config(const nlohmann::json&, bool, Handler handler) override {
    handler({value_, {}, false, "10.0.0.1", "10.0.0.2"});
  }
  void cancel() override {}

 private:
  const nlohmann::json value_;
};

}  // namespace

int parse_reply_for_fuzzing(std::span<const std::uint8_t> bytes) {
  const std::string text(bytes.begin(), bytes.end());
  static_cast<void>(parse_firmware_version(text));
  static_cast<void>(excerpt(text));
  const auto value = parse_sensor_json(text);
  if (!value) return 0;
  SessionOptions options;
  options.host = "sensor";
  options.wanted.emplace();
  options.wanted->udp_dest = "@auto";
  options.wanted->operating_mode = "NORMAL";
  EchoClient client(*value);
  SensorSession session(client, options, {}, {});
  // Through every state, by way of failures too.
  std::int64_t now_ns = 0;
  for (int i = 0; i < 40; ++i) {
    static_cast<void>(session.step(now_ns));
    now_ns += kNsPerSecond;
  }
  return 0;
}

}  // namespace glint
