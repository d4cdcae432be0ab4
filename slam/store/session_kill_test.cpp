// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
// The session file after its writer was killed.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <random>
#include <thread>

#include "slam/store/session_reader.hpp"
#include "slam/store/session_store.hpp"
#include "slam/store/test_session.hpp"

namespace glint::slam {
namespace {

using std::chrono::milliseconds;

std::int64_t steady_ns() {
  return std::chrono::steady_clock::now().time_since_epoch() / std::chrono::nanoseconds(1);
}
constexpr Clock kSteadyClock{&steady_ns, [] { return std::int64_t{0}; }};

/// What a writer and the one who kills it both see.
struct Board {
  static constexpr std::size_t kMost = 4096;
  std::atomic<std::size_t> count;                      ///< Keyframes added, ids from 0,
  std::array<std::atomic<std::int64_t>, kMost> added;  ///< and when, ns.
};

/// A process that writes a session until it is killed.
class Writer {
 public:
  explicit Writer(const std::filesystem::path& file)
      : board_(static_cast<Board*>(mmap(nullptr, sizeof(Board), PROT_READ | PROT_WRITE,
                                        MAP_SHARED | MAP_ANONYMOUS, -1, 0))),
        pid_(fork()) {
    if (pid_ == 0) write(file);
  }
  ~Writer() {
    if (!killed_) kill();
    munmap(board_, sizeof(Board));
  }
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;

  /// Returns when that was, ns.
  std::int64_t kill() {
    killed_ = true;
    const std::int64_t now_ns = steady_ns();
    ::kill(pid_, SIGKILL);
    waitpid(pid_, nullptr, 0);
    return now_ns;
  }
  /// How many it had added until then.
  [[nodiscard]] std::size_t added_before(std::int64_t time_ns) const {
    std::size_t count = 0;
    while (count < board_->count && board_->added[count] < time_ns) ++count;
    return count;
  }

 private:
  [[noreturn]] void write(const std::filesystem::path& file) const {
    SessionStore store(file, {.clock = kSteadyClock});
    for (std::uint64_t id = 0; id < Board::kMost; ++id) {
      store.add(test::sample_keyframe(id, 1000), {});
      board_->added[id] = steady_ns();
      board_->count = id + 1;
      if (id % 20 == 19) store.apply({{}, {test::sample_loop(id - 10, id)}, {}, {{id - 5, {}}}});
      std::this_thread::sleep_for(milliseconds(4));
      store.commit_if_due();
    }
    while (true) pause();
  }

  Board* board_;
  pid_t pid_;
  bool killed_ = false;
};

class SessionKill : public test::InDirectory {
 protected:
  // Keyframes in a session that must be whole, read and left as it is.
  [[nodiscard]] std::size_t sound_keyframes(const std::filesystem::path& file) const {
    const std::string before = files();
    const SessionReader session(file);
    std::size_t count = 0;
    session.for_each_keyframe([&](SessionKeyframe&& read) {
      EXPECT_EQ(read.keyframe.id, count) << "one is missing";
      EXPECT_EQ(read.keyframe.points.size(), 1000U);
      ++count;
    });
    EXPECT_EQ(session.odometry_edges().size(), count > 0 ? count - 1 : 0);
    EXPECT_EQ(files(), before);
    return count;
  }
};

TEST_F(SessionKill, HoldsEveryKeyframeOlderThanASecond) {
  std::mt19937 random(7);
  std::size_t lost = 0;
  for (int round = 0; round < 6; ++round) {
    std::vector<std::unique_ptr<Writer>> writers;
    const auto file = [&](std::size_t i) {
      return directory_ / fmt::format("{}-{}.glint", round, i);
    };
    for (std::size_t i = 0; i < 8; ++i) writers.push_back(std::make_unique<Writer>(file(i)));
    // Soon after the start, and when there are keyframes that must be there.
    std::this_thread::sleep_for(milliseconds(round < 4 ? random() % 500 : 1100 + random() % 500));
    for (std::size_t i = 0; i < writers.size(); ++i) {
      std::this_thread::sleep_for(milliseconds(random() % 60));
      const std::int64_t killed_ns = writers[i]->kill();
      // Killed before the file was made.
      if (!std::filesystem::exists(file(i))) continue;
      const std::size_t kept = sound_keyframes(file(i));
      EXPECT_GE(kept, writers[i]->added_before(killed_ns - 1'000'000'000));
      lost += writers[i]->added_before(killed_ns) - kept;
    }
  }
  EXPECT_GT(lost, 0U) << "no kill came at a bad moment";
}

TEST_F(SessionKill, ASessionGoesOnAfterItsWriterWasKilled) {
  Writer writer(file_);
  while (writer.added_before(steady_ns()) < 150) std::this_thread::sleep_for(milliseconds(10));
  writer.kill();
  const std::size_t kept = sound_keyframes(file_);
  EXPECT_GT(kept, 0U);
  {
    SessionStore store(file_, {.continues = true});
    Keyframe next = test::sample_keyframe(0);
    next.id = kept;
    store.add(next, {});
  }
  EXPECT_EQ(SessionReader(file_).keyframe_count(), kept + 1);
  EXPECT_EQ(files(), "session.glint ");
}

}  // namespace
}  // namespace glint::slam
