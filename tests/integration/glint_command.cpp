// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "tests/integration/glint_command.hpp"

#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstdio>
#include <stdexcept>

namespace glint::test {

GlintProcess::GlintProcess(const std::vector<std::string>& arguments) {
  std::array<int, 2> ends{};
  if (pipe(ends.data()) != 0) throw std::runtime_error("no pipe");
  std::vector<std::string> words = {GLINT_BINARY};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> line;
  for (std::string& word : words) line.push_back(word.data());
  line.push_back(nullptr);
  pid_ = fork();
  if (pid_ == 0) {
    dup2(ends[1], STDOUT_FILENO);
    dup2(ends[1], STDERR_FILENO);
    close(ends[0]);
    close(ends[1]);
    execv(line.front(), line.data());
    _exit(127);
  }
  close(ends[1]);
  output_ = ends[0];
}

GlintProcess::~GlintProcess() {
  if (pid_ > 0) {
    send_signal(SIGKILL);
    waitpid(pid_, nullptr, 0);
  }
  close(output_);
}

bool GlintProcess::read_more() {
  pollfd readable{output_, POLLIN, 0};
  std::array<char, 4096> buffer{};
  if (poll(&readable, 1, 20'000) <= 0) return false;
  const ssize_t size = read(output_, buffer.data(), buffer.size());
  if (size > 0) out_.append(buffer.data(), static_cast<std::size_t>(size));
  return size > 0;
}

void GlintProcess::wait_for(const std::string& text) {
  while (out_.find(text) == std::string::npos) {
    if (!read_more()) throw std::runtime_error("glint never printed '" + text + "': " + out_);
  }
}

int GlintProcess::number_after(const std::string& text) {
  wait_for(text);
  const std::size_t at = out_.find(text) + text.size();
  while (out_.find_first_not_of("0123456789", at) == std::string::npos && read_more()) {
  }
  return std::stoi(out_.substr(at));
}

void GlintProcess::send_signal(int signal) const { kill(pid_, signal); }

CommandResult GlintProcess::finish() {
  while (read_more()) {
  }
  int status = 0;
  waitpid(pid_, &status, 0);
  pid_ = -1;
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, out_};
}

CommandResult run_glint(const std::vector<std::string>& arguments) {
  std::string line = "exec " GLINT_BINARY;
  for (const std::string& argument : arguments) line += " '" + argument + "'";
  std::FILE* const pipe = popen((line + " 2>&1").c_str(), "r");
  if (pipe == nullptr) throw std::runtime_error("cannot run " + line);
  CommandResult result;
  std::array<char, 4096> buffer{};
  while (const std::size_t count = std::fread(buffer.data(), 1, buffer.size(), pipe)) {
    result.out.append(buffer.data(), count);
  }
  const int status = pclose(pipe);
  if (WIFEXITED(status)) result.exit_code = WEXITSTATUS(status);
  return result;
}

}  // namespace glint::test
