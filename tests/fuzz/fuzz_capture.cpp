// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
//
// Captures: the file itself, link and IP headers, fragments, and the source made of them.
#include <algorithm>

#include "driver/core/error.hpp"
#include "driver/core/test_sensor.hpp"
#include "pcap/pcap_source.hpp"
#include "tests/fuzz/memory_file.hpp"
#include "tests/fuzz/require.hpp"

namespace {

using glint::fuzz::require;

void check(const glint::CaptureCounters& counters) {
  require(counters.records == counters.whole_datagrams + counters.fragments +
                                  counters.other_protocols + counters.truncated_records +
                                  counters.malformed_records,
          "every record is in one counter");
}

void read_datagrams(const std::filesystem::path& file) {
  glint::CaptureReader reader(file);
  while (const glint::Datagram* datagram = reader.next()) {
    require(datagram->payload.size() <= 65'535, "datagrams fit UDP");
    // Every byte is there to be read.
    const auto zeros = std::ranges::count(datagram->payload, std::byte{0});
    require(zeros <= std::ssize(datagram->payload), "bytes can be counted");
  }
  check(reader.counters());
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  // The sensor of the captures in the corpus.
  static const auto info =
      glint::test::make_sensor(glint::LidarProfile::kRng19Rfl8Sig16Nir16, 8, 32);
  const glint::fuzz::MemoryFile file(glint::fuzz::as_bytes(data, size));
  try {
    read_datagrams(file.path());
    glint::PcapSource source(file.path(), info);
    glint::RawPacket packet;
    while (source.read(packet) == glint::SourceStatus::kPacket) {
      require(!packet.bytes.empty(), "packets have bytes");
    }
    check(source.capture_counters());
  } catch (const glint::InputError&) {
    // The verdict that most inputs deserve.
  }
  return 0;
}
