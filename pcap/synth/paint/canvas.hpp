// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace glint::synth {

/// A place and size on a canvas, m.
struct Area {
  double u_m = 0.0;  ///< Lower left corner.
  double v_m = 0.0;
  double width_m = 0.0;
  double height_m = 0.0;

  /// The area less a margin on all sides.
  [[nodiscard]] Area inset(double margin_m) const {
    return {u_m + margin_m, v_m + margin_m, width_m - 2.0 * margin_m, height_m - 2.0 * margin_m};
  }
};

/// What is beyond a picture's edges: the edge goes on, or the whole picture comes again and again.
enum class Edges { kGoOn, kRepeat };

/// A picture of a surface's albedo (0 to 1) to draw on, in metres: u to the right, v upwards, the
/// origin in the lower left corner. What lies outside is not drawn, or, where edges repeat, comes
/// in again on the other side. Value type.
class Canvas {
 public:
  /// The sides of a canvas that repeats are rounded up to a power of two of texels.
  Canvas(double width_m, double height_m, double texel_m, double albedo,
         Edges edges = Edges::kGoOn);

  void fill(const Area& area, double albedo);
  /// The area's edge only, drawn inside it.
  void frame(const Area& area, double thickness_m, double albedo);
  void disc(double u_m, double v_m, double radius_m, double albedo);
  /// A straight stroke with round ends.
  void stroke(double u0_m, double v0_m, double u1_m, double v1_m, double thickness_m,
              double albedo);
  /// Multiplies an area by 1 + contrast * n, n a smooth noise in [-1, 1] with features of `size_m`
  /// (on a canvas that repeats: of about that size).
  void blotch(const Area& area, double size_m, double contrast, std::uint64_t seed);
  /// Any picture: its albedo by place.
  void paint(const Area& area, const std::function<double(double u_m, double v_m)>& albedo);

  [[nodiscard]] Area whole() const { return {0.0, 0.0, columns_ * texel_m_, rows_ * texel_m_}; }
  [[nodiscard]] double texel_m() const { return texel_m_; }
  [[nodiscard]] int columns() const { return columns_; }
  [[nodiscard]] int rows() const { return rows_; }
  [[nodiscard]] Edges edges() const { return edges_; }
  /// Row by row from v = 0.
  [[nodiscard]] std::span<const float> texels() const { return texels_; }

 private:
  /// Calls draw(texel, u_m, v_m) for each texel whose centre lies in the area, row by row.
  template <class Draw>
  void each(const Area& area, Draw&& draw);

  double texel_m_;
  int columns_;
  int rows_;
  Edges edges_;
  std::vector<float> texels_;
};

}  // namespace glint::synth
