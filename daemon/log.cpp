// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "daemon/log.hpp"

#include <fmt/format.h>
#include <spdlog/pattern_formatter.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>
#include <sys/stat.h>
#include <syslog.h>
#include <systemd/sd-journal.h>
#include <unistd.h>

#include <array>
#include <cstdlib>

#include "daemon/steady_clock.hpp"

namespace glint::daemon {
namespace {

constexpr std::int64_t kQuietNs = 10 * kNsPerSecond;
/// More than these are forgotten when their time is over: some causes quote what others wrote.
constexpr std::size_t kMostCauses = 100;

/// "<4>": how the journal learns the severity of a line (sd-daemon(3)).
class JournalPriority : public spdlog::custom_flag_formatter {
 public:
  void format(const spdlog::details::log_msg& message, const std::tm&,
              spdlog::memory_buf_t& out) override {
    const char digit = message.level >= spdlog::level::err    ? '3'
                       : message.level >= spdlog::level::warn ? '4'
                       : message.level >= spdlog::level::info ? '6'
                                                              : '7';
    out.push_back('<');
    out.push_back(digit);
    out.push_back('>');
  }
  [[nodiscard]] std::unique_ptr<custom_flag_formatter> clone() const override {
    return std::make_unique<JournalPriority>();
  }
};

/// Whether standard error is the journal's own stream (systemd.exec(5), JOURNAL_STREAM): the
/// variable alone may have been inherited by a program whose output goes elsewhere.
bool writes_to_journal() {
  const char* stream = std::getenv("JOURNAL_STREAM");
  struct stat info {};
  return stream != nullptr && ::fstat(STDERR_FILENO, &info) == 0 &&
         fmt::format("{}:{}", info.st_dev, info.st_ino) == stream;
}

}  // namespace

void set_up_logging(const std::string& level) {
  auto logger =
      std::make_shared<spdlog::logger>("glintd", std::make_shared<spdlog::sinks::stderr_sink_mt>());
  if (writes_to_journal()) {
    auto formatter = std::make_unique<spdlog::pattern_formatter>();
    formatter->add_flag<JournalPriority>('P').set_pattern("%P%v");
    logger->set_formatter(std::move(formatter));
  } else {
    logger->set_pattern("%Y-%m-%dT%H:%M:%S.%e %l: %v");
  }
  logger->flush_on(spdlog::level::info);
  spdlog::set_default_logger(std::move(logger));
  set_log_level(level);
}

void set_log_level(const std::string& level) { spdlog::set_level(spdlog::level::from_str(level)); }

void warn_of_counter(const std::string& text, const std::string& counter, std::uint64_t added,
                     std::uint64_t value) {
  if (!writes_to_journal()) return spdlog::warn("{}", text);
  if (!spdlog::should_log(spdlog::level::warn)) return;
  const std::array fields{fmt::format("MESSAGE={}", text), fmt::format("PRIORITY={}", LOG_WARNING),
                          fmt::format("GLINT_COUNTER={}", counter),
                          fmt::format("GLINT_ADDED={}", added),
                          fmt::format("GLINT_VALUE={}", value)};
  std::array<iovec, fields.size()> parts{};
  for (std::size_t i = 0; i < fields.size(); ++i) {
    // The call reads only.
    parts[i] = {const_cast<char*>(fields[i].data()), fields[i].size()};
  }
  if (sd_journal_sendv(parts.data(), static_cast<int>(parts.size())) < 0) spdlog::warn("{}", text);
}

bool LogLimiter::allow(const std::string& cause, std::int64_t now_ns) {
  if (last_ns_.size() > kMostCauses) {
    std::erase_if(last_ns_, [&](const auto& entry) { return now_ns - entry.second >= kQuietNs; });
  }
  const auto [last, fresh] = last_ns_.try_emplace(cause, now_ns);
  if (!fresh && now_ns - last->second < kQuietNs) return false;
  last->second = now_ns;
  return true;
}

}  // namespace glint::daemon
