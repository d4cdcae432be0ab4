// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/store/power_cut_vfs.hpp"

#include <sqlite3.h>

#include <algorithm>
#include <cstring>
#include <map>
#include <new>
#include <random>
#include <string>
#include <vector>

#include "slam/store/test_session.hpp"

namespace glint::slam::test {
namespace {

// What a disk writes whole or not at all.
constexpr std::size_t kSectorBytes = 512;

/// A write that may be lost; without bytes: a truncation to `offset`.
struct Change {
  std::size_t offset = 0;
  std::string bytes;
  bool truncates = false;
};

void come_about(const Change& change, std::string& content) {
  if (change.truncates) {
    content.resize(change.offset);
    return;
  }
  content.resize(std::max(content.size(), change.offset + change.bytes.size()));
  content.replace(change.offset, change.bytes.size(), change.bytes);
}

/// A file as the disk knows it.
struct Image {
  std::string durable;
  bool has_name = false;  ///< That would be found after a cut.
  std::vector<Change> unsure;
};

}  // namespace

struct PowerCutDisk::State {
  explicit State(std::uint32_t seed) : random(seed) {}

  /// Whether the next operation still comes about.
  bool spend() {
    if (operations_left == 0) return false;
    if (operations_left > 0) --operations_left;
    return true;
  }

