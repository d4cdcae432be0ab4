// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "tests/integration/glint_command.hpp"

#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <stdexcept>

namespace glint::test {

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
