// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
//
// Stands in for libFuzzer in ordinary builds: feeds a target the files of the folders named.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <vector>

#include "tests/fuzz/require.hpp"

namespace {

std::vector<std::uint8_t> read_file(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<std::filesystem::path> files;
  for (int i = 1; i < argc; ++i) {
    for (const auto& entry : std::filesystem::directory_iterator(argv[i])) {
      files.push_back(entry.path());
    }
  }
  std::ranges::sort(files);
  if (files.empty()) {
    std::cerr << "no inputs; name a folder of tests/fuzz/corpus\n";
    return 1;
  }
  for (const auto& file : files) {
    std::cout << file.filename().string() << std::endl;  // Flushed: the last is the one that fails.
    // A copy of exactly its size on the heap, so that sanitizers see the first byte past it.
    const std::vector<std::uint8_t> bytes = read_file(file);
    LLVMFuzzerTestOneInput(bytes.data(), bytes.size());
  }
  std::cout << files.size() << " inputs\n";
  return 0;
}