  sqlite3_vfs vfs{};
  sqlite3_vfs* real = nullptr;
  std::mt19937 random;
  int operations_left = -1;  ///< Negative: no end to them.
  std::map<std::string, Image> images;
};

namespace {

using State = PowerCutDisk::State;

/// What SQLite holds of an open file; the real one's object follows it in memory.
struct File {
  sqlite3_file base;
  State* state;
  Image* image;
  sqlite3_file* real;
};

File& file_of(sqlite3_file* file) { return *reinterpret_cast<File*>(file); }
sqlite3_file* real_of(sqlite3_file* file) { return file_of(file).real; }
const sqlite3_io_methods& methods_of(sqlite3_file* file) { return *real_of(file)->pMethods; }

int write(sqlite3_file* file, const void* data, int size, sqlite3_int64 offset) {
  File& f = file_of(file);
  if (!f.state->spend()) return SQLITE_IOERR_WRITE;
  if (f.image != nullptr) {
    f.image->unsure.push_back({static_cast<std::size_t>(offset),
                               {static_cast<const char*>(data), static_cast<std::size_t>(size)},
                               false});
  }
  return methods_of(file).xWrite(f.real, data, size, offset);
}

int truncate(sqlite3_file* file, sqlite3_int64 size) {
  File& f = file_of(file);
  if (!f.state->spend()) return SQLITE_IOERR_TRUNCATE;
  if (f.image != nullptr) f.image->unsure.push_back({static_cast<std::size_t>(size), {}, true});
  return methods_of(file).xTruncate(f.real, size);
}

// The real one need not be waited for.
int sync(sqlite3_file* file, int /*flags*/) {
  File& f = file_of(file);
  if (!f.state->spend()) return SQLITE_IOERR_FSYNC;
  if (f.image == nullptr) return SQLITE_OK;
  for (const Change& change : f.image->unsure) come_about(change, f.image->durable);
  f.image->unsure.clear();
  f.image->has_name = true;
  return SQLITE_OK;
}

constexpr sqlite3_io_methods kMethods{
    2,
    [](sqlite3_file* f) { return methods_of(f).xClose(real_of(f)); },
    [](sqlite3_file* f, void* to, int size, sqlite3_int64 at) {
      return methods_of(f).xRead(real_of(f), to, size, at);
    },
    write,
    truncate,
    sync,
    [](sqlite3_file* f, sqlite3_int64* size) { return methods_of(f).xFileSize(real_of(f), size); },
    [](sqlite3_file* f, int lock) { return methods_of(f).xLock(real_of(f), lock); },
    [](sqlite3_file* f, int lock) { return methods_of(f).xUnlock(real_of(f), lock); },
    [](sqlite3_file* f, int* held) { return methods_of(f).xCheckReservedLock(real_of(f), held); },
    [](sqlite3_file* f, int what, void* arg) {
      return methods_of(f).xFileControl(real_of(f), what, arg);
    },
    [](sqlite3_file* f) { return methods_of(f).xSectorSize(real_of(f)); },
    [](sqlite3_file* f) { return methods_of(f).xDeviceCharacteristics(real_of(f)); },
    [](sqlite3_file* f, int page, int size, int extend, void volatile** to) {
      return methods_of(f).xShmMap(real_of(f), page, size, extend, to);
    },
    [](sqlite3_file* f, int at, int count, int flags) {
      return methods_of(f).xShmLock(real_of(f), at, count, flags);
    },
    [](sqlite3_file* f) { methods_of(f).xShmBarrier(real_of(f)); },
    [](sqlite3_file* f, int remove) { return methods_of(f).xShmUnmap(real_of(f), remove); },
    nullptr,
    nullptr};

int open(sqlite3_vfs* vfs, const char* name, sqlite3_file* file, int flags, int* out_flags) {
  auto* state = static_cast<State*>(vfs->pAppData);
  auto* real = reinterpret_cast<sqlite3_file*>(reinterpret_cast<char*>(file) + sizeof(File));
  file->pMethods = nullptr;
  const bool existed = name != nullptr && std::filesystem::exists(name);
  const int result = state->real->xOpen(state->real, name, real, flags, out_flags);
  if (result != SQLITE_OK) return result;
  Image* image = nullptr;
  if (name != nullptr && (flags & (SQLITE_OPEN_MAIN_DB | SQLITE_OPEN_WAL)) != 0) {
    image = &state->images[name];
    if (existed && image->unsure.empty()) *image = {read_bytes(name), true, {}};
  }
  new (file) File{{&kMethods}, state, image, real};
  return SQLITE_OK;
}

}  // namespace

PowerCutDisk::PowerCutDisk(std::uint32_t seed) : state_(std::make_unique<State>(seed)) {
  state_->real = sqlite3_vfs_find("unix");
  state_->vfs = *state_->real;
  state_->vfs.szOsFile += static_cast<int>(sizeof(File));
  state_->vfs.zName = "power-cut";
  state_->vfs.pNext = nullptr;
  state_->vfs.pAppData = state_.get();
  state_->vfs.xOpen = open;
  sqlite3_vfs_register(&state_->vfs, 1);
}

PowerCutDisk::~PowerCutDisk() {
  sqlite3_vfs_unregister(&state_->vfs);
  sqlite3_vfs_register(state_->real, 1);
}

void PowerCutDisk::cut_after(int operations) { state_->operations_left = operations; }

bool PowerCutDisk::is_off() const { return state_->operations_left == 0; }

void PowerCutDisk::leave(const std::filesystem::path& file,
                         const std::filesystem::path& directory) {
  std::mt19937& random = state_->random;
  for (auto& [name, image] : state_->images) {
    if (!name.starts_with(file.string()) || (!image.has_name && random() % 2 == 0)) continue;
    std::string content = image.durable;
    std::ranges::shuffle(image.unsure, random);
    // From none to all of them, and of one only its first sectors.
    const std::size_t kept = random() % (image.unsure.size() + 1);
    for (std::size_t i = 0; i < kept; ++i) {
      Change change = image.unsure[i];
      if (i + 1 == kept) {
        const std::size_t sectors = change.bytes.size() / kSectorBytes;
        change.bytes.resize(std::min(change.bytes.size(), random() % (sectors + 1) * kSectorBytes));
      }
      come_about(change, content);
    }
    write_bytes(directory / std::filesystem::path(name).filename(), content);
  }
}

}  // namespace glint::slam::test
