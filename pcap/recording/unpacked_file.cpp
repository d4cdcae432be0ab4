// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "pcap/recording/unpacked_file.hpp"

#include <fmt/format.h>
#include <unistd.h>
#include <zstd.h>

#include <cerrno>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <memory>
#include <vector>

#include "driver/core/error.hpp"
#include "pcap/recording/input_file.hpp"

namespace glint::recording {
namespace {

/// Unpacked bytes granted for each packed one, and at all; packets shrink tenfold at most.
constexpr std::uint64_t kMaxRatio = 200;
constexpr std::uint64_t kMinAllowanceBytes = std::uint64_t{1} << 26U;

struct Free {
  void operator()(ZSTD_DStream* stream) const { ZSTD_freeDStream(stream); }
};

[[noreturn]] void no_room(const std::filesystem::path& packed) {
  throw InputError(
      fmt::format("There is no room to unpack {} in {}; name a folder with more in TMPDIR, or "
                  "unpack the file yourself with `zstd -d`.",
                  packed.string(), std::filesystem::temp_directory_path().string()));
}

}  // namespace

TemporaryFile::TemporaryFile() {
  std::error_code error;
  std::string name = (std::filesystem::temp_directory_path(error) / "glint-XXXXXX").string();
  const int descriptor = mkstemp(name.data());
  if (descriptor < 0) {
    throw InputError(
        fmt::format("No temporary file can be made ({}): {}; name a folder that can be "
                    "written in TMPDIR.",
                    name, std::strerror(errno)));
  }
  close(descriptor);
  path_ = name;
}

TemporaryFile::~TemporaryFile() {
  std::error_code ignored;
  std::filesystem::remove(path_, ignored);
}

UnpackedFile::UnpackedFile(const std::filesystem::path& packed) {
  InputFile from(packed);
  std::ofstream to(file_.path(), std::ios::binary);
  const std::unique_ptr<ZSTD_DStream, Free> stream(ZSTD_createDStream());
  const std::uint64_t allowance = kMinAllowanceBytes + kMaxRatio * from.size();
  std::uint64_t written = 0;
  std::size_t hint = 1;  // 0 at the end of a frame, after which another may come.
  std::vector<std::byte> in;
  std::vector<char> out(ZSTD_DStreamOutSize());
  const auto going = [&] { return ZSTD_isError(hint) == 0 && written <= allowance; };
  while (from.left() > 0 && going()) {
    from.read(ZSTD_DStreamInSize(), in);
    ZSTD_inBuffer source{in.data(), in.size(), 0};
    bool more = true;
    while (more && going()) {
      ZSTD_outBuffer sink{out.data(), out.size(), 0};
      hint = ZSTD_decompressStream(stream.get(), &sink, &source);
      if (!to.write(out.data(), static_cast<std::streamsize>(sink.pos))) no_room(packed);
      written += sink.pos;
      more = source.pos < source.size || (sink.pos == sink.size && hint != 0);
    }
  }
  if (!to.flush()) no_room(packed);
  if (hint == 0) return;
  const char* const why = ZSTD_isError(hint) != 0 ? ZSTD_getErrorName(hint)
                          : written > allowance   ? "it would take up improbably much"
                                                  : "it breaks off";
  problem_ =
      fmt::format("The recording {} cannot be unpacked to its end ({}); what came before is used.",
                  packed.string(), why);
}

}  // namespace glint::recording
