// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "driver/receive_batch.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <ctime>
#include <utility>

namespace glint {

std::uint32_t DropCount::added(std::uint32_t told) { return told - std::exchange(last_, told); }

ReceiveBatch::ReceiveBatch(std::size_t max_bytes)
    : max_bytes_(max_bytes),
      spill_(std::make_unique_for_overwrite<std::byte[]>(kMessages * max_bytes)),
      slots_(kMessages),
      messages_(kMessages) {
  for (std::size_t i = 0; i < kMessages; ++i) arm(i);
}

// Makes a slot ready for the kernel to write to.
void ReceiveBatch::arm(std::size_t i) {
  Slot& slot = slots_[i];
  slot.bytes.resize(largest_);
  slot.parts[0] = {slot.bytes.data(), slot.bytes.size()};
  slot.parts[1] = {spill_.get() + i * max_bytes_, max_bytes_ - slot.bytes.size()};
  msghdr& header = messages_[i].msg_hdr;
  header.msg_name = &slot.from;
  header.msg_namelen = sizeof slot.from;
  header.msg_iov = slot.parts.data();
  header.msg_iovlen = slot.parts.size();
  header.msg_control = slot.control.data();
  header.msg_controllen = slot.control.size();
  header.msg_flags = 0;
}

int ReceiveBatch::receive(int socket, const std::optional<SocketAddress>& source,
                          ReceiveCounters& counters) {
  // Only what the last call used was written to or swapped away.
  for (std::size_t i = 0; i < received_; ++i) arm(i);
  next_ = received_ = 0;
  const int count = recvmmsg(socket, messages_.data(), kMessages, MSG_DONTWAIT, nullptr);
  if (count < 0) return errno;
  received_ = static_cast<std::size_t>(count);
  for (std::size_t i = 0; i < received_; ++i) look_at(i, source, counters);
  skip_unwanted();
  return 0;
}

void ReceiveBatch::look_at(std::size_t i, const std::optional<SocketAddress>& source,
                           ReceiveCounters& counters) {
  Slot& slot = slots_[i];
  msghdr& header = messages_[i].msg_hdr;
  slot.time = {};
  for (cmsghdr* c = CMSG_FIRSTHDR(&header); c != nullptr; c = CMSG_NXTHDR(&header, c)) {
    if (c->cmsg_level != SOL_SOCKET) continue;
    if (c->cmsg_type == SCM_TIMESTAMPNS) {
      timespec time{};
      std::memcpy(&time, CMSG_DATA(c), sizeof time);
      slot.time = {time.tv_sec * kNsPerSecond + time.tv_nsec};
    } else if (c->cmsg_type == SO_RXQ_OVFL) {
      std::uint32_t drops = 0;
      std::memcpy(&drops, CMSG_DATA(c), sizeof drops);
      counters.kernel_drops += drops_.added(drops);
    }
  }
  const bool foreign = source && !SocketAddress::of(slot.from).matches(*source);
  const bool truncated = !foreign && (header.msg_flags & MSG_TRUNC) != 0;
  if (foreign) ++counters.foreign;
  if (truncated) ++counters.truncated;
  slot.wanted = !foreign && !truncated;
}

void ReceiveBatch::take(std::vector<std::byte>& bytes) {
  Slot& slot = slots_[next_];
  const std::size_t size = messages_[next_].msg_len;
  const std::size_t in_buffer = std::min(size, slot.bytes.size());
  slot.bytes.resize(in_buffer);
  const auto* const rest = static_cast<const std::byte*>(slot.parts[1].iov_base);
  slot.bytes.insert(slot.bytes.end(), rest, rest + (size - in_buffer));
  largest_ = std::max(largest_, size);
  std::swap(slot.bytes, bytes);
  ++next_;
  skip_unwanted();
}

void ReceiveBatch::skip_unwanted() {
  while (next_ < received_ && !slots_[next_].wanted) ++next_;
}

}  // namespace glint
