// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
//
// A vocabulary's bytes, little-endian:
//   "GLINTVOC"                  8 bytes
//   version, images, nodes      u32 each
//   of each node, breadth first: centre 32 bytes, number of children u8
//   of each leaf in the same order: training images that have its word, u16
//   CRC-64/XZ of all that       u64
// Which nodes are whose children follows from the order.
#include "slam/loops/vocabulary_file.hpp"

#include <fmt/format.h>

#include <cstring>
#include <fstream>
#include <iterator>
#include <limits>

#include "driver/core/bytes.hpp"
#include "driver/core/crc64.hpp"
#include "driver/core/error.hpp"

namespace glint::slam {
namespace {

constexpr std::string_view kMagic = "GLINTVOC";
constexpr std::uint32_t kVersion = 1;
constexpr std::size_t kHeader = 8 + 3 * sizeof(std::uint32_t);
constexpr std::size_t kNode = sizeof(Descriptor) + 1;
constexpr std::size_t kChecksum = sizeof(std::uint64_t);
// Of a file: sixteen times the default vocabulary.
constexpr std::size_t kLargest = std::size_t{8} << 20U;

class Writer {
 public:
  template <class T>
  void put(const T& value) {
    const std::size_t at = bytes_.size();
    bytes_.resize(at + sizeof value);
    std::memcpy(&bytes_[at], &value, sizeof value);
  }
  [[nodiscard]] std::vector<std::byte>& bytes() { return bytes_; }

 private:
  std::vector<std::byte> bytes_;
};

std::vector<std::byte> body(std::span<const Vocabulary::Node> nodes,
                            std::span<const std::uint32_t> images_with_word, std::uint32_t images) {
  Writer out;
  for (const char c : kMagic) out.put(c);
  out.put(kVersion);
  out.put(images);
  out.put(static_cast<std::uint32_t>(nodes.size()));
  for (const Vocabulary::Node& node : nodes) {
    out.put(node.centre);
    out.put(static_cast<std::uint8_t>(node.children));
  }
  for (const std::uint32_t having : images_with_word) {
    out.put(static_cast<std::uint16_t>(
        std::min<std::uint32_t>(having, std::numeric_limits<std::uint16_t>::max())));
  }
  return std::move(out.bytes());
}

[[noreturn]] void refuse(std::string_view name, std::string_view why) {
  throw InputError(fmt::format(
      "{} {}; make one with glint train-vocabulary, or leave slam.vocabulary empty for the "
      "built-in one",
      name, why));
}

// Gives nodes their children and leaves their words. False if they are no tree of known size.
bool link(std::vector<Vocabulary::Node>& nodes, std::size_t& leaves) {
  std::vector<std::uint32_t> depth(nodes.size(), 0U);
  std::uint64_t next = 1;
  leaves = 0;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    Vocabulary::Node& node = nodes[i];
    if (node.children == 0) {
      node.word = static_cast<std::uint32_t>(leaves++);
      continue;
    }
    // Children come after their parent, so that going down ends.
    if (next <= i || next + node.children > nodes.size() ||
        node.children > Vocabulary::kMaxBranching || depth[i] >= Vocabulary::kMaxDepth) {
      return false;
    }
    node.first_child = static_cast<std::uint32_t>(next);
    for (std::uint32_t c = 0; c < node.children; ++c) depth[next + c] = depth[i] + 1;
    next += node.children;
  }
  return next == nodes.size();
}

}  // namespace

std::uint64_t vocabulary_checksum(std::span<const Vocabulary::Node> nodes,
                                  std::span<const std::uint32_t> images_with_word,
                                  std::uint32_t images) {
  return crc64(body(nodes, images_with_word, images));
}

std::vector<std::byte> Vocabulary::bytes() const {
  std::vector<std::byte> all = body(nodes_, images_with_word_, images_);
  all.resize(all.size() + kChecksum);
  store(&all[all.size() - kChecksum], hash_);
  return all;
}

Vocabulary Vocabulary::parse(std::span<const std::byte> bytes, std::string_view name) {
  if (bytes.size() < kHeader + kChecksum ||
      std::memcmp(bytes.data(), kMagic.data(), kMagic.size()) != 0) {
    refuse(name, "is no vocabulary");
  }
  const auto version = glint::load<std::uint32_t>(&bytes[kMagic.size()]);
  if (version != kVersion) {
    refuse(name, fmt::format("is of version {}, which this program does not read", version));
  }
  const std::size_t end = bytes.size() - kChecksum;
  if (glint::load<std::uint64_t>(&bytes[end]) != crc64(bytes.first(end))) {
    refuse(name, "is damaged: its checksum is wrong");
  }
  const auto images = glint::load<std::uint32_t>(&bytes[kMagic.size() + 4]);
  const std::uint64_t count = glint::load<std::uint32_t>(&bytes[kMagic.size() + 8]);
  if (images == 0 || count == 0 || count > (end - kHeader) / kNode) {
    refuse(name, "is damaged: it is shorter than it says");
  }
  std::vector<Node> nodes(count);
  for (std::size_t i = 0; i < count; ++i) {
    const std::byte* const from = &bytes[kHeader + i * kNode];
    std::memcpy(nodes[i].centre.data(), from, sizeof(Descriptor));
    nodes[i].children = std::to_integer<std::uint32_t>(from[sizeof(Descriptor)]);
  }
  std::size_t leaves = 0;
  const std::size_t counts = kHeader + count * kNode;
  if (!link(nodes, leaves) || end - counts != leaves * sizeof(std::uint16_t)) {
    refuse(name, "is damaged: its nodes are no tree");
  }
  std::vector<std::uint32_t> images_with_word(leaves);
  for (std::size_t i = 0; i < leaves; ++i) {
    images_with_word[i] = glint::load<std::uint16_t>(&bytes[counts + 2 * i]);
    if (images_with_word[i] > images) refuse(name, "is damaged: a word is in too many images");
  }
  return {std::move(nodes), std::move(images_with_word), images};
}

Vocabulary Vocabulary::load(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) refuse(file.string(), "cannot be opened");
  std::vector<char> text;
  constexpr std::size_t kPiece = 1U << 16U;
  while (in && text.size() <= kLargest) {
    const std::size_t had = text.size();
    text.resize(had + kPiece);
    in.read(&text[had], kPiece);
    text.resize(had + static_cast<std::size_t>(in.gcount()));
  }
  if (in.bad()) refuse(file.string(), "cannot be read");
  if (text.size() > kLargest) refuse(file.string(), "is too large to be a vocabulary");
  return parse(std::as_bytes(std::span(text)), file.string());
}

}  // namespace glint::slam
