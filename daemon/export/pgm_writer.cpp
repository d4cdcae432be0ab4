// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "daemon/export/pgm_writer.hpp"

#include <fmt/format.h>

#include <string>

#include "daemon/cli/text_file.hpp"
#include "driver/core/error.hpp"

namespace glint::cli {
namespace {

// What the map_server's own saver writes.
char grey_of(slam::FloorCell cell) {
  switch (cell) {
    case slam::FloorCell::kFree:
      return static_cast<char>(254);
    case slam::FloorCell::kOccupied:
      return 0;
    case slam::FloorCell::kUnknown:
      break;
  }
  return static_cast<char>(205);
}

std::string image_of(const slam::FloorPlanImage& plan) {
  std::string content =
      fmt::format("P5\n# {} m a pixel\n{} {}\n255\n", plan.cell_m, plan.width, plan.height);
  const auto width = static_cast<std::size_t>(plan.width);
  for (auto row = static_cast<std::size_t>(plan.height); row-- > 0;) {
    for (std::size_t column = 0; column < width; ++column) {
      content += grey_of(plan.cells[row * width + column]);
    }
  }
  return content;
}

}  // namespace

std::filesystem::path write_floor_plan(const std::filesystem::path& file,
                                       const slam::FloorPlanImage& plan) {
  std::filesystem::path description = file;
  description.replace_extension(".yaml");
  if (description == file) {
    throw InputError(file.string() + " is to be an image; give it another extension, such as .pgm");
  }
  write_text_file(file, image_of(plan));
  // 205 is darker than white by 0.1961: with a larger free_thresh unknown cells would count as
  // free.
  write_text_file(
      description,
      fmt::format("image: {}\nmode: trinary\nresolution: {}\norigin: [{}, {}, 0.0]\n"
                  "negate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n",
                  file.filename().string(), plan.cell_m, plan.origin_m.x(), plan.origin_m.y()));
  return description;
}

}  // namespace glint::cli
