// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>

namespace glint {

// Offsets in IMU packets; see the sensor manual, "IMU data packet format". The header of the later
// form is that of lidar packets.

constexpr std::uint16_t kImuPacketType = 2;

// LEGACY: g and deg/s. It begins with a monotonic time for diagnostics, which nothing here needs.
constexpr int kLegacyImuAccelTimeOffset = 8;
constexpr int kLegacyImuGyroTimeOffset = 16;
constexpr int kLegacyImuAccelerationOffset = 24;
constexpr int kLegacyImuAngularRateOffset = 36;
constexpr double kStandardGravity_mps2 = 9.80665;
constexpr double kRadiansPerDegree = M_PI / 180.0;

// ACCEL32_GYRO32_NMEA: m/s^2 and rad/s. Header, NMEA block (a time and a sentence), measurements,
// footer: reserved bytes, then the CRC of all before it.
constexpr std::size_t kImuHeaderBytes = 32;
constexpr std::size_t kImuNmeaBytes = 100;
constexpr std::size_t kImuMeasurementBytes = 36;
constexpr std::size_t kImuFooterBytes = 32;
constexpr std::size_t kImuCrcBytes = 8;
constexpr int kImuTimeOffset = 0;
constexpr int kImuMeasurementIdOffset = 8;
constexpr int kImuStatusOffset = 10;  // bit 0 = valid
constexpr int kImuAccelerationOffset = 12;
constexpr int kImuAngularRateOffset = 24;

}  // namespace glint
