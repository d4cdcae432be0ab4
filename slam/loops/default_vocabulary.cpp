// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
//
// config/vocabulary.glv, linked into the program as it is: see CMakeLists.txt.
#include "slam/loops/vocabulary.hpp"

extern "C" {
// The linker's names for the file's first byte and the one after its last.
extern const std::byte glint_vocabulary_start[] asm(
    "_binary_vocabulary_glv_start");  // NOLINT(modernize-avoid-c-arrays)
extern const std::byte glint_vocabulary_end[] asm(
    "_binary_vocabulary_glv_end");  // NOLINT(modernize-avoid-c-arrays)
}

namespace glint::slam {

std::shared_ptr<const Vocabulary> default_vocabulary() {
  static const std::shared_ptr<const Vocabulary> kVocabulary = std::make_shared<const Vocabulary>(
      Vocabulary::parse({glint_vocabulary_start, glint_vocabulary_end}, "the built-in vocabulary"));
  return kVocabulary;
}

std::shared_ptr<const Vocabulary> open_vocabulary(const std::filesystem::path& file) {
  if (file.empty()) return default_vocabulary();
  return std::make_shared<const Vocabulary>(Vocabulary::load(file));
}

}  // namespace glint::slam
