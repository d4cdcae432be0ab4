// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

namespace glint {

/// Whether a stream's CRCs mean anything. Firmware before 2.5 leaves them empty or fills them with
/// something else, so a mismatch says nothing until a run of packets has had them right, and a run
/// of mismatches says that they mean nothing any more. Value type.
class CrcTrust {
 public:
  /// So many packets in a row prove the one or the other: about a scan.
  static constexpr int kRun = 64;

  /// Takes the next packet's result. False: the packet is damaged.
  bool accept(bool matches) {
    if (matches == trusted_) {
      against_ = 0;
    } else if (++against_ == kRun) {
      trusted_ = matches;
      against_ = 0;
    }
    return matches || !trusted_;
  }

 private:
  bool trusted_ = false;
  int against_ = 0;  ///< Results in a row that speak against what is believed.
};

}  // namespace glint
