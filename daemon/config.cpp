// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "daemon/config.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <iterator>

namespace glint::daemon {
namespace {

using slam::SlamConfig;

/// The member `Member` of the group `Group`.
template <auto Group, auto Member>
auto at(Config& config) -> decltype((config.*Group.*Member)) {
  return config.*Group.*Member;
}

constexpr double kMaxPort = 65535.0;

constexpr std::array kKeys{
    ConfigKey{"sensor.host", &at<&Config::sensor, &Config::Sensor::host>, 0, 0, "", "",
              "Name or IP address of the sensor, which may get its power later. Empty: it is not "
              "talked to, and sensor.metadata_file is needed."},
    ConfigKey{"sensor.configure", &at<&Config::sensor, &Config::Sensor::configure>, 0, 0, "", "",
              "Tell the sensor to send here and what the keys below say, where it differs. false: "
              "it is left as it is."},
    ConfigKey{"sensor.persist", &at<&Config::sensor, &Config::Sensor::persist>, 0, 0, "", "",
              "Have the sensor keep in its flash what it is told; else it lasts until it loses "
              "power."},
    ConfigKey{"sensor.udp_dest", &at<&Config::sensor, &Config::Sensor::udp_dest>, 0, 0, "", "",
              "Where the sensor sends its packets: an IP address. auto: this machine, or "
              "multicast_group. Empty: as "
              "the sensor has it."},
    ConfigKey{"sensor.lidar_mode", &at<&Config::sensor, &Config::Sensor::lidar_mode>, 0, 0, "", "",
              "Columns a turn and turns a second: 512x10, 1024x10, 2048x10, ... Empty: as the "
              "sensor has it."},
    ConfigKey{"sensor.timestamp_mode", &at<&Config::sensor, &Config::Sensor::timestamp_mode>, 0, 0,
              "", "",
              "Clock of the packets: TIME_FROM_INTERNAL_OSC, TIME_FROM_SYNC_PULSE_IN or "
              "TIME_FROM_PTP_1588. Empty: as the sensor has it."},
    ConfigKey{"sensor.operating_mode", &at<&Config::sensor, &Config::Sensor::operating_mode>, 0, 0,
              "", "", "NORMAL or STANDBY. Empty: as the sensor has it."},
    ConfigKey{"sensor.udp_profile_lidar", &at<&Config::sensor, &Config::Sensor::udp_profile_lidar>,
              0, 0, "", "",
              "What lidar packets hold, e.g. RNG19_RFL8_SIG16_NIR16. Empty: as the sensor has it."},
    ConfigKey{"sensor.udp_profile_imu", &at<&Config::sensor, &Config::Sensor::udp_profile_imu>, 0,
              0, "", "", "What IMU packets hold, e.g. LEGACY. Empty: as the sensor has it."},
    ConfigKey{"sensor.azimuth_window_mdeg",
              &at<&Config::sensor, &Config::Sensor::azimuth_window_mdeg>, 0, 360000,
              "thousandths of a degree", "",
              "Start and end of the part of the turn that is sent: [0, 360000] for all of it. "
              "Empty: as the sensor has it."},
    ConfigKey{"sensor.signal_multiplier", &at<&Config::sensor, &Config::Sensor::signal_multiplier>,
              0, 3, "", "",
              "Laser power by a narrower window: 0.25, 0.5, 1, 2 or 3. 0: as the sensor has it."},
    ConfigKey{"sensor.metadata_file", &at<&Config::sensor, &Config::Sensor::metadata_file>, 0, 0,
              "", "",
              "Metadata JSON of the sensor, in place of what sensor.host says; --meta goes before "
              "it."},
    ConfigKey{"sensor.source_address", &at<&Config::sensor, &Config::Sensor::source_address>, 0, 0,
              "", "",
              "IP address of the sensor: packets from others are discarded. Empty: that of "
              "sensor.host once it has answered, else any. any: any."},
    ConfigKey{"sensor.bind_address", &at<&Config::sensor, &Config::Sensor::bind_address>, 0, 0, "",
              "", "Address of the network interface to listen on. Empty: all of them."},
    ConfigKey{
        "sensor.multicast_group", &at<&Config::sensor, &Config::Sensor::multicast_group>, 0, 0, "",
        "",
        "Multicast group that the sensor sends to, joined on the interface of bind_address or "
        "after % in an IPv6 group. Empty: none."},
    ConfigKey{"sensor.lidar_port", &at<&Config::sensor, &Config::Sensor::lidar_port>, 0, kMaxPort,
              "", "", "UDP port of lidar packets. 0: the one of the metadata, else 7502."},
    ConfigKey{"sensor.imu_port", &at<&Config::sensor, &Config::Sensor::imu_port>, 0, kMaxPort, "",
              "", "UDP port of IMU packets. 0: the one of the metadata, else 7503."},
    ConfigKey{"sensor.rcvbuf_bytes", &at<&Config::sensor, &Config::Sensor::rcvbuf_bytes>, 65536,
              1 << 30, "bytes", "",
              "Receive buffer asked of the kernel; net.core.rmem_max must allow it."},
    ConfigKey{
        "sensor.clock", &at<&Config::sensor, &Config::Sensor::clock>, 0, 0, "",
        "auto|internal|pps|ptp|host",
        "What the sensor's stamps are set by, told with every pose. auto: timestamp_mode of "
        "the metadata, internal without one. host: poses carry this machine's time, converted "
        "from the sensor's."},
    ConfigKey{"sensor.tai_utc_offset_s", &at<&Config::sensor, &Config::Sensor::tai_utc_offset_s>,
              -60, 60, "s", "",
              "Subtracted from every stamp of a sensor whose clock is ptp, and of no other, before "
              "anything else sees it. PTP delivers TAI: 37 makes it UTC."},

    ConfigKey{"mount.T_base_sensor", &at<&Config::mount, &Config::Mount::T_base_sensor>, -1000,
              1000, "m", "",
              "Pose of the sensor on the robot: [x, y, z, qx, qy, qz, qw], z up, quaternion of "
              "length 1."},

    ConfigKey{"slam.preset", &at<&Config::slam, &SlamConfig::preset>, 0, 0, "", "paper|full",
              "Values that the other slam keys start from."},
    ConfigKey{"slam.min_completeness", &at<&Config::slam, &SlamConfig::min_completeness>, 0, 1, "",
              "", "Scans with a smaller share of their columns are not used."},
    ConfigKey{"slam.degraded_completeness", &at<&Config::slam, &SlamConfig::degraded_completeness>,
              0, 1, "", "", "Scans with a smaller share of their columns make the state DEGRADED."},
    ConfigKey{"slam.min_range_m", &at<&Config::slam, &SlamConfig::min_range_m>, 0, 100, "m", "",
              "Returns nearer than this are the robot itself."},
    ConfigKey{"slam.deskew", &at<&Config::slam, &SlamConfig::deskew>, 0, 0, "", "",
              "Bring the points of a scan to its end by the motion of the last scan."},
    ConfigKey{"slam.gyro", &at<&Config::slam, &SlamConfig::gyro>, 0, 0, "", "",
              "Take turns from the gyroscope, where there is one."},
    ConfigKey{"slam.accelerometer", &at<&Config::slam, &SlamConfig::accelerometer>, 0, 0, "", "",
              "Take changes of velocity from the accelerometer; only with the gyroscope."},
    ConfigKey{"slam.motion_prior", &at<&Config::slam, &SlamConfig::motion_prior>, 0, 0, "", "",
              "Let the motion so far take part in where a scan is placed."},
    ConfigKey{"slam.degeneracy", &at<&Config::slam, &SlamConfig::degeneracy>, 0, 0, "", "",
              "Do not ask surfaces along axes that they leave open."},
    ConfigKey{
        "slam.image_filter", &at<&Config::slam, &SlamConfig::image_filter>, 0, 0, "", "",
        "Even out the intensity image's brightness and its beams before keypoints are taken."},
    ConfigKey{"slam.orb_features", &at<&Config::slam, &SlamConfig::orb_features>, 50, 10000, "", "",
              "Most keypoints taken from an image."},
    ConfigKey{"slam.orb_levels", &at<&Config::slam, &SlamConfig::orb_levels>, 1, 8, "", "",
              "Levels of the image pyramid."},
    ConfigKey{"slam.orb_scale", &at<&Config::slam, &SlamConfig::orb_scale>, 1.05, 2, "", "",
              "Scale between two levels of the pyramid."},
    ConfigKey{"slam.orb_fast_threshold", &at<&Config::slam, &SlamConfig::orb_fast_threshold>, 1,
              200, "", "", "Contrast of a corner, grey levels of 255."},
    ConfigKey{"slam.orb_upright", &at<&Config::slam, &SlamConfig::orb_upright>, 0, 0, "", "",
              "Take the image's up as every keypoint's up."},
    ConfigKey{"slam.match_max_distance", &at<&Config::slam, &SlamConfig::match_max_distance>, 1,
              256, "bits", "", "Largest Hamming distance of a match."},
    ConfigKey{"slam.match_keep_share", &at<&Config::slam, &SlamConfig::match_keep_share>, 0.01, 1,
              "", "", "Share of the best matches that is kept."},
    ConfigKey{"slam.match_max", &at<&Config::slam, &SlamConfig::match_max>, 10, 10000, "", "",
              "Most matches kept."},
    ConfigKey{"slam.registration_inlier_m", &at<&Config::slam, &SlamConfig::registration_inlier_m>,
              0.001, 10, "m", "", "Inlier gate of the registration's robust start."},
    ConfigKey{"slam.registration_huber_m", &at<&Config::slam, &SlamConfig::registration_huber_m>,
              0.001, 10, "m", "", "Scale of the registration's Huber kernel."},
    ConfigKey{"slam.registration_min_inliers",
              &at<&Config::slam, &SlamConfig::registration_min_inliers>, 3, 1000, "", "",
              "A registration with fewer inliers is a failure."},
    ConfigKey{"slam.max_speed_mps", &at<&Config::slam, &SlamConfig::max_speed_mps>, 0.1, 200, "m/s",
              "", "Largest speed believed."},
    ConfigKey{"slam.max_turn_rate_radps", &at<&Config::slam, &SlamConfig::max_turn_rate_radps>, 0.1,
              50, "rad/s", "", "Largest turn rate believed."},
    ConfigKey{"slam.max_coasted_scans", &at<&Config::slam, &SlamConfig::max_coasted_scans>, 0, 100,
              "scans", "",
              "Scans bridged by constant velocity (DEGRADED) before the state is LOST."},
    ConfigKey{"slam.intensity", &at<&Config::slam, &SlamConfig::intensity>, 0, 0, "", "",
              "Match keypoints of the intensity image. false: surfaces alone, as a baseline."},
    ConfigKey{"slam.planes", &at<&Config::slam, &SlamConfig::planes>, 0, 0, "", "",
              "Hold a scan's surfaces against the local map."},
    ConfigKey{"slam.ground", &at<&Config::slam, &SlamConfig::ground>, 0, 0, "", "",
              "Tell the ground from other surfaces."},
    ConfigKey{"slam.ba", &at<&Config::slam, &SlamConfig::ba>, 0, 0, "", "",
              "Hold a scan's keypoints against those of the last scans."},
    ConfigKey{"slam.sensor_height_m", &at<&Config::slam, &SlamConfig::sensor_height_m>, 0.05, 100,
              "m", "auto",
              "Height of the sensor above the ground. auto: that of the dominant low plane."},
    ConfigKey{"slam.ground_weight", &at<&Config::slam, &SlamConfig::ground_weight>, 0, 100, "", "",
              "Weight of the ground to that of other surfaces."},
    ConfigKey{
        "slam.plane_map", &at<&Config::slam, &SlamConfig::plane_map>, 0, 0, "", "voxels|tree",
        "What odometry keeps surfaces as: planes that average all points, or thinned points."},
    ConfigKey{"slam.plane_points", &at<&Config::slam, &SlamConfig::plane_points>, 100, 20000, "",
              "", "About so many points on surfaces are taken from a scan."},
    ConfigKey{
        "slam.plane_neighbours", &at<&Config::slam, &SlamConfig::plane_neighbours>, 3, 8, "", "",
        "Of plane_map = tree: nearest map points that give a plane: 3 span it, more are fitted."},
    ConfigKey{"slam.local_map_voxel_m", &at<&Config::slam, &SlamConfig::local_map_voxel_m>, 0.05, 5,
              "m", "", "Of plane_map = tree: one point is kept in cubes of this edge."},
    ConfigKey{"slam.local_map_radius_m", &at<&Config::slam, &SlamConfig::local_map_radius_m>, 5,
              1000, "m", "", "Of plane_map = tree: reach around the sensor, along each axis."},
    ConfigKey{"slam.local_map_reach_m", &at<&Config::slam, &SlamConfig::local_map_reach_m>, 0,
              10000, "", "",
              "Odometry forgets what was left behind by this distance; 0: it does not."},
    ConfigKey{"slam.patches", &at<&Config::slam, &SlamConfig::patches>, 0, 0, "", "",
              "Pieces of the image tell the way along axes that surfaces leave open."},
    ConfigKey{
        "slam.moving_objects", &at<&Config::slam, &SlamConfig::moving_objects>, 0, 0, "", "",
        "Leave out what moves: of the map what comes where keyframes before saw through, of the "
        "keypoints those that move with the sensor."},
    ConfigKey{"slam.ba_frames", &at<&Config::slam, &SlamConfig::ba_frames>, 1, 100, "scans", "",
              "Last scans whose keypoints are compared."},
    ConfigKey{"slam.ba_weight", &at<&Config::slam, &SlamConfig::ba_weight>, 0, 1000, "", "",
              "Weight of keypoints to that of surfaces."},
    ConfigKey{"slam.ba_by_noise", &at<&Config::slam, &SlamConfig::ba_by_noise>, 0, 0, "", "",
              "Keypoints weigh what their residuals show them to be good to."},
    ConfigKey{"slam.map_rounds", &at<&Config::slam, &SlamConfig::map_rounds>, 1, 20, "", "",
              "Most times that a scan's points look for their surfaces anew."},
    ConfigKey{
        "slam.load_level", &at<&Config::slam, &SlamConfig::load_level>, 0, 0, "",
        "auto|none|patches|keypoints|surface_points|keypoints_every_second",
        "What is left out where the machine is too slow, each with what stands before it. auto: "
        "as much as a live stream needs; in a replay nothing."},
    ConfigKey{"slam.keyframe_distance_m", &at<&Config::slam, &SlamConfig::keyframe_distance_m>,
              0.01, 100, "m", "", "A keyframe is made after this distance."},
    ConfigKey{"slam.keyframe_angle_rad", &at<&Config::slam, &SlamConfig::keyframe_angle_rad>, 0.01,
              3.2, "rad", "", "A keyframe is made after this turn."},
    ConfigKey{"slam.keyframe_min_matches", &at<&Config::slam, &SlamConfig::keyframe_min_matches>, 0,
              10000, "", "", "A keyframe is made when fewer matches remain."},
    ConfigKey{"slam.loops", &at<&Config::slam, &SlamConfig::loops>, 0, 0, "", "",
              "Places seen again are recognised and correct the map."},
    ConfigKey{"slam.loop_density", &at<&Config::slam, &SlamConfig::loop_density>, 0, 0, "", "",
              "They are recognised by the shape of what stands around them too, where few beams or "
              "bare walls leave nothing else."},
    ConfigKey{"slam.pgo_gravity", &at<&Config::slam, &SlamConfig::pgo_gravity>, 0, 0, "", "",
              "Keep the map level by what the accelerometer feels."},
    ConfigKey{"slam.loop_consistency", &at<&Config::slam, &SlamConfig::loop_consistency>, 0, 0, "",
              "", "Of loops that contradict one another keep the largest set that agrees."},
    ConfigKey{"slam.thin_keyframes", &at<&Config::slam, &SlamConfig::thin_keyframes>, 0, 0, "", "",
              "Keyframes that show nothing that older ones do not are not kept: map and session do "
              "not grow where the sensor passes again and again."},
    ConfigKey{
        "slam.vocabulary", &at<&Config::slam, &SlamConfig::vocabulary>, 0, 0, "", "",
        "File of the visual words that recognise them, see glint train-vocabulary. Empty: the "
        "built-in one."},
    ConfigKey{"slam.map_voxel_m", &at<&Config::slam, &SlamConfig::map_voxel_m>, 0, 10, "m", "",
              "Edge of the map's voxels, one point is kept in each. 0: by the first scan's median "
              "range."},
    ConfigKey{"slam.map_max_points", &at<&Config::slam, &SlamConfig::map_max_points>, 1000, 1e9, "",
              "", "Most points kept in the map; at the limit it stops growing, tracking goes on."},
    ConfigKey{"slam.map_column_step", &at<&Config::slam, &SlamConfig::map_column_step>, 1, 64, "",
              "", "Every n-th column of a keyframe goes into the map."},

    ConfigKey{
        "server.listen", &at<&Config::server, &Config::Server::listen>, 0, 0, "", "",
        "Address and TCP port of the server. One that other machines reach needs a token, below. "
        "Empty: no TCP."},
    ConfigKey{"server.unix_socket", &at<&Config::server, &Config::Server::unix_socket>, 0, 0, "",
              "",
              "Path of the Unix socket. auto: glintd.sock in systemd's RuntimeDirectory, else "
              "none. A socket "
              "that systemd passes (glintd.socket) takes its place, or that of listen."},
    ConfigKey{"server.read_token_file", &at<&Config::server, &Config::Server::read_token_file>, 0,
              0, "", "",
              "File with the tokens of clients that may read, one a line (openssl rand -hex 32). A "
              "name without a path is one of systemd's credentials (LoadCredential=)."},
    ConfigKey{"server.control_token_file",
              &at<&Config::server, &Config::Server::control_token_file>, 0, 0, "", "",
              "File with the tokens of clients that may also pause, reset, save, load and delete."},
    ConfigKey{"server.require_token", &at<&Config::server, &Config::Server::require_token>, 0, 0,
              "", "", "Clients of this machine need a token, too."},
    ConfigKey{"server.tls_certificate_file",
              &at<&Config::server, &Config::Server::tls_certificate_file>, 0, 0, "", "",
              "Certificate chain, PEM: TCP speaks TLS 1.2 or newer. A path or a credential. Empty: "
              "without TLS."},
    ConfigKey{"server.tls_key_file", &at<&Config::server, &Config::Server::tls_key_file>, 0, 0, "",
              "", "Key of the certificate, PEM without a passphrase."},
    ConfigKey{"server.max_clients", &at<&Config::server, &Config::Server::max_clients>, 1, 10000,
              "", "", "Clients served at a time; further ones get an error."},
    ConfigKey{"server.idle_timeout_s", &at<&Config::server, &Config::Server::idle_timeout_s>, 1,
              1e6, "s", "", "A client without a request or a subscription for so long is closed."},
    ConfigKey{"server.stall_timeout_s", &at<&Config::server, &Config::Server::stall_timeout_s>, 1,
              1e6, "s", "",
              "A client that takes nothing of what waits for it for so long is closed."},
    ConfigKey{"server.outbox_bytes", &at<&Config::server, &Config::Server::outbox_bytes>, 2 << 20,
              1 << 30, "bytes", "",
              "Replies that may wait for a client; one that lets more pile up is closed."},
    ConfigKey{"server.max_requests_per_s",
              &at<&Config::server, &Config::Server::max_requests_per_s>, 1, 1e6, "1/s", "",
              "Requests that a client may make; those beyond it wait."},

    ConfigKey{"state.directory", &at<&Config::state, &Config::State::directory>, 0, 0, "", "",
              "Where session files go. auto: systemd's StateDirectory, else none. Empty: none."},
    ConfigKey{"state.max_sessions_mb", &at<&Config::state, &Config::State::max_sessions_mb>, 0, 1e9,
              "MB", "",
              "Room for session files: at start the oldest ones are removed until the others take "
              "no more, never saved maps. 0: all are kept."},
    ConfigKey{"state.trajectory_poses", &at<&Config::state, &Config::State::trajectory_poses>, 1000,
              1e8, "poses", "",
              "Latest poses kept for get_trajectory and get_pose at_ns, some 150 bytes each."},

    ConfigKey{"map.on_start", &at<&Config::map, &Config::Map::on_start>, 0, 0, "",
              "new|continue|localize:NAME",
              "Which map a start begins with. new: an empty one. continue: that of the latest "
              "session in state.directory, in which the robot finds its place by itself (state "
              "LOCALIZING until then) and which goes on to grow; an empty one if there is none. "
              "localize:NAME: that of the saved map NAME, which is only read: the robot finds its "
              "place in it by itself and is told it from then on, and no session is kept."},
    ConfigKey{
        "map.search_s", &at<&Config::map, &Config::Map::search_s>, 5, 1e6, "s", "",
        "A robot that has not found its place in that map for so long begins an empty one; "
        "the session that it did not find itself in stays as it is. With localize:NAME it goes "
        "on to search for ever, odometry going on, and an event tells. One that was lost in "
        "the map that it is making goes on in it where odometry has it."},
    ConfigKey{"map.memory_mb", &at<&Config::map, &Config::Map::memory_mb>, 0, 1e6, "MB", "",
              "Memory that map, pose graph and known places may take. At 80 % of it places seen "
              "longer ago, then tiles of the map, go to the disk (a file without a name, in "
              "state.directory) and come back when they are seen or asked for. At 100 %, when the "
              "disk takes no more, keyframes still go into graph and session, but map and places "
              "stop growing; tracking goes on. 0: no limit."},

    ConfigKey{"metrics.listen", &at<&Config::metrics, &Config::Metrics::listen>, 0, 0, "", "",
              "Address and port of HTTP for Prometheus (/metrics) and supervisors (/healthz, "
              "/readyz), e.g. 127.0.0.1:7789. One that other machines reach asks for a token of "
              "server.read_token_file. Empty: none, so that two daemons do not want one port."},

    ConfigKey{"log.level", &at<&Config::log, &Config::Log::level>, 0, 0, "",
              "debug|info|warn|error", "Least severe message that is logged."},
};

Json value_json(const ConfigKey& key, Config& config) {
  return std::visit(
      [&](auto field) {
        const auto& value = field(config);
        using Value = std::remove_cvref_t<decltype(value)>;
        if constexpr (std::is_same_v<Value, Pose>) {
          const auto& [q, t] = value;
          return Json{t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w()};
        } else if constexpr (std::is_same_v<Value, double>) {
          return takes_auto(key) && value == kAutoNumber ? Json(kAuto) : Json(value);
        } else {
          return Json(value);
        }
      },
      key.field);
}

/// A value as TOML has it: JSON's scalars and arrays are its own.
std::string toml_value(const Json& value) {
  if (!value.is_array()) return value.dump();
  std::string list;
  for (const Json& item : value) list += (list.empty() ? "" : ", ") + item.dump();
  return fmt::format("[{}]", list);
}

/// A number as a user would write it: 0.5, 1e+06, 3.
std::string plain(double value) {
  return std::abs(value) < 1e15 && value == std::floor(value) ? fmt::format("{:.0f}", value)
                                                              : fmt::format("{}", value);
}

std::string range_comment(const ConfigKey& key) {
  std::string text;
  const bool is_choice = !key.choices.empty() && !takes_auto(key);
  if (is_choice) text += fmt::format(" One of {}.", key.choices);
  if (key.min < key.max) text += fmt::format(" Range {} to {}", plain(key.min), plain(key.max));
  if (key.min < key.max) text += key.unit.empty() ? "." : fmt::format(" {}.", key.unit);
  return text;
}

}  // namespace

std::span<const ConfigKey> config_keys() { return kKeys; }

Json to_json(const Config& config) {
  Config copy = config;  // Accessors give references to what is not const.
  Json out = Json::object();
  for (const ConfigKey& key : kKeys) {
    const auto dot = key.name.find('.');
    out[std::string(key.name.substr(0, dot))][std::string(key.name.substr(dot + 1))] =
        value_json(key, copy);
  }
  return out;
}

std::string to_toml(const Config& config, std::string_view group) {
  Config copy = config;
  std::string out;
  std::string_view open_group;
  for (const ConfigKey& key : kKeys) {
    const auto dot = key.name.find('.');
    const std::string_view key_group = key.name.substr(0, dot);
    if (!group.empty() && key_group != group) continue;
    if (key_group != open_group) out += fmt::format("{}[{}]\n", out.empty() ? "" : "\n", key_group);
    open_group = key_group;
    fmt::format_to(std::back_inserter(out), "# {}{}\n{} = {}\n", key.doc, range_comment(key),
                   key.name.substr(dot + 1), toml_value(value_json(key, copy)));
  }
  return out;
}

}  // namespace glint::daemon
