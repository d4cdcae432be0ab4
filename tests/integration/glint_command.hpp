// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <string>
#include <vector>

namespace glint::test {

/// How a run of `glint` ended.
struct CommandResult {
  int exit_code = -1;  ///< -1 when a signal ended it: it crashed.
  std::string out;     ///< Standard output and standard error.
};

/// A `glint` that runs beside the test. Ended with SIGKILL when its object goes away.
class GlintProcess {
 public:
  explicit GlintProcess(const std::vector<std::string>& arguments);
  ~GlintProcess();
  GlintProcess(const GlintProcess&) = delete;
  GlintProcess& operator=(const GlintProcess&) = delete;

  /// Reads what it prints until there is `text` in it. @throws std::runtime_error when it ends or
  /// 20 s have passed before, with what it printed.
  void wait_for(const std::string& text);
  /// The number that it printed right after `text`. @throws as above.
  int number_after(const std::string& text);
  void send_signal(int signal) const;
  /// Waits for its end.
  CommandResult finish();

 private:
  bool read_more();

  int pid_ = -1;
  int output_ = -1;
  std::string out_;
};

/// Runs the `glint` that was built with this test and waits for it.
CommandResult run_glint(const std::vector<std::string>& arguments);

}  // namespace glint::test
