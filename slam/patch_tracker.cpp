// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/patch_tracker.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <tuple>
#include <utility>

namespace glint::slam {
namespace {

constexpr std::size_t kMostPatches = 60;
// With fewer, new ones are looked for in each scan: of those in motion a good third looks alike, a
// dozen of which is needed. With 30 a drive in a tunnel with 16 beams ended DEGRADED.
constexpr std::size_t kEnoughToSpare = 45;
constexpr int kPatchSectors = 8;
constexpr int kMostInSector = 12;
constexpr int kOldest_scans = 25;
constexpr int kApart_px = 10;
constexpr int kApartRows = 3;
constexpr int kCandidateStep = 2;
constexpr double kNearest_m = 0.7;
constexpr double kFarthestPatch_m = 30.0;
// Of a surface's range within a patch: how far its ends may lie off the middle, as a share of it.
constexpr double kBend = 0.02;
// Grey levels a pixel; what noise does not reach when three rows or columns are averaged.
constexpr float kLeastGradient = 10.0F;
// Cosine between the gradient and the way that a move along the weak axis shifts the image.
constexpr float kLeastAlignment = 0.7F;
constexpr float kLeastDeviation = 6.0F;
// Correlation of what still looks alike; of what is kept.
constexpr double kAlike = 0.7;
constexpr double kKept = 0.5;
constexpr double kAddsUp = 0.3;
constexpr double kRangeSlack_m = 0.2;
constexpr double kRangeSlackShare = 0.03;
// A search with fewer would find anything.
constexpr std::size_t kFewestToSearch = 8;
constexpr double kSearch_m = 0.32;
constexpr double kCoarse_m = 0.04;
constexpr double kFine_m = 0.01;
// So many neighbouring pixels say the same.
constexpr double kAlikePixels = 12.0;
constexpr double kVarianceFloor = 0.1;

bool translates(const WeakAxis& axis) { return !axis.rotation; }

int sector_of(const Eigen::Vector3d& point_m) {
  const double turn = std::atan2(point_m.y(), point_m.x()) / (2.0 * std::numbers::pi);
  return static_cast<int>((turn + 1.0) * kPatchSectors) % kPatchSectors;
}

// To zero mean and unit variance; gives the deviation.
template <class Values>
float normalize(Values& values) {
  values.array() -= values.mean();
  const float deviation = std::sqrt(values.squaredNorm() / static_cast<float>(values.size()));
  if (deviation > 0.0F) values /= deviation;
  return deviation;
}

}  // namespace

PatchTracker::PatchTracker(const SensorInfo& info, std::shared_ptr<const XyzLut> lut)
    : projection_(info), lut_(std::move(lut)), shift_(info.pixel_shift_by_row) {
  patches_.reserve(kMostPatches);
}

void PatchTracker::observe(const ScanImages& images, std::span<const Pose> T_reference_column) {
  images_ = &images;
  T_reference_column_ = T_reference_column;
}

// Where the scan's columns look at the patch from; false where something else is in front of it.
bool PatchTracker::in_sight(const Patch& patch, const Pose& T_scan_odom,
                            Pose& T_column_scan) const {
  const Eigen::Vector3d middle_m = T_scan_odom * patch.points_m[kPixels / 2];
  ImageProjection::Place place;
  if (!projection_.project(middle_m, place)) return false;
  T_column_scan = {};
  if (!T_reference_column_.empty()) {
    const auto column = static_cast<std::size_t>(projection_.column_at(place));
    T_column_scan = T_reference_column_[column].inverse();
  }
  const Eigen::Vector3d there_m = T_column_scan * middle_m;
  const double range_m = projection_.range_of_m(there_m);
  const double off_m = std::abs(range_m - projection_.range_near_m(images_->range_mm, there_m));
  return off_m < kRangeSlack_m + kRangeSlackShare * range_m;
}

bool PatchTracker::look(const Patch& patch, const Pose& T_odom_scan, bool jacobian,
                        Look& seen) const {
  const Pose T_scan_odom = T_odom_scan.inverse();
  Pose T_column_scan;
  if (!in_sight(patch, T_scan_odom, T_column_scan)) return false;
  const Eigen::Matrix3d R_column_scan = T_column_scan.rotation.toRotationMatrix();
  const Pose T_column_odom = T_column_scan * T_scan_odom;
  const Eigen::Matrix3d R_column_odom = T_column_odom.rotation.toRotationMatrix();
  ImageProjection::Sample sample;
  for (std::size_t i = 0; i < kPixels; ++i) {
    const Eigen::Vector3d point_m = R_column_odom * patch.points_m[i] + T_column_odom.translation_m;
    if (!projection_.sample(images_->brightness, point_m, sample)) return false;
    const auto row = static_cast<Eigen::Index>(i);
    seen.values(row) = sample.value;
    if (!jacobian) continue;
    // x = T^-1 p; of T exp(d) it is x - d_t - d_r x x.
    const Eigen::Vector3f g = R_column_scan.transpose().cast<float>() * sample.gradient;
    const Eigen::Vector3f x = (T_scan_odom * patch.points_m[i]).cast<float>();
    seen.jacobian.row(row) << -g.transpose(), g.cross(x).transpose();
  }
  seen.deviation = normalize(seen.values);
  if (seen.deviation < kLeastDeviation) return false;
  if (jacobian) {
    seen.jacobian.rowwise() -= seen.jacobian.colwise().mean().eval();
    seen.jacobian /= seen.deviation;
  }
  return true;
}

// Sum of what the patches' middle lines look alike by.
double PatchTracker::likeness(const Pose& T_odom_scan) const {
  using LineValues = Eigen::Matrix<float, 2 * kHalfWidth + 1, 1>;
  constexpr std::size_t kFirst = kPixels / 2 - kHalfWidth;
  const Pose T_scan_odom = T_odom_scan.inverse();
  Pose T_column_scan;
  LineValues seen;
  double sum = 0.0;
  for (const Patch& patch : patches_) {
    if (!in_sight(patch, T_scan_odom, T_column_scan)) continue;
    const Pose T_column_odom = T_column_scan * T_scan_odom;
    if (!projection_.values_between(images_->brightness, T_column_odom * patch.points_m[kFirst],
                                    T_column_odom * patch.points_m[kPixels / 2 + kHalfWidth],
                                    {seen.data(), static_cast<std::size_t>(seen.size())})) {
      continue;
    }
    if (normalize(seen) < kLeastDeviation) continue;
    LineValues then = patch.values.segment<2 * kHalfWidth + 1>(kFirst);
    normalize(then);
    const double alike = static_cast<double>(seen.dot(then)) / static_cast<double>(seen.size());
    sum += std::max(0.0, alike - kAddsUp);
  }
  return sum;
}

Pose PatchTracker::search(const Pose& start, const WeakAxes& axes) const {
  Pose best = start;
  if (patches_.size() < kFewestToSearch) return best;
  double most = likeness(best);
  const auto along = [&](const Eigen::Vector3d& axis, double reach_m, double step_m) {
    const Pose middle = best;
    for (double way_m = -reach_m; way_m < reach_m + 0.5 * step_m; way_m += step_m) {
      Pose pose = middle;
      pose.translation_m += way_m * axis;
      const double alike = likeness(pose);
      if (alike <= most) continue;
      most = alike;
      best = pose;
    }
  };
  for (const WeakAxis& weak : axes) {
    if (!translates(weak)) continue;
    along(weak.axis, kSearch_m, kCoarse_m);
    along(weak.axis, kCoarse_m - kFine_m, kFine_m);
  }
  return best;
}

PatchVotes PatchTracker::votes(const Pose& T_odom_scan) const {
  PatchVotes votes;
  votes.term.T_odom_scan = T_odom_scan;
  unsigned sectors = 0;
  Look seen;
  for (const Patch& patch : patches_) {
    if (!look(patch, T_odom_scan, true, seen)) continue;
    const double alike = static_cast<double>(seen.values.dot(patch.values)) / kPixels;
    if (alike < kAlike) continue;
    const double weight = 1.0 / (kAlikePixels * (2.0 * (1.0 - alike) + kVarianceFloor));
    const Values error = seen.values - patch.values;
    votes.term.hessian += weight * (seen.jacobian.transpose() * seen.jacobian).cast<double>();
    votes.term.gradient += weight * (seen.jacobian.transpose() * error).cast<double>();
    ++votes.patches;
    sectors |=
        1U << static_cast<unsigned>(sector_of(T_odom_scan.inverse() * patch.points_m[kPixels / 2]));
  }
  votes.sectors = std::popcount(sectors);
  return votes;
}

Eigen::Vector3d PatchTracker::point_at(int row, int u) const {
  const int columns = images_->range_mm.cols;
  const int shift = shift_[static_cast<std::size_t>(row)];
  const int m = ((u - shift) % columns + columns) % columns;
  const Eigen::Vector3d point_m = lut_->point(row, m, images_->range_mm(row, u));
  return T_reference_column_.empty() ? point_m
                                     : T_reference_column_[static_cast<std::size_t>(m)] * point_m;
}

// How much a pixel's brightness changes when the sensor moves by a metre along one of the axes
// (sensor frame); 0 where that shifts the image across its gradient, or there is hardly any.
float PatchTracker::score(int row, int u, std::span<const Eigen::Vector3d> axes) const {
  const auto value = [&](int row_on, int u_on) {
    return static_cast<float>(images_->brightness(row + row_on, u + u_on));
  };
  float by_column = 0.0F;
  float by_row = 0.0F;
  for (int i = -1; i <= 1; ++i) {
    by_column += (value(i, 1) - value(i, -1)) / 6.0F;
    by_row += (value(1, i) - value(-1, i)) / 6.0F;
  }
  const float gradient = std::hypot(by_column, by_row);
  if (gradient < kLeastGradient) return 0.0F;
  if (images_->range_mm(row, u + 1) == 0 || images_->range_mm(row + 1, u) == 0) return 0.0F;
  const Eigen::Vector3d here_m = point_at(row, u);
  Eigen::Matrix<double, 3, 2> pixels_m;
  pixels_m << point_at(row, u + 1) - here_m, point_at(row + 1, u) - here_m;
  const Eigen::Matrix2d squared_m2 = pixels_m.transpose() * pixels_m;
  float most = 0.0F;
  for (const Eigen::Vector3d& axis : axes) {
    // By so many pixels.
    const Eigen::Vector2f shift =
        squared_m2.ldlt().solve(pixels_m.transpose() * axis).cast<float>();
    const float change = std::abs(by_column * shift.x() + by_row * shift.y());
    if (change > kLeastAlignment * gradient * shift.norm()) most = std::max(most, change);
  }
  return std::isfinite(most) ? most : 0.0F;
}

// The best first.
void PatchTracker::find_candidates(const Pose& T_odom_scan, const WeakAxes& axes) {
  candidates_.clear();
  std::array<Eigen::Vector3d, 3> directions;
  std::size_t count = 0;
  for (const WeakAxis& weak : axes) {
    if (!translates(weak) || count == directions.size()) continue;
    directions[count++] = T_odom_scan.rotation.conjugate() * weak.axis;
  }
  const Image<std::uint32_t>& range_mm = images_->range_mm;
  for (int row = kHalfHeight; row < range_mm.rows - kHalfHeight; ++row) {
    for (int u = kHalfWidth; u < range_mm.cols - kHalfWidth; u += kCandidateStep) {
      const double range_m = 0.001 * range_mm(row, u);
      if (range_m < kNearest_m || range_m > kFarthestPatch_m) continue;
      const float by = score(row, u, {directions.data(), count});
      if (by > 0.0F) candidates_.push_back({by, row, u});
    }
  }
  std::ranges::sort(candidates_, [](const Candidate& a, const Candidate& b) {
    return std::tie(b.score, a.row, a.u) < std::tie(a.score, b.row, b.u);
  });
}

// False where its pixels are not all on one surface, or were measured a whole turn apart.
bool PatchTracker::make(const Candidate& candidate, const Pose& T_odom_scan, Patch& patch) const {
  const Image<std::uint32_t>& range_mm = images_->range_mm;
  const int columns = range_mm.cols;
  const auto range = [&](int rows_on, int columns_on) {
    return static_cast<double>(range_mm(candidate.row + rows_on, candidate.u + columns_on));
  };
  const double middle = range(0, 0);
  for (const auto& [rows_on, columns_on] : {std::pair{0, kHalfWidth},
                                            {kHalfHeight, 0},
                                            {kHalfHeight, kHalfWidth},
                                            {kHalfHeight, -kHalfWidth}}) {
    const double a = range(rows_on, columns_on);
    const double b = range(-rows_on, -columns_on);
    if (a == 0.0 || b == 0.0 || std::abs(a + b - 2.0 * middle) > 2.0 * kBend * middle) return false;
  }
  std::size_t i = 0;
  for (int rows_on = -kHalfHeight; rows_on <= kHalfHeight; ++rows_on) {
    const int row = candidate.row + rows_on;
    const int shift = shift_[static_cast<std::size_t>(row)];
    const int m = ((candidate.u - shift) % columns + columns) % columns;
    if (m < kHalfWidth || m + kHalfWidth >= columns) return false;
    for (int columns_on = -kHalfWidth; columns_on <= kHalfWidth; ++columns_on, ++i) {
      if (range(rows_on, columns_on) == 0.0) return false;
      patch.points_m[i] = T_odom_scan * point_at(row, candidate.u + columns_on);
      patch.values(static_cast<Eigen::Index>(i)) =
          static_cast<float>(images_->brightness(row, candidate.u + columns_on));
    }
  }
  patch.age = 0;
  return normalize(patch.values) > kLeastDeviation;
}

void PatchTracker::renew(const Pose& T_odom_scan, const WeakAxes& axes) {
  if (images_ == nullptr || std::none_of(axes.begin(), axes.end(), translates)) {
    patches_.clear();
    return;
  }
  struct Taken {
    int row;
    int u;
  };
  std::vector<Taken> taken;
  std::array<int, kPatchSectors> in_sector{};
  const Pose T_scan_odom = T_odom_scan.inverse();
  Look seen;
  std::erase_if(patches_, [&](Patch& patch) {
    if (++patch.age > kOldest_scans || !look(patch, T_odom_scan, false, seen)) return true;
    if (static_cast<double>(seen.values.dot(patch.values)) < kKept * kPixels) return true;
    const Eigen::Vector3d middle_m = T_scan_odom * patch.points_m[kPixels / 2];
    ImageProjection::Place place;
    if (!projection_.project(middle_m, place)) return true;
    taken.push_back({place.row, projection_.column_at(place)});
    ++in_sector[static_cast<std::size_t>(sector_of(middle_m))];
    return false;
  });
  spared_last_ = sparing_ && !spared_last_ && patches_.size() >= kEnoughToSpare;
  if (spared_last_) return;
  find_candidates(T_odom_scan, axes);
  const int columns = images_->range_mm.cols;
  Patch patch;
  for (const Candidate& candidate : candidates_) {
    if (patches_.size() >= kMostPatches) break;
    const int shift = shift_[static_cast<std::size_t>(candidate.row)];
    const Taken here{candidate.row, ((candidate.u - shift) % columns + columns) % columns};
    const bool apart = std::ranges::all_of(taken, [&](const Taken& other) {
      return std::abs(other.row - here.row) >= kApartRows ||
             std::abs(other.u - here.u) >= kApart_px;
    });
    if (!apart) continue;
    int& count =
        in_sector[static_cast<std::size_t>(sector_of(point_at(candidate.row, candidate.u)))];
    if (count >= kMostInSector || !make(candidate, T_odom_scan, patch)) continue;
    ++count;
    taken.push_back(here);
    patches_.push_back(patch);
  }
}

}  // namespace glint::slam
