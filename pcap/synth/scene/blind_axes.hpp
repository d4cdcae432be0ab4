// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

namespace glint::synth {

/// Axes (unit) along which one could slide without any surface noticing: fewer than 2 in 100 of the
/// normals (unit, weighted by how much they face it) lie within 60 degrees of it. Zero vectors
/// among the normals are left out. No normals: no axes.
std::vector<Eigen::Vector3d> blind_axes(std::span<const Eigen::Vector3d> normals);

}  // namespace glint::synth
