// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <termios.h>

#include <string>
#include <vector>

namespace glint::cli {

/// Takes the whole terminal, by ANSI's sequences, for as long as it lives; then the terminal is as
/// it was. SIGINT, SIGTERM, SIGHUP and the key q ask to leave. One at a time; thread-compatible.
class TerminalScreen {
 public:
  /// @throws UsageError when standard input or output is no terminal.
  TerminalScreen();
  ~TerminalScreen();
  TerminalScreen(const TerminalScreen&) = delete;
  TerminalScreen& operator=(const TerminalScreen&) = delete;

  /// Shows `lines` from the top on, cut to what the terminal has room for now.
  void show(const std::vector<std::string>& lines) const;
  /// Whether somebody asked to leave.
  [[nodiscard]] bool leaving() const;

 private:
  termios before_{};
};

}  // namespace glint::cli
