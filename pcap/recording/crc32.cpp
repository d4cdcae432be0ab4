// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "pcap/recording/crc32.hpp"

#include <boost/crc.hpp>

namespace glint::recording {

std::uint32_t crc32(ByteSpan bytes) {
  boost::crc_32_type crc;
  crc.process_bytes(bytes.data(), bytes.size());
  return crc.checksum();
}

}  // namespace glint::recording
