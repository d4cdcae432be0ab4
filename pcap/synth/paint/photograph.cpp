// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "pcap/synth/paint/photograph.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <string_view>

#include "driver/core/error.hpp"

namespace glint::synth {
namespace {

constexpr int kMaxSide = 8192;
constexpr int kMaxValue = 65535;
// Comments included; a header without end is no header.
constexpr std::streamoff kMaxHeaderBytes = 65536;

class PgmReader {
 public:
  explicit PgmReader(const std::filesystem::path& file)
      : name_(file.string()), stream_(file, std::ios::binary) {
    if (!stream_) {
      throw InputError(fmt::format("cannot open photograph '{}': {}", name_, std::strerror(errno)));
    }
  }

  Photograph read() {
    char magic[2] = {};
    if (!stream_.read(magic, 2) || magic[0] != 'P' || magic[1] != '5') {
      fail("is not a binary PGM: it does not begin with 'P5'");
    }
    Photograph photograph;
    photograph.width = number("width", kMaxSide);
    photograph.height = number("height", kMaxSide);
    const int white = number("white value", kMaxValue);
    if (std::isspace(stream_.get()) == 0) fail("has no blank after its white value");

    const std::size_t count =
        static_cast<std::size_t>(photograph.width) * static_cast<std::size_t>(photograph.height);
    const std::size_t bytes_each = white > 255 ? 2 : 1;
    std::vector<char> row(static_cast<std::size_t>(photograph.width) * bytes_each);
    for (int y = 0; y < photograph.height; ++y) {
      if (!stream_.read(row.data(), static_cast<std::streamsize>(row.size()))) {
        fail(fmt::format("ends early: {} of {} rows are there", y, photograph.height));
      }
      if (y == 0) photograph.pixels.reserve(count);
      append(row, bytes_each, white, photograph.pixels);
    }
    return photograph;
  }

 private:
  [[noreturn]] void fail(std::string_view what) const {
    throw InputError(fmt::format("photograph '{}' {}", name_, what));
  }

  // The next byte of the header that is neither blank nor in a comment.
  int next_of_header(std::string_view wanted) {
    bool comment = false;
    while (true) {
      const int c = stream_.get();
      if (c == std::ifstream::traits_type::eof() || stream_.tellg() > kMaxHeaderBytes) {
        fail(fmt::format("ends before its {}", wanted));
      }
      if (comment) {
        comment = c != '\n' && c != '\r';
      } else if (c == '#') {
        comment = true;
      } else if (std::isspace(c) == 0) {
        return c;
      }
    }
  }

  int number(std::string_view what, int most) {
    int value = 0;
    int c = next_of_header(what);
    if (std::isdigit(c) == 0) fail(fmt::format("has no number for its {}", what));
    while (true) {
      value = 10 * value + (c - '0');
      if (value > most) break;
      if (std::isdigit(stream_.peek()) == 0) break;
      c = stream_.get();
    }
    if (value < 1 || value > most) {
      fail(fmt::format("has a {} that is not between 1 and {}", what, most));
    }
    return value;
  }

  static void append(const std::vector<char>& row, std::size_t bytes_each, int white,
                     std::vector<std::uint8_t>& pixels) {
    const auto byte = [&](std::size_t i) {
      return static_cast<int>(static_cast<unsigned char>(row[i]));
    };
    for (std::size_t i = 0; i < row.size(); i += bytes_each) {
      const int value = bytes_each == 2 ? 256 * byte(i) + byte(i + 1) : byte(i);
      pixels.push_back(
          static_cast<std::uint8_t>((255 * std::min(value, white) + white / 2) / white));
    }
  }

  std::string name_;
  std::ifstream stream_;
};

}  // namespace

Photograph load_pgm(const std::filesystem::path& file) { return PgmReader(file).read(); }

}  // namespace glint::synth
