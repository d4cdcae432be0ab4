// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <nlohmann/json.hpp>

#include "driver/core/scan_assembler.hpp"
#include "pcap/pcap_source.hpp"

namespace glint::cli {

/// Counters as JSON objects, for index.json and `glint info`.
nlohmann::ordered_json to_json(const AssemblerCounters& counters);
nlohmann::ordered_json to_json(const PcapSourceCounters& counters);
nlohmann::ordered_json to_json(const CaptureCounters& counters);
/// Of a capture or a recording: what became of its datagrams or messages.
nlohmann::ordered_json source_json(const PacketSource& source);
/// Of a capture's records; null for recordings.
nlohmann::ordered_json capture_json(const PacketSource& source);

}  // namespace glint::cli
