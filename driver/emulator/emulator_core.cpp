// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "driver/emulator/emulator_core.hpp"

#include <chrono>
#include <utility>

namespace glint::emulator {

EmulatorCore::EmulatorCore(boost::asio::io_context& io, const EmulatedSensorOptions& options,
                           Clock clock, std::function<void(const EmulatedStream&)> on_stream)
    : clock_(clock), timer_(io), sensor_(options, clock, std::move(on_stream)) {}

EmulatedAnswer EmulatorCore::answer(const EmulatedRequest& request) {
  EmulatedAnswer answer = sensor_.answer(request);
  schedule();
  return answer;
}

std::string EmulatorCore::answer_line(std::string_view line, const std::string& client_address) {
  std::string answer = sensor_.answer_line(line, client_address);
  schedule();
  return answer;
}

std::optional<ControlFault> EmulatorCore::next_fault(std::string_view target) {
  if (faults_.count <= 0 || target.find(faults_.path) == std::string_view::npos) return {};
  --faults_.count;
  return faults_.fault;
}

void EmulatorCore::inject(ControlFaultPlan plan) { faults_ = std::move(plan); }

void EmulatorCore::schedule() {
  const std::optional<std::int64_t> due_ns = sensor_.update();
  if (!due_ns) {
    timer_.cancel();
    return;
  }
  timer_.expires_after(std::chrono::nanoseconds(*due_ns - clock_.monotonic_ns()));
  timer_.async_wait([this, alive = std::weak_ptr<int>(alive_)](boost::system::error_code error) {
    if (!error && !alive.expired()) schedule();
  });
}

}  // namespace glint::emulator
