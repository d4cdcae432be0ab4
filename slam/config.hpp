// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <string>

namespace glint::slam {

/// Every parameter of the pipeline, with the defaults of preset `full`. Keys in the configuration
/// file are `slam.` + the member's name. Value type.
struct SlamConfig {
  /// Name of the preset these values started from: "paper" or "full".
  std::string preset = "full";

  /// Scans with a smaller share of their columns are not used; below the second one the state is
  /// DEGRADED.
  double min_completeness = 0.5;
  double degraded_completeness = 0.9;
  /// Returns nearer than this are the robot itself, m.
  double min_range_m = 0.5;

  /// Points are brought to the scan's end by the motion of the last scan. Off: the scan is taken as
  /// rigid, its pose is that of its middle and is extrapolated to its end.
  bool deskew = true;
  /// The gyroscope tells how the sensor turned, where there is one.
  bool gyro = true;
  /// The accelerometer tells how its velocity changed; only with the gyroscope.
  bool accelerometer = true;
  /// The motion so far takes part in where a scan is placed, as sure as it has foretold scans
  /// before.
  bool motion_prior = true;
  /// Along axes that surfaces leave open they are not asked: keypoints and the motion so far tell.
  bool degeneracy = true;

  /// Keypoints are looked for in an image without the beams' differences and with even brightness
  /// (see image_filter.hpp). Off: in the intensity as measured.
  bool image_filter = true;
  /// ORB: most keypoints, pyramid levels, scale between levels, FAST threshold. Two levels: on 64
  /// rows the descriptor's 31-pixel patch fits no further one, and coarse keypoints blur the
  /// motion.
  int orb_features = 1000;
  int orb_levels = 2;
  double orb_scale = 1.2;
  int orb_fast_threshold = 20;
  /// Descriptors are not turned into the corner's direction: a sensor that does not roll much
  /// between two scans matches better, as direction is then part of what is compared.
  bool orb_upright = true;

  /// Largest Hamming distance of a match, share of the best ones kept, and at most how many.
  int match_max_distance = 64;
  double match_keep_share = 0.3;
  int match_max = 200;

  /// Registration: inlier gate of the robust start, and scale of the Huber kernel, m.
  double registration_inlier_m = 0.15;
  double registration_huber_m = 0.1;
  /// A registration with fewer inliers is a failure.
  int registration_min_inliers = 12;
  /// Largest speed (m/s) and turn rate (rad/s) believed.
  double max_speed_mps = 40.0;
  double max_turn_rate_radps = 6.0;
  /// Scans bridged by constant velocity (state DEGRADED) before the state is LOST.
  int max_coasted_scans = 3;

  /// Keypoints of the intensity image are matched from scan to scan. Off: surfaces alone, the
  /// baseline that intensity is measured against.
  bool intensity = true;
  /// Elements of the map optimisation, each of which may be switched off: surfaces against the
  /// local map, the ground apart from other surfaces, keypoints against the last scans.
  bool planes = true;
  bool ground = true;
  bool ba = true;
  /// Places seen again are recognised and correct the map.
  bool loops = true;
  /// They are recognised by the shape of what stands around them too, where the intensity image
  /// tells nothing: few beams, bare walls.
  bool loop_density = true;
  /// The map is kept level by what the accelerometer feels, where there is one.
  bool pgo_gravity = true;
  /// Of loops that contradict one another the largest set that agrees is kept. Off: those that fit
  /// worst are taken out one by one.
  bool loop_consistency = true;
  /// Keyframes that show nothing that older ones do not are not kept. Off: all are.
  bool thin_keyframes = true;
  /// Height of the sensor above the ground, m; 0 (auto): that of the dominant low plane.
  double sensor_height_m = 0.0;
  /// Weight of the ground's residuals to those of other surfaces.
  double ground_weight = 2.0;
  /// What surfaces are kept as: "voxels", planes that average all points (VoxelPlaneMap), or
  /// "tree", thinned points in a k-d tree (RecentMap) with the settings below.
  std::string plane_map = "voxels";
  /// About so many points on surfaces are taken from a scan.
  int plane_points = 2000;
  /// Nearest map points that give a plane: 3 span it, more are fitted.
  int plane_neighbours = 5;
  /// The local map keeps a point in cubes of this edge (m), within this distance (m) of the sensor.
  double local_map_voxel_m = 0.4;
  double local_map_radius_m = 100.0;
  /// What was left behind by this distance (m) and more is forgotten, see RecentMap; 0: it is not.
  double local_map_reach_m = 50.0;
  /// What moves is left out: of the map what comes where keyframes before saw through
  /// (MovingPoints), of the keypoints those that ride along (riding_along.hpp).
  bool moving_objects = true;
  /// Last scans whose keypoints are compared, and the weight of these residuals.
  int ba_frames = 10;
  double ba_weight = 0.3;
  /// Pieces of the intensity image tell the way along axes that surfaces leave open (PatchTracker).
  bool patches = true;
  /// Keypoints weigh what their residuals show them to be good to.
  bool ba_by_noise = true;
  /// Most times that associations are made anew for a scan.
  int map_rounds = 4;

  /// What is left out so that the machine keeps up: a name of kLoadLevelNames, or "auto" for as
  /// much as a live stream needs, and nothing in a replay.
  std::string load_level = "auto";

  /// A keyframe is made after this distance (m), angle (rad), or when fewer matches remain.
  double keyframe_distance_m = 0.5;
  double keyframe_angle_rad = 0.26;
  int keyframe_min_matches = 60;

  /// File of the vocabulary that recognises places seen again, see `glint train-vocabulary`; empty:
  /// the built-in one.
  std::string vocabulary;

  /// Edge of the map's voxels, m: one point is kept in each. 0: a fortieth of the first keyframe's
  /// median range, between 0.05 and 0.5 m, so that rooms and streets need no setting.
  double map_voxel_m = 0.0;
  /// At most this many points are kept; what would be new then is counted and left out.
  int map_max_points = 4000000;
  /// Every n-th column of a keyframe goes into the map.
  int map_column_step = 2;
  /// Memory that map, graph and known places may take, MB, see Backend::memory(); 0: they grow as
  /// they need. Not one of a preset's values.
  int map_memory_mb = 0;
};

/// The values of a preset: "paper" or "full". @throws InputError for any other name.
SlamConfig preset_config(const std::string& name);

}  // namespace glint::slam
