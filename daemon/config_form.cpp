// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "daemon/config_form.hpp"

#include <arpa/inet.h>
#include <sys/un.h>

#include <algorithm>
#include <array>
#include <regex>

#include "daemon/host_port.hpp"

namespace glint::daemon {
namespace {

constexpr unsigned kFirstMulticast4 = 224;
constexpr unsigned kLastMulticast4 = 239;
constexpr unsigned char kMulticast6 = 0xFF;

/// The bytes of an IPv4 or IPv6 address, the interface after % left out; empty if it is none.
std::vector<unsigned char> address_bytes(const std::string& text) {
  std::vector<unsigned char> bytes(sizeof(in_addr));
  if (inet_pton(AF_INET, text.c_str(), bytes.data()) == 1) return bytes;
  bytes.resize(sizeof(in6_addr));
  const std::string without_interface = text.substr(0, text.find('%'));
  if (inet_pton(AF_INET6, without_interface.c_str(), bytes.data()) == 1) return bytes;
  return {};
}

bool is_address(const std::string& text) { return !address_bytes(text).empty(); }

bool is_group(const std::string& text) {
  const auto bytes = address_bytes(text);
  if (bytes.size() == sizeof(in6_addr)) return bytes.front() == kMulticast6;
  return !bytes.empty() && bytes.front() >= kFirstMulticast4 && bytes.front() <= kLastMulticast4;
}

bool is_multiplier(double value) {
  constexpr std::array kMultipliers = {0.0, 0.25, 0.5, 1.0, 2.0, 3.0};
  return std::ranges::find(kMultipliers, value) != kMultipliers.end();
}

using Text = const std::string&;

struct Form {
  std::string_view key;
  std::string_view words;
  bool (*has)(const Json& value);
};

/// Of a string; the empty one always has the form.
template <bool (*Has)(Text)>
bool of_text(const Json& value) {
  const auto& text = value.get_ref<Text>();
  return text.empty() || Has(text);
}

constexpr std::array kForms{
    Form{"sensor.udp_dest", "\"auto\", an IP address, or empty",
         of_text<[](Text t) { return t == "auto" || is_address(t); }>},
    Form{"sensor.source_address", "\"any\", an IP address, or empty",
         of_text<[](Text t) { return t == "any" || is_address(t); }>},
    Form{"sensor.bind_address", "an IP address of this machine, or empty", of_text<is_address>},
    Form{"sensor.multicast_group", "an address of a multicast group, or empty", of_text<is_group>},
    Form{"sensor.lidar_mode", "COLUMNSxRATE, such as 1024x10, or empty",
         of_text<[](Text t) { return std::regex_match(t, std::regex("[0-9]{2,5}x[0-9]{1,3}")); }>},
    Form{"sensor.timestamp_mode",
         "TIME_FROM_INTERNAL_OSC, TIME_FROM_SYNC_PULSE_IN, TIME_FROM_PTP_1588, or empty",
         of_text<[](Text t) {
           return t == "TIME_FROM_INTERNAL_OSC" || t == "TIME_FROM_SYNC_PULSE_IN" ||
                  t == "TIME_FROM_PTP_1588";
         }>},
    Form{"sensor.operating_mode", "NORMAL, STANDBY, or empty",
         of_text<[](Text t) { return t == "NORMAL" || t == "STANDBY"; }>},
    Form{"sensor.signal_multiplier", "0, 0.25, 0.5, 1, 2 or 3",
         [](const Json& value) { return is_multiplier(value.get<double>()); }},
    Form{"server.listen", "HOST:PORT, such as 127.0.0.1:7788 or [::1]:7788, or empty",
         of_text<[](Text t) { return parse_host_port(t).has_value(); }>},
    Form{"metrics.listen", "HOST:PORT, such as 127.0.0.1:7789, or empty",
         of_text<[](Text t) { return parse_host_port(t).has_value(); }>},
    Form{"server.unix_socket", "\"auto\", a path of at most 107 bytes, or empty",
         of_text<[](Text t) { return t.size() < sizeof(sockaddr_un::sun_path); }>},
};

const Form* find_form(std::string_view key) {
  const auto* found = std::ranges::find(kForms, key, &Form::key);
  return found == kForms.end() ? nullptr : found;
}

}  // namespace

std::string_view config_form(std::string_view key) {
  const Form* form = find_form(key);
  return form == nullptr ? std::string_view() : form->words;
}

bool has_config_form(std::string_view key, const Json& value) {
  const Form* form = find_form(key);
  return form == nullptr || form->has(value);
}

}  // namespace glint::daemon
