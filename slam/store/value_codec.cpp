// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/store/value_codec.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

namespace glint::slam {
namespace {

static_assert(std::endian::native == std::endian::little, "values are kept as they lie in memory");

template <std::size_t N>
std::array<std::byte, N * sizeof(double)> bytes_of(const std::array<double, N>& values) {
  return std::bit_cast<std::array<std::byte, N * sizeof(double)>>(values);
}

template <std::size_t N>
std::optional<std::array<double, N>> values_of(std::span<const std::byte> bytes) {
  std::array<double, N> values{};
  if (bytes.size() != sizeof values) return std::nullopt;
  std::memcpy(values.data(), bytes.data(), sizeof values);
  return values;
}

template <int Rows>
using RowMajor = Eigen::Matrix<double, Rows, Rows, Eigen::RowMajor>;

}  // namespace

PoseBytes encode_pose(const Pose& pose) {
  const auto& t = pose.translation_m;
  const auto& q = pose.rotation;
  return bytes_of<7>({t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w()});
}

std::optional<Pose> decode_pose(std::span<const std::byte> bytes) {
  const auto v = values_of<7>(bytes);
  if (!v || !std::ranges::all_of(*v, [](double x) { return std::isfinite(x); }))
    return std::nullopt;
  Pose pose{{(*v)[6], (*v)[3], (*v)[4], (*v)[5]}, {(*v)[0], (*v)[1], (*v)[2]}};
  // Every rotation that was written has unit length but for rounding.
  if (std::abs(pose.rotation.norm() - 1.0) > 1e-3) return std::nullopt;
  return pose;
}

CovarianceBytes encode_covariance(const Eigen::Matrix<double, 6, 6>& covariance) {
  std::array<double, 36> values{};
  Eigen::Map<RowMajor<6>>(values.data()) = covariance;
  return bytes_of(values);
}

std::optional<Eigen::Matrix<double, 6, 6>> decode_covariance(std::span<const std::byte> bytes) {
  const auto values = values_of<36>(bytes);
  if (!values) return std::nullopt;
  return Eigen::Map<const RowMajor<6>>(values->data());
}

GravityBytes encode_gravity(const FeltGravity& gravity) {
  std::array<double, 13> values{};
  Eigen::Map<Eigen::Vector3d>(values.data()) = gravity.up;
  Eigen::Map<RowMajor<3>>(values.data() + 3) = gravity.bias_share;
  values[12] = gravity.sigma_rad;
  return bytes_of(values);
}

std::optional<FeltGravity> decode_gravity(std::span<const std::byte> bytes) {
  const auto values = values_of<13>(bytes);
  if (!values) return std::nullopt;
  FeltGravity gravity;
  gravity.up = Eigen::Map<const Eigen::Vector3d>(values->data());
  gravity.bias_share = Eigen::Map<const RowMajor<3>>(values->data() + 3);
  gravity.sigma_rad = (*values)[12];
  return gravity;
}

}  // namespace glint::slam
