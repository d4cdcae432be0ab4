// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

namespace glint::slam {

/// Values that are read only, in memory or in a ColdFile; who reads does not see which. Copies
/// share them. Any thread may read.
template <class T>
class ColdArray {
  // Its bytes are all of it, as those of Eigen's small vectors.
  static_assert(std::is_standard_layout_v<T> && std::is_trivially_destructible_v<T>);

 public:
  using value_type = T;

  ColdArray() = default;
  // NOLINTNEXTLINE(google-explicit-constructor): a vector is one.
  ColdArray(std::vector<T> values)
      : ColdArray(std::make_shared<const std::vector<T>>(std::move(values))) {}
  /// `bytes` hold `count` values, aligned as they need.
  ColdArray(const std::shared_ptr<const std::byte>& bytes, std::size_t count)
      : memory_(bytes), values_(reinterpret_cast<const T*>(bytes.get()), count), cold_(true) {}

  [[nodiscard]] const T* data() const { return values_.data(); }
  [[nodiscard]] const T* begin() const { return values_.data(); }
  [[nodiscard]] const T* end() const { return values_.data() + values_.size(); }
  [[nodiscard]] std::size_t size() const { return values_.size(); }
  [[nodiscard]] bool empty() const { return values_.empty(); }
  const T& operator[](std::size_t i) const { return values_[i]; }
  /// In a file.
  [[nodiscard]] bool is_cold() const { return cold_; }

 private:
  explicit ColdArray(std::shared_ptr<const std::vector<T>> values) : values_(*values) {
    memory_ = std::move(values);
  }

  std::shared_ptr<const void> memory_;
  std::span<const T> values_;
  bool cold_ = false;
};

}  // namespace glint::slam
