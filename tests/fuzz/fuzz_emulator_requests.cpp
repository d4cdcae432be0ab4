// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
//
// What clients ask of the emulated sensor, over HTTP and over its TCP port.
#include <array>

#include "driver/core/test_sensor.hpp"
#include "driver/emulator/emulated_sensor.hpp"
#include "tests/fuzz/require.hpp"

namespace {

std::int64_t now_ns = 0;

/// The part up to the next newline, taken off the front.
std::string take_line(std::string_view& text) {
  const auto end = std::min(text.find('\n'), text.size());
  std::string line(text.substr(0, end));
  text.remove_prefix(std::min(end + 1, text.size()));
  return line;
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  constexpr std::array kFirmware{"v1.13.0", "v2.0.0", "v2.4.0", "v3.1.0", "v4.0.0"};
  static const std::string metadata = glint::to_metadata_json(
      glint::test::make_sensor(glint::LidarProfile::kRng19Rfl8Sig16Nir16, 8, 512));
  if (size == 0) return 0;
  now_ns = 0;
  glint::emulator::EmulatedSensor sensor({.metadata_json = metadata,
                                          .firmware = kFirmware[data[0] % kFirmware.size()],
                                          .config_changes = {}},
                                         {.monotonic_ns = [] { return now_ns; }},
                                         [](const auto&) {});
  std::string_view text = glint::fuzz::as_text(data + 1, size - 1);
  // Requests of three lines each: method, target, body; a line without method goes to the TCP port.
  for (int i = 0; i < 20 && !text.empty(); ++i) {
    const std::string method = take_line(text);
    const std::string target = take_line(text);
    if (method.empty()) {
      const std::string answer = sensor.answer_line(target, "10.0.0.9");
      glint::fuzz::require(answer.find('\n') == std::string::npos, "an answer is one line");
    } else {
      const auto answer = sensor.answer({method, target, take_line(text), "10.0.0.9"});
      glint::fuzz::require(answer.status >= 200 && answer.status < 600,
                           "a status is one of HTTP's");
    }
    now_ns += 500'000'000;
    static_cast<void>(sensor.update());
  }
  return 0;
}
