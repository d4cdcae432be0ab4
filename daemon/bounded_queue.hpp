// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <numeric>
#include <utility>
#include <vector>

namespace glint::daemon {

/// A queue of fixed capacity between one producer and one consumer thread. Elements are swapped in
/// and out of preallocated slots, so buffers inside them go round and nothing is allocated. The
/// slot freed last is filled first: buffers are made for the depth that the queue reaches, not for
/// its capacity, and are still in the processor's cache. close() wakes both sides. Thread-safe.
template <class T>
class BoundedQueue {
 public:
  explicit BoundedQueue(std::size_t capacity)
      : slots_(capacity), queued_(capacity), free_(capacity) {
    std::iota(free_.begin(), free_.end(), std::size_t{0});
  }

  /// Swaps `item` in, waiting for room. False when the queue is closed.
  bool push_wait(T& item) {
    std::unique_lock lock(mutex_);
    room_.wait(lock, [&] { return closed_ || size_ < slots_.size(); });
    return put(item, lock);
  }

  /// Swaps `item` in; when full, the oldest element is dropped and counted. False when closed.
  bool push_drop_oldest(T& item) {
    std::unique_lock lock(mutex_);
    if (!closed_ && size_ == slots_.size()) {
      free_oldest();
      ++dropped_;
    }
    return put(item, lock);
  }

  /// Swaps `item` in if there is room. False when full or closed.
  bool try_push(T& item) {
    std::unique_lock lock(mutex_);
    if (size_ == slots_.size()) return false;
    return put(item, lock);
  }

  enum class PopResult { kItem, kTimeout, kClosed };

  /// Swaps the oldest element out. After close() what is left is still handed out, then kClosed.
  PopResult pop(T& item, std::chrono::milliseconds timeout) {
    std::unique_lock lock(mutex_);
    items_.wait_for(lock, timeout, [&] { return closed_ || size_ > 0; });
    if (size_ == 0) return closed_ ? PopResult::kClosed : PopResult::kTimeout;
    std::swap(item, slots_[queued_[head_]]);
    free_oldest();
    lock.unlock();
    room_.notify_one();
    return PopResult::kItem;
  }

  void close() {
    {
      const std::lock_guard lock(mutex_);
      closed_ = true;
    }
    room_.notify_all();
    items_.notify_all();
  }

  [[nodiscard]] std::size_t size() const {
    const std::lock_guard lock(mutex_);
    return size_;
  }
  [[nodiscard]] std::size_t capacity() const { return slots_.size(); }
  /// Elements dropped by push_drop_oldest().
  [[nodiscard]] std::uint64_t dropped() const {
    const std::lock_guard lock(mutex_);
    return dropped_;
  }

 private:
  bool put(T& item, std::unique_lock<std::mutex>& lock) {
    if (closed_) return false;
    const std::size_t slot = free_.back();
    free_.pop_back();
    std::swap(item, slots_[slot]);
    queued_[(head_ + size_) % queued_.size()] = slot;
    ++size_;
    lock.unlock();
    items_.notify_one();
    return true;
  }

  void free_oldest() {
    free_.push_back(queued_[head_]);
    head_ = (head_ + 1) % queued_.size();
    --size_;
  }

  mutable std::mutex mutex_;
  std::condition_variable room_;
  std::condition_variable items_;
  std::vector<T> slots_;
  std::vector<std::size_t> queued_;  ///< Ring of slots, `size_` of them from `head_`.
  std::vector<std::size_t> free_;    ///< The other slots; the one freed last is the last.
  std::size_t head_ = 0;
  std::size_t size_ = 0;
  std::uint64_t dropped_ = 0;
  bool closed_ = false;
};

}  // namespace glint::daemon
