// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "daemon/doctor/proc_text.hpp"

#include <algorithm>
#include <charconv>

namespace glint::daemon {
namespace {

std::string_view take_line(std::string_view& text) {
  const std::size_t end = std::min(text.find('\n'), text.size());
  const std::string_view line = text.substr(0, end);
  text.remove_prefix(std::min(end + 1, text.size()));
  return line;
}

std::vector<std::string_view> words(std::string_view line) {
  std::vector<std::string_view> result;
  while (true) {
    const std::size_t begin = line.find_first_not_of(" \t");
    if (begin == std::string_view::npos) return result;
    const std::size_t end = std::min(line.find_first_of(" \t", begin), line.size());
    result.push_back(line.substr(begin, end - begin));
    line.remove_prefix(end);
  }
}

template <class Number>
std::optional<Number> number(std::string_view text, int base = 10) {
  Number value{};
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value, base);
  if (error != std::errc() || stop != end) return std::nullopt;
  return value;
}

}  // namespace

std::optional<std::uint64_t> parse_snmp(std::string_view text, std::string_view protocol,
                                        std::string_view counter) {
  // Two lines a protocol: the names, then the values in the same places.
  std::vector<std::string_view> names;
  while (!text.empty()) {
    std::vector<std::string_view> row = words(take_line(text));
    const bool ours = !row.empty() && row.front().ends_with(':') &&
                      row.front().substr(0, row.front().size() - 1) == protocol;
    if (!ours) continue;
    if (names.empty()) {
      names = std::move(row);
      continue;
    }
    const auto found = std::ranges::find(names, counter);
    const auto place = static_cast<std::size_t>(found - names.begin());
    if (found == names.end() || place >= row.size()) return std::nullopt;
    return number<std::uint64_t>(row[place]);
  }
  return std::nullopt;
}

std::vector<UdpSocketEntry> parse_udp_sockets(std::string_view text) {
  constexpr std::size_t kLocalAddress = 1;
  constexpr std::size_t kInode = 9;
  constexpr std::size_t kDrops = 12;
  std::vector<UdpSocketEntry> entries;
  while (!text.empty()) {
    const std::vector<std::string_view> row = words(take_line(text));
    if (row.size() <= kDrops) continue;
    const std::string_view local = row[kLocalAddress];
    const std::size_t colon = local.rfind(':');
    if (colon == std::string_view::npos) continue;
    const auto port = number<std::uint16_t>(local.substr(colon + 1), 16);
    const auto inode = number<std::uint64_t>(row[kInode]);
    const auto drops = number<std::uint64_t>(row[kDrops]);
    if (port && inode && drops) entries.push_back({*port, *inode, *drops});
  }
  return entries;
}

std::optional<std::int64_t> parse_number(std::string_view text) {
  const auto row = words(take_line(text));
  return row.size() == 1 ? number<std::int64_t>(row.front()) : std::nullopt;
}

}  // namespace glint::daemon
