// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "pcap/recording/inflater.hpp"

#include <bzlib.h>
#include <lz4frame.h>
#include <zstd.h>

#include <algorithm>
#include <array>
#include <limits>
#include <memory>
#include <span>

namespace glint::recording {
namespace {

/// Unpacked bytes granted for each packed one. Packets of a sensor shrink tenfold at most.
constexpr std::uint64_t kMaxRatio = 1000;
constexpr std::size_t kFirstBufferBytes = std::size_t{1} << 20U;

/// What a decoder made of the bytes and the space that it was given.
struct Step {
  std::size_t consumed = 0;
  std::size_t produced = 0;
  bool at_end = false;  ///< A stream is complete.
  bool failed = false;
};

class Bzip2Decoder {
 public:
  Bzip2Decoder() { failed_ = BZ2_bzDecompressInit(&stream_, 0, 0) != BZ_OK; }
  ~Bzip2Decoder() { BZ2_bzDecompressEnd(&stream_); }
  Bzip2Decoder(const Bzip2Decoder&) = delete;
  Bzip2Decoder& operator=(const Bzip2Decoder&) = delete;

  Step step(ByteSpan in, std::span<std::byte> out) {
    // libbz2 reads through a pointer to non-const, but writes nothing there.
    stream_.next_in = const_cast<char*>(reinterpret_cast<const char*>(in.data()));
    stream_.avail_in = clamp(in.size());
    stream_.next_out = reinterpret_cast<char*>(out.data());
    stream_.avail_out = clamp(out.size());
    const Step before{stream_.avail_in, stream_.avail_out};
    const int status = failed_ ? BZ_PARAM_ERROR : BZ2_bzDecompress(&stream_);
    return {before.consumed - stream_.avail_in, before.produced - stream_.avail_out,
            status == BZ_STREAM_END, status != BZ_OK && status != BZ_STREAM_END};
  }

 private:
  static unsigned clamp(std::size_t size) {
    return static_cast<unsigned>(std::min<std::size_t>(size, std::numeric_limits<int>::max()));
  }
  bz_stream stream_{};
  bool failed_ = false;
};

class Lz4Decoder {
 public:
  Lz4Decoder() {
    LZ4F_dctx* context = nullptr;
    if (LZ4F_isError(LZ4F_createDecompressionContext(&context, LZ4F_VERSION)) == 0) {
      context_.reset(context);
    }
  }
  Step step(ByteSpan in, std::span<std::byte> out) {
    if (context_ == nullptr) return {0, 0, false, true};
    std::size_t produced = out.size();
    std::size_t consumed = in.size();
    const std::size_t hint =
        LZ4F_decompress(context_.get(), out.data(), &produced, in.data(), &consumed, nullptr);
    if (LZ4F_isError(hint) != 0) return {0, 0, false, true};
    return {consumed, produced, hint == 0, false};
  }

 private:
  struct Free {
    void operator()(LZ4F_dctx* context) const { LZ4F_freeDecompressionContext(context); }
  };
  std::unique_ptr<LZ4F_dctx, Free> context_;
};

class ZstdDecoder {
 public:
  Step step(ByteSpan in, std::span<std::byte> out) {
    if (context_ == nullptr) return {0, 0, false, true};
    ZSTD_inBuffer from{in.data(), in.size(), 0};
    ZSTD_outBuffer to{out.data(), out.size(), 0};
    const std::size_t hint = ZSTD_decompressStream(context_.get(), &to, &from);
    return {from.pos, to.pos, hint == 0, ZSTD_isError(hint) != 0};
  }

 private:
  struct Free {
    void operator()(ZSTD_DStream* context) const { ZSTD_freeDStream(context); }
  };
  std::unique_ptr<ZSTD_DStream, Free> context_{ZSTD_createDStream()};
};

/// Unpacks into `buffer`, which grows as needed and is never shrunk.
template <class Decoder>
Inflated run(Decoder decoder, ByteSpan in, std::uint64_t limit, std::vector<std::byte>& buffer) {
  std::size_t produced = 0;
  while (true) {
    if (produced == buffer.size()) {
      // One byte beyond the limit lets a stream of just that size end.
      const std::uint64_t larger = std::max<std::uint64_t>(kFirstBufferBytes, 2 * produced);
      buffer.resize(static_cast<std::size_t>(std::min(limit + 1, larger)));
    }
    const std::size_t space = std::min<std::uint64_t>(buffer.size(), limit + 1) - produced;
    const Step step = decoder.step(in, std::span(buffer).subspan(produced, space));
    produced += step.produced;
    in = in.subspan(step.consumed);
    // A checksum that fails at the end leaves it open what before it is wrong.
    if (step.failed) return {};
    const bool too_large = produced > limit;
    const bool stuck = step.consumed == 0 && step.produced == 0;
    if (too_large || stuck || (step.at_end && in.empty())) {
      const std::uint64_t kept = std::min<std::uint64_t>(produced, limit);
      return {ByteSpan(buffer).first(static_cast<std::size_t>(kept)), step.at_end && !too_large};
    }
  }
}

}  // namespace

std::optional<Compression> compression_named(std::string_view name) {
  if (name.empty() || name == "none") return Compression::kNone;
  if (name == "bz2") return Compression::kBzip2;
  if (name == "lz4") return Compression::kLz4;
  if (name == "zstd") return Compression::kZstd;
  return std::nullopt;
}

bool is_zstd(ByteSpan bytes) {
  return as_text(bytes.first(std::min<std::size_t>(bytes.size(), 4))) == "\x28\xB5\x2F\xFD";
}

Inflated Inflater::inflate(Compression compression, ByteSpan packed) {
  if (compression == Compression::kNone) return {packed, true};
  allowance_ += kMaxRatio * packed.size();
  const std::uint64_t limit = std::min(kMaxChunkBytes, allowance_);
  Inflated inflated;
  if (compression == Compression::kBzip2) {
    inflated = run<Bzip2Decoder>({}, packed, limit, buffer_);
  } else if (compression == Compression::kLz4) {
    inflated = run<Lz4Decoder>({}, packed, limit, buffer_);
  } else {
    inflated = run<ZstdDecoder>({}, packed, limit, buffer_);
  }
  allowance_ -= inflated.bytes.size();
  return inflated;
}

}  // namespace glint::recording
