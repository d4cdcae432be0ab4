// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "daemon/export/las_writer.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <string_view>

#include "daemon/cli/text_file.hpp"
#include "daemon/version.hpp"
#include "driver/core/error.hpp"

namespace glint::cli {
namespace {

// ASPRS LAS specification 1.2, "Public Header Block" and "Point Data Record Format 0".
constexpr std::uint16_t kHeaderBytes = 227;
constexpr std::uint16_t kPointBytes = 20;
constexpr double kScale_m = 0.001;
// A byte's largest value becomes a uint16's.
constexpr float kIntensityStep = 257.0F;

static_assert(std::endian::native == std::endian::little, "LAS is little-endian");

template <class Value>
void append(std::string& out, Value value) {
  const auto bytes = std::bit_cast<std::array<char, sizeof(Value)>>(value);
  out.append(bytes.data(), bytes.size());
}

void append_text(std::string& out, std::string_view text, std::size_t field_bytes) {
  text = text.substr(0, field_bytes);
  out.append(text);
  out.append(field_bytes - text.size(), '\0');
}

/// Least and greatest coordinate of an axis.
struct Span {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();

  void take(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
};

using Box = std::array<Span, 3>;
constexpr std::array kAxes = {&slam::MapPoint::x_m, &slam::MapPoint::y_m, &slam::MapPoint::z_m};

Box box_of(std::span<const slam::MapPoint> points) {
  Box box;
  for (const slam::MapPoint& point : points) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      box[axis].take(static_cast<double>(point.*kAxes[axis]));
    }
  }
  if (points.empty()) box.fill({0.0, 0.0});
  return box;
}

std::string header(const Box& box, const std::array<double, 3>& offset_m, std::uint32_t count) {
  std::string out = "LASF";
  append<std::uint16_t>(out, 0);  // file source
  append<std::uint16_t>(out, 0);  // global encoding
  out.append(16, '\0');           // project
  append<std::uint8_t>(out, 1);
  append<std::uint8_t>(out, 2);
  append_text(out, "", 32);  // system
  append_text(out, std::string("glint ") + kVersion, 32);
  append<std::uint16_t>(out, 0);  // day of creation: unknown, so that equal maps are equal files
  append<std::uint16_t>(out, 0);  // year
  append<std::uint16_t>(out, kHeaderBytes);
  append<std::uint32_t>(out, kHeaderBytes);  // where points begin
  append<std::uint32_t>(out, 0);             // variable length records
  append<std::uint8_t>(out, 0);              // point format
  append<std::uint16_t>(out, kPointBytes);
  append<std::uint32_t>(out, count);
  append<std::uint32_t>(out, count);  // first returns
  for (int i = 0; i < 4; ++i) append<std::uint32_t>(out, 0);
  for (int i = 0; i < 3; ++i) append(out, kScale_m);
  for (const double offset : offset_m) append(out, offset);
  for (const Span& span : box) {
    append(out, span.high);
    append(out, span.low);
  }
  return out;
}

void append_point(std::string& out, const slam::MapPoint& point,
                  const std::array<double, 3>& offset_m) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double value_m = static_cast<double>(point.*kAxes[axis]) - offset_m[axis];
    append(out, static_cast<std::int32_t>(std::lround(value_m / kScale_m)));
  }
  const float intensity = std::clamp(point.intensity, 0.0F, 255.0F) * kIntensityStep;
  append(out, static_cast<std::uint16_t>(std::lround(intensity)));
  append<std::uint8_t>(out, 0x09);  // return 1 of 1
  append<std::uint8_t>(out, 0);     // never classified
  append<std::int8_t>(out, 0);      // scan angle
  append<std::uint8_t>(out, 0);
  append<std::uint16_t>(out, 0);
}

}  // namespace

void write_las(const std::filesystem::path& file, std::span<const slam::MapPoint> points) {
  if (points.size() > std::numeric_limits<std::uint32_t>::max()) {
    throw InputError("cannot write " + file.string() +
                     ": LAS 1.2 counts no more than 4294967295 points; thin them with --voxel-m");
  }
  const Box box = box_of(points);
  // The middle, in whole metres: a map may be as large as millimetres in 32 bits can span.
  std::array<double, 3> offset_m{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    offset_m[axis] = std::round((box[axis].low + box[axis].high) / 2.0);
  }
  std::string content = header(box, offset_m, static_cast<std::uint32_t>(points.size()));
  content.reserve(kHeaderBytes + points.size() * kPointBytes);
  for (const slam::MapPoint& point : points) append_point(content, point, offset_m);
  write_text_file(file, content);
}

}  // namespace glint::cli
