// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "daemon/cli/scan_reader.hpp"

namespace glint::cli {

const LidarScan* ScanReader::next() {
  while (true) {
    if (const LidarScan* scan = assembler_.next()) return scan;
    if (flushed_) return nullptr;
    const SourceStatus status = source_.read(packet_);
    if (status == SourceStatus::kIdle) continue;
    if (status == SourceStatus::kPacket) {
      static_cast<void>(assembler_.push(packet_.bytes));  // Counted inside.
    } else {
      assembler_.flush();
      flushed_ = true;
    }
  }
}

}  // namespace glint::cli
