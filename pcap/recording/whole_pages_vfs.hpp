// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

namespace glint::recording {

/// Name of a way for SQLite to open files (a "VFS") in which a database that is cut within a page
/// ends with the last whole one. SQLite would take the rest of that page to be zeros, and hand out
/// rows of which the end is wrong. Otherwise as the default one. Null if it cannot be had, which
/// stands for the default one. Thread-safe.
const char* whole_pages_vfs();

}  // namespace glint::recording
