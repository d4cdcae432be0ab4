// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "driver/core/packet_format.hpp"

#include <gmock/gmock.h>

#include "driver/core/test_sensor.hpp"

namespace glint {
namespace {

using test::make_sensor;
using testing::HasSubstr;
using testing::ThrowsMessage;

std::size_t packet_bytes(LidarProfile profile, int rows) {
  return PacketFormat(make_sensor(profile, rows, 1024)).packet_bytes;
}

// Sizes that real sensors send, from captures and the sensor manual.
TEST(PacketFormat, SizesAreThoseOfRealSensors) {
  EXPECT_EQ(packet_bytes(LidarProfile::kLegacy, 16), 3392U);
  EXPECT_EQ(packet_bytes(LidarProfile::kLegacy, 32), 6464U);
  EXPECT_EQ(packet_bytes(LidarProfile::kLegacy, 64), 12608U);
  EXPECT_EQ(packet_bytes(LidarProfile::kLegacy, 128), 24896U);
  EXPECT_EQ(packet_bytes(LidarProfile::kRng19Rfl8Sig16Nir16, 128), 24832U);
  EXPECT_EQ(packet_bytes(LidarProfile::kRng19Rfl8Sig16Nir16Dual, 32), 8448U);
  EXPECT_EQ(packet_bytes(LidarProfile::kRng15Rfl8Nir8, 128), 8448U);
}

// Rows of the manual's table of sizes: pixel bytes by profile, at 64 beams.
TEST(PacketFormat, SizesOfAllProfilesAreTheManuals) {
  EXPECT_EQ(packet_bytes(LidarProfile::kRng15Rfl8Win8, 64), 4352U);
  EXPECT_EQ(packet_bytes(LidarProfile::kRng15Rfl8Nir8Dual, 64), 8448U);
  EXPECT_EQ(packet_bytes(LidarProfile::kFusaRng15Rfl8Nir8Dual, 64), 8448U);
  EXPECT_EQ(packet_bytes(LidarProfile::kFiveWordPixel, 64), 20736U);
  EXPECT_EQ(packet_bytes(LidarProfile::kRng15Rfl8Nir8Zone16, 64), 8448U);
  EXPECT_EQ(packet_bytes(LidarProfile::kRng19Rfl8Sig16Nir16Zone16, 64), 12544U);
  EXPECT_EQ(packet_bytes(LidarProfile::kRng19Rfl8Sig16Zone16Dual, 64), 16640U);
  EXPECT_EQ(packet_bytes(LidarProfile::kRng19Rfl8Sig16Nir16Rgb16, 64), 16640U);
  EXPECT_EQ(packet_bytes(LidarProfile::kRng19Rfl8Sig16Nir16Rgb16Dual, 64), 20736U);
}

TEST(PacketFormat, EveryProfileHasItsOwnRow) {
  for (const auto profile : lidar_profiles()) {
    EXPECT_EQ(profile_layout(profile).profile, profile);
  }
}

TEST(PacketFormat, LowDataRateCarriesNoSignal) {
  const PacketFormat format(make_sensor(LidarProfile::kRng15Rfl8Nir8, 64, 1024));
  EXPECT_FALSE(format.has(Channel::kSignal));
  EXPECT_TRUE(format.has(Channel::kNearIr));
  EXPECT_FALSE(format.has(Channel::kRange2));
}

TEST(PacketFormat, PacketBeyondTheUdpLimitIsRejected) {
  EXPECT_THAT([] { PacketFormat(make_sensor(LidarProfile::kRng19Rfl8Sig16Nir16Dual, 256, 1024)); },
              ThrowsMessage<MetadataError>(HasSubstr("no UDP datagram can carry")));
}

}  // namespace
}  // namespace glint
