// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "pcap/recording/whole_pages_vfs.hpp"

#include <sqlite3.h>

#include <array>
#include <cstddef>
#include <new>

namespace glint::recording {
namespace {

/// What is kept of each database file, behind SQLite's own object.
struct State {
  sqlite3_io_methods methods;  ///< The file's own but for one.
  const sqlite3_io_methods* original;
  sqlite3_int64 page_bytes;
};

sqlite3_vfs& parent() {
  static sqlite3_vfs* const vfs = sqlite3_vfs_find(nullptr);
  return *vfs;
}

std::size_t state_offset() {
  const auto size = static_cast<std::size_t>(parent().szOsFile);
  return (size + alignof(State) - 1) / alignof(State) * alignof(State);
}

std::byte* state_place(sqlite3_file* file) {
  return reinterpret_cast<std::byte*>(file) + state_offset();
}

int whole_pages_size(sqlite3_file* file, sqlite3_int64* size) {
  const State& state = *std::launder(reinterpret_cast<State*>(state_place(file)));
  const int status = state.original->xFileSize(file, size);
  *size -= *size % state.page_bytes;
  return status;
}

/// As the file's header says; 1 if it is too short to have one.
sqlite3_int64 page_bytes_of(sqlite3_file* file) {
  constexpr sqlite3_int64 kPageSizeAt = 16;
  std::array<unsigned char, 2> written{};
  if (file->pMethods->xRead(file, written.data(), 2, kPageSizeAt) != SQLITE_OK) return 1;
  const int size = (written[0] << 8) | written[1];
  if (size == 1) return 65536;
  return size == 0 ? 1 : size;
}

int open_file(sqlite3_vfs* /*vfs*/, const char* name, sqlite3_file* file, int flags,
              int* flags_used) {
  const int status = parent().xOpen(&parent(), name, file, flags, flags_used);
  if (status != SQLITE_OK || (flags & SQLITE_OPEN_MAIN_DB) == 0) return status;
  auto* const state =
      new (state_place(file)) State{*file->pMethods, file->pMethods, page_bytes_of(file)};
  state->methods.xFileSize = whole_pages_size;
  file->pMethods = &state->methods;
  return status;
}

}  // namespace

const char* whole_pages_vfs() {
  static sqlite3_vfs vfs;
  static const bool registered = [] {
    if (sqlite3_initialize() != SQLITE_OK || sqlite3_vfs_find(nullptr) == nullptr) return false;
    vfs = parent();
    vfs.zName = "glint-whole-pages";
    vfs.szOsFile = static_cast<int>(state_offset() + sizeof(State));
    vfs.xOpen = open_file;
    return sqlite3_vfs_register(&vfs, 0) == SQLITE_OK;
  }();
  return registered ? vfs.zName : nullptr;
}

}  // namespace glint::recording
