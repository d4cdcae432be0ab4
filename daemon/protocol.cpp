// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "daemon/protocol.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

namespace glint::daemon {
namespace {

/// The name of one of this server's own codes; empty for JSON-RPC's.
std::string_view code_name(int code) {
  switch (code) {
    case kNotTracking:
      return "NOT_TRACKING";
    case kTooLarge:
      return "TOO_LARGE";
    case kBusy:
      return "BUSY";
    case kForbidden:
      return "FORBIDDEN";
    case kNoSuchMap:
      return "NO_SUCH_MAP";
    case kOutOfRange:
      return "OUT_OF_RANGE";
    case kNotConfigured:
      return "NOT_CONFIGURED";
    default:
      return "";
  }
}

/// Deepest nesting of brackets outside strings.
int nesting_depth(std::string_view text) {
  int depth = 0;
  int deepest = 0;
  bool in_string = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (in_string) {
      if (c == '\\') ++i;
      if (c == '"') in_string = false;
      continue;
    }
    if (c == '"') in_string = true;
    if (c == '{' || c == '[') deepest = std::max(deepest, ++depth);
    if (c == '}' || c == ']') --depth;
  }
  return deepest;
}

BadRequest invalid(Json id, const char* message) {
  return {std::move(id), RpcError(kInvalidRequest, message)};
}

std::string line_of(const Json& message) {
  // Strings come from parsed JSON or from us, but a file name may hold any bytes.
  return message.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

/// "12.5" seconds to nanoseconds; null when it is not that.
std::optional<std::int64_t> parse_time_string(std::string_view text) {
  const auto dot = text.find('.');
  const std::string_view whole = text.substr(0, dot);
  std::string fraction(dot == std::string_view::npos ? "" : text.substr(dot + 1));
  if (fraction.size() > 9 || whole.empty()) return std::nullopt;
  fraction.append(9 - fraction.size(), '0');
  std::int64_t seconds = 0;
  std::int64_t ns = 0;
  const auto digits = [](std::string_view s, std::int64_t& out) {
    const auto [end, error] = std::from_chars(s.data(), s.data() + s.size(), out);
    return error == std::errc{} && end == s.data() + s.size() && s.front() != '-';
  };
  // Beyond this many seconds nanoseconds pass 63 bits.
  constexpr std::int64_t kMaxSeconds = 9'000'000'000;
  if (!digits(whole, seconds) || !digits(fraction, ns) || seconds > kMaxSeconds)
    return std::nullopt;
  return seconds * kNsPerSecond + ns;
}

}  // namespace

RpcError::RpcError(int code, const std::string& message, std::string field, Json data)
    : std::runtime_error(message), code_(code), field_(std::move(field)), data_(std::move(data)) {}

Json RpcError::to_json() const {
  Json data = data_;
  if (const auto name = code_name(code_); !name.empty()) data["code"] = name;
  if (!field_.empty()) data["field"] = field_;
  Json out{{"code", code_}, {"message", what()}};
  if (!data.empty()) out["data"] = std::move(data);
  return out;
}

RpcError not_json() {
  return {kParseError,
          "not JSON: this server speaks JSON-RPC 2.0, one object a line, e.g. "
          "{\"jsonrpc\":\"2.0\",\"id\":1,\"method\":\"get_pose\"}"};
}

std::variant<Request, BadRequest> parse_request(std::string_view line) {
  if (nesting_depth(line) > kMaxDepth) {
    return invalid(nullptr, "the request is nested too deeply");
  }
  Json message = Json::parse(line, nullptr, /*allow_exceptions=*/false);
  if (message.is_discarded()) {
    return BadRequest{nullptr, not_json()};
  }
  if (message.is_array()) return invalid(nullptr, "batches are not supported: one object a line");
  if (!message.is_object()) return invalid(nullptr, "a request is a JSON object");

  Request request;
  if (const auto id = message.find("id"); id != message.end()) {
    if (!id->is_string() && !id->is_number() && !id->is_null()) {
      return invalid(nullptr, "id must be a number or a string");
    }
    request.has_id = true;
    request.id = *id;
  }
  const auto method = message.find("method");
  if (method == message.end() || !method->is_string()) {
    return invalid(request.id, "method is missing or no string");
  }
  request.method = method->get<std::string>();
  if (const auto params = message.find("params"); params != message.end()) {
    if (!params->is_object()) {
      return BadRequest{request.id, RpcError(kInvalidParams, "params must be an object", "params")};
    }
    request.params = std::move(*params);
  }
  return request;
}

std::string result_line(const Json& id, const Json& result) {
  return line_of(Json{{"jsonrpc", "2.0"}, {"id", id}, {"result", result}});
}

std::string error_line(const Json& id, const RpcError& error) {
  return line_of(Json{{"jsonrpc", "2.0"}, {"id", id}, {"error", error.to_json()}});
}

std::string notification_line(std::string_view method, const Json& params) {
  return line_of(Json{{"jsonrpc", "2.0"}, {"method", method}, {"params", params}});
}

std::string numbered_notification_line(std::string_view method, std::string_view params,
                                       std::uint64_t seq, std::uint64_t missed) {
  params.remove_suffix(1);
  return fmt::format(R"({{"jsonrpc":"2.0","method":"{}","params":{},"seq":{},"missed":{}}}}}{})",
                     method, params, seq, missed, '\n');
}

std::string time_string(std::int64_t ns) {
  const std::uint64_t size =
      ns < 0 ? ~static_cast<std::uint64_t>(ns) + 1 : static_cast<std::uint64_t>(ns);
  return fmt::format("{}{}.{:09}", ns < 0 ? "-" : "", size / 1'000'000'000U, size % 1'000'000'000U);
}

void put_time(Json& out, SensorTime time) {
  out["t_ns"] = time.ns;
  out["t"] = time_string(time.ns);
}

const Json* find_param(const Json& params, const char* name) {
  const auto found = params.find(name);
  return found == params.end() || found->is_null() ? nullptr : &*found;
}

double number_param(const Json& params, const char* name, double absent, double min, double max) {
  const Json* value = find_param(params, name);
  if (value == nullptr) return absent;
  const double number = value->is_number() ? value->get<double>() : NAN;
  if (!(number >= min && number <= max)) {
    throw RpcError(kInvalidParams, fmt::format("{} must be a number from {} to {}", name, min, max),
                   name);
  }
  return number;
}

std::string choice_param(const Json& params, const char* name, std::string_view choices) {
  const Json* value = find_param(params, name);
  if (value == nullptr) return std::string(choices.substr(0, choices.find('|')));
  if (value->is_string()) {
    auto text = value->get<std::string>();
    const std::string list = fmt::format("|{}|", choices);
    if (!text.empty() && list.find(fmt::format("|{}|", text)) != std::string::npos) return text;
  }
  throw RpcError(kInvalidParams, fmt::format("{} must be one of {}", name, choices), name);
}

std::optional<SensorTime> time_param(const Json& params, const std::string& name) {
  const std::string name_ns = name + "_ns";
  const Json* value = find_param(params, name_ns.c_str());
  if (value == nullptr) value = find_param(params, name.c_str());
  if (value == nullptr) return std::nullopt;
  if (value->is_number_unsigned() && value->get<std::uint64_t>() > INT64_MAX) value = nullptr;
  if (value != nullptr && value->is_number_integer()) return SensorTime{value->get<std::int64_t>()};
  if (value != nullptr && value->is_string()) {
    if (const auto ns = parse_time_string(value->get<std::string>())) return SensorTime{*ns};
  }
  throw RpcError(
      kInvalidParams,
      fmt::format("{} must be an integer of nanoseconds or a string \"sec.nnnnnnnnn\"", name_ns),
      name_ns);
}

}  // namespace glint::daemon
