// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "daemon/cli/terminal_screen.hpp"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <string_view>

#include "daemon/cli/command.hpp"

namespace glint::cli {
namespace {

volatile std::sig_atomic_t leave_asked = 0;

void ask_to_leave(int) { leave_asked = 1; }

void write_all(std::string_view text) {
  while (!text.empty()) {
    const ssize_t written = ::write(STDOUT_FILENO, text.data(), text.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return;  // A terminal that is gone: SIGHUP says so.
    text.remove_prefix(static_cast<std::size_t>(written));
  }
}

/// The line's first `columns` characters. What a sensor or a file name brought along may not steer
/// the terminal.
std::string fitting(std::string_view line, std::size_t columns) {
  std::string out;
  std::size_t used = 0;
  for (const char c : line) {
    const auto byte = static_cast<unsigned char>(c);
    const bool continues = (byte & 0xC0U) == 0x80U;  // Of a character in UTF-8.
    if (!continues && ++used > columns) break;
    out += byte < 0x20 || byte == 0x7F ? '?' : c;
  }
  return out;
}

}  // namespace

TerminalScreen::TerminalScreen() {
  if (isatty(STDIN_FILENO) == 0 || isatty(STDOUT_FILENO) == 0 ||
      tcgetattr(STDIN_FILENO, &before_) != 0) {
    throw UsageError(
        "--monitor needs a terminal; without one use glint watch, or glint status --json");
  }
  leave_asked = 0;
  struct sigaction action {};
  action.sa_handler =
      ask_to_leave;  // Without SA_RESTART: what waits is to look whether it goes on.
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) sigaction(signal, &action, nullptr);
  termios quiet = before_;
  quiet.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);
  quiet.c_cc[VMIN] = 0;
  quiet.c_cc[VTIME] = 0;
  tcsetattr(STDIN_FILENO, TCSANOW, &quiet);
  write_all("\x1b[?1049h\x1b[?25l");  // The other screen, no cursor.
}

TerminalScreen::~TerminalScreen() {
  write_all("\x1b[?25h\x1b[?1049l");
  tcsetattr(STDIN_FILENO, TCSANOW, &before_);
}

void TerminalScreen::show(const std::vector<std::string>& lines) const {
  winsize size{};
  if (ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_row == 0) size = {24, 80, 0, 0};
  const std::size_t rows = std::min<std::size_t>(lines.size(), size.ws_row);
  std::string frame = "\x1b[H";
  for (std::size_t i = 0; i < rows; ++i) {
    frame += fitting(lines[i], size.ws_col) + "\x1b[K";
    if (i + 1 < rows) frame += "\n";
  }
  write_all(frame + "\x1b[J");
}

bool TerminalScreen::leaving() const {
  std::array<char, 64> keys{};
  const ssize_t got = ::read(STDIN_FILENO, keys.data(), keys.size());
  for (ssize_t i = 0; i < got; ++i) {
    if (keys[static_cast<std::size_t>(i)] == 'q') leave_asked = 1;
  }
  return leave_asked != 0;
}

}  // namespace glint::cli
