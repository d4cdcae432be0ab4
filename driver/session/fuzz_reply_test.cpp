// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "driver/session/fuzz_reply.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace glint {
namespace {

int feed(const std::string& text) {
  const std::vector<std::uint8_t> bytes(text.begin(), text.end());
  return parse_reply_for_fuzzing(bytes);
}

// A sanitizer build finds what these would break.
TEST(FuzzReplyTest, EveryPrefixAndEveryFlippedByteOfAnAnswerIsSurvived) {
  const std::string answer =
      R"({"fw":"v2.1","status":"RUNNING","initialization_id":1e300,"prod_sn":"12","active":[)"
      R"({"id":"0x01000015","category":"OVERTEMP"}],"udp_ip":7,"auto_start_flag":null,)"
      R"("port_data_set":{"port_identity":"-","port_state":"SLAVE"}})";
  for (std::size_t i = 0; i <= answer.size(); ++i) {
    EXPECT_EQ(feed(answer.substr(0, i)), 0);
    std::string flipped = answer;
    if (i < answer.size()) flipped[i] = static_cast<char>(flipped[i] ^ 0x15);
    EXPECT_EQ(feed(flipped), 0);
  }
}

}  // namespace
}  // namespace glint
