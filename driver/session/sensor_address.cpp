// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "driver/session/sensor_address.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "driver/core/error.hpp"

namespace glint {
namespace {

[[noreturn]] void reject(std::string_view text) {
  throw InputError(fmt::format(
      "sensor host '{}' is no address: write a name such as os-122246000293.local, an IPv4 address "
      "or an IPv6 address in brackets, if need be with :PORT",
      text));
}

std::uint16_t parse_port(std::string_view port, std::string_view text) {
  std::uint16_t number = 0;
  const char* const end = port.data() + port.size();
  const auto parsed = std::from_chars(port.data(), end, number);
  if (parsed.ec != std::errc() || parsed.ptr != end || number == 0) reject(text);
  return number;
}

bool fits_a_host(char c) { return c > ' ' && c <= '~' && std::string_view("/@?#[]").find(c) > 5; }

}  // namespace

SensorAddress parse_sensor_address(std::string_view text) {
  SensorAddress address;
  std::string_view host = text;
  std::string_view rest;
  if (text.starts_with('[')) {
    const auto close = text.find(']');
    if (close == std::string_view::npos) reject(text);
    host = text.substr(1, close - 1);
    rest = text.substr(close + 1);
  } else if (std::ranges::count(text, ':') == 1) {
    host = text.substr(0, text.find(':'));
    rest = text.substr(text.find(':'));
  }
  if (!rest.empty() && !rest.starts_with(':')) reject(text);
  if (!rest.empty()) address.http_port = parse_port(rest.substr(1), text);
  if (host.empty() || !std::ranges::all_of(host, fits_a_host)) reject(text);
  address.host = host;
  return address;
}

}  // namespace glint
