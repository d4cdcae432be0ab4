// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
//
// glint train-vocabulary: a vocabulary of visual words from captures, for loop detection.
#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "daemon/cli/capture_input.hpp"
#include "daemon/cli/command.hpp"
#include "daemon/cli/scan_reader.hpp"
#include "driver/core/error.hpp"
#include "driver/core/xyz_lut.hpp"
#include "slam/features.hpp"
#include "slam/loops/vocabulary_trainer.hpp"
#include "slam/scan_images.hpp"

namespace glint::cli {
namespace {

using Images = std::vector<std::vector<slam::Descriptor>>;

struct TrainOptions {
  std::vector<std::string> captures;
  std::string out;
  std::vector<std::string> presets = {"paper", "full"};
  int every = 5;
  slam::VocabularyOptions tree;
};

/// Adds the descriptors of every n-th scan of a capture. Returns how many scans that were.
std::size_t add_images(const CaptureInput& input, const slam::SlamConfig& config, int every,
                       Images& images) {
  const SensorInfo info = load_capture_info(input);
  const auto source = open_capture(input, info);
  ScanReader reader(*source, info);
  slam::ImageFormer former(info, config);
  slam::FeatureExtractor extractor(info, config, std::make_shared<const XyzLut>(info));
  slam::ScanImages scan_images;
  slam::Features features;
  const std::size_t before = images.size();
  for (int scan_index = 0; const LidarScan* scan = reader.next(); ++scan_index) {
    // All of them, for the brightness is followed from scan to scan.
    former.form(*scan, scan_images);
    if (scan_index % every != 0 || scan->completeness() < config.min_completeness) continue;
    extractor.extract(scan_images, features);
    images.push_back(features.descriptors);
  }
  print_notices(source->notices());
  return images.size() - before;
}

void write_bytes(const std::filesystem::path& file, const std::vector<std::byte>& bytes) {
  std::ofstream out(file, std::ios::binary | std::ios::trunc);
  for (const std::byte byte : bytes) out.put(std::to_integer<char>(byte));
  out.close();
  if (!out) {
    throw InputError(
        fmt::format("{} cannot be written; choose another file with --out", file.string()));
  }
}

void train(const TrainOptions& options) {
  Images images;
  for (const std::string& capture : options.captures) {
    CaptureInput input;
    input.capture = capture;
    std::size_t scans = 0;
    for (const std::string& preset : options.presets) {
      scans = add_images(input, slam::preset_config(preset), options.every, images);
    }
    std::cout << fmt::format("{}: {} scans\n", capture, scans) << std::flush;
  }
  const slam::Vocabulary vocabulary = slam::train_vocabulary(images, options.tree);
  write_bytes(options.out, vocabulary.bytes());
  std::cout << fmt::format("{} words from {} images in {}, hash {:016x}\n", vocabulary.word_count(),
                           images.size(), options.out, vocabulary.hash());
}

}  // namespace

void add_train_vocabulary(CLI::App& app) {
  CLI::App* const command = app.add_subcommand(
      "train-vocabulary", "Make a vocabulary of visual words for slam.vocabulary from captures");
  const auto options = std::make_shared<TrainOptions>();
  command
      ->add_option("CAPTURE", options->captures,
                   "Captures or recordings, the metadata of each beside it")
      ->required();
  command->add_option("-o,--out", options->out, "File to write")->required();
  command->add_option("--preset", options->presets, "Whose keypoints: paper, full or both")
      ->check(CLI::IsMember({"paper", "full"}))
      ->capture_default_str();
  command->add_option("--every", options->every, "Take each n-th scan")
      ->check(CLI::Range(1, 10000))
      ->capture_default_str();
  command->add_option("--branching", options->tree.branching, "Children of a node of the tree")
      ->check(CLI::Range(2U, slam::Vocabulary::kMaxBranching))
      ->capture_default_str();
  command->add_option("--depth", options->tree.depth, "Levels of the tree")
      ->check(CLI::Range(1U, slam::Vocabulary::kMaxDepth))
      ->capture_default_str();
  command->callback([options] { train(*options); });
}

}  // namespace glint::cli
