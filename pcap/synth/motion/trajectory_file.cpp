// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "pcap/synth/motion/trajectory_file.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <charconv>
#include <cmath>
#include <fstream>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "pcap/synth/motion/cubic_spline.hpp"
#include "pcap/synth/option_error.hpp"

namespace glint::synth {
namespace {

constexpr std::size_t kTumColumns = 8;
constexpr std::size_t kKittiColumns = 12;
// How far rounded digits may take a quaternion's length or a rotation matrix from what they are.
constexpr double kTolerance = 0.05;

using Values = Eigen::Matrix<double, 7, 1>;  // x y z, then the quaternion x y z w

// Reads a trajectory line by line; knows where it is, for messages.
class TrajectoryReader {
 public:
  TrajectoryReader(const std::filesystem::path& file, double rate_hz)
      : file_(file.string()), rate_hz_(rate_hz) {}

  void add(std::string_view text) {
    ++line_;
    const std::vector<double> numbers = split(text);
    if (numbers.empty()) return;
    if (columns_ == 0) columns_ = numbers.size();
    if (columns_ != kTumColumns && columns_ != kKittiColumns) {
      fail(fmt::format("holds {} numbers; a TUM trajectory has {} a line, a KITTI one {}",
                       numbers.size(), kTumColumns, kKittiColumns));
    }
    if (numbers.size() != columns_) {
      fail(fmt::format("holds {} numbers but the lines before it {}", numbers.size(), columns_));
    }
    if (columns_ == kTumColumns) {
      add_tum(numbers);
    } else {
      add_kitti(numbers);
    }
  }

  CubicSpline<7> finish() && {
    if (times_s_.size() < 2) {
      throw InputError(fmt::format("trajectory {}: holds {} poses; a motion needs two at least",
                                   file_, times_s_.size()));
    }
    return {std::move(times_s_), std::move(values_)};
  }

 private:
  [[noreturn]] void fail(std::string_view what) const {
    throw InputError(fmt::format("trajectory {}: line {} {}", file_, line_, what));
  }

  // The numbers of a line up to a comment.
  [[nodiscard]] std::vector<double> split(std::string_view text) const {
    constexpr std::string_view kBlanks = " \t\r";
    text = text.substr(0, text.find('#'));
    std::vector<double> numbers;
    for (std::size_t at = text.find_first_not_of(kBlanks); at != std::string_view::npos;
         at = text.find_first_not_of(kBlanks, at)) {
      const std::string_view word = text.substr(at, text.find_first_of(kBlanks, at) - at);
      double number = 0.0;
      const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
      if (error != std::errc{} || end != word.data() + word.size() || !std::isfinite(number)) {
        fail(fmt::format("holds '{}', which is no finite number", word));
      }
      numbers.push_back(number);
      at += word.size();
    }
    return numbers;
  }

  void add_tum(const std::vector<double>& n) {
    const Eigen::Quaterniond rotation(n[7], n[4], n[5], n[6]);
    if (std::abs(rotation.norm() - 1.0) > kTolerance) {
      fail(fmt::format("has a quaternion of length {:.3f}, which must be 1", rotation.norm()));
    }
    if (times_s_.empty()) first_time_s_ = n[0];
    const double time_s = n[0] - first_time_s_;
    if (!times_s_.empty() && time_s <= times_s_.back()) {
      fail("is not later than the one before it");
    }
    append(time_s, {n[1], n[2], n[3]}, rotation);
  }

  void add_kitti(const std::vector<double>& n) {
    const Eigen::Matrix<double, 3, 4> matrix =
        Eigen::Map<const Eigen::Matrix<double, 3, 4, Eigen::RowMajor>>(n.data());
    const Eigen::Matrix3d rotation = matrix.leftCols<3>();
    if (!(rotation * rotation.transpose() - Eigen::Matrix3d::Identity()).isZero(kTolerance) ||
        rotation.determinant() < 0.0) {
      fail("has a matrix that is no rotation");
    }
    append(static_cast<double>(times_s_.size()) / rate_hz_, matrix.col(3),
           Eigen::Quaterniond(rotation));
  }

  void append(double time_s, const Eigen::Vector3d& position_m, Eigen::Quaterniond rotation) {
    rotation.normalize();
    // Of the two quaternions of a rotation, the one nearer to the last.
    if (!values_.empty() && values_.back().tail<4>().dot(rotation.coeffs()) < 0.0) {
      rotation.coeffs() = -rotation.coeffs();
    }
    times_s_.push_back(time_s);
    values_.emplace_back() << position_m, rotation.coeffs();
  }

  const std::string file_;
  const double rate_hz_;
  int line_ = 0;
  std::size_t columns_ = 0;
  double first_time_s_ = 0.0;
  std::vector<double> times_s_;
  std::vector<Values> values_;
};

}  // namespace

TrajectoryFile load_trajectory(const std::filesystem::path& file, double rate_hz) {
  if (!(rate_hz > 0.0 && std::isfinite(rate_hz))) {
    throw OptionError(
        fmt::format("{} poses a second are not possible: choose more than 0", rate_hz));
  }
  std::ifstream in(file);
  if (!in || std::filesystem::is_directory(file)) {
    throw InputError(fmt::format("trajectory {}: the file cannot be read; name a TUM or KITTI file",
                                 file.string()));
  }
  TrajectoryReader reader(file, rate_hz);
  for (std::string line; std::getline(in, line);) reader.add(line);

  const auto spline = std::make_shared<const CubicSpline<7>>(std::move(reader).finish());
  const Motion motion = [spline](double t_s) {
    const Values values = spline->at(t_s);
    return Pose{Eigen::Quaterniond(values.tail<4>()).normalized(), values.head<3>()};
  };
  return {motion, spline->end()};
}

}  // namespace glint::synth
