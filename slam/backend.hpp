// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "driver/core/clock.hpp"
#include "slam/config.hpp"
#include "slam/keyframe.hpp"
#include "slam/loop_report.hpp"
#include "slam/loop_source.hpp"
#include "slam/loops/relocalizer.hpp"
#include "slam/map.hpp"
#include "slam/map_correction.hpp"
#include "slam/map_localizer.hpp"
#include "slam/map_memory.hpp"
#include "slam/moving_points.hpp"
#include "slam/pose_graph.hpp"
#include "slam/stage_times.hpp"
#include "slam/store/session_reader.hpp"
#include "slam/store/session_store.hpp"

namespace glint::slam {

/// What is done with the map of an earlier session.
enum class MapUse {
  kExtend,    ///< It goes on to grow once the sensor is found in it.
  kLocalize,  ///< It is only read: the sensor's place in it is told, and no session is kept.
};

/// How a back end ends.
enum class Ending {
  kWhole,  ///< The map is whole afterwards, which may take minutes after a large one was loaded.
  kSoon,   ///< What is known is in the session; the map is not to be asked for any more.
};

/// In which map the sensor is being looked for.
enum class MapSearch { kNone, kEarlierMap, kOwnMap, kMapOnlyRead };

/// Keyframes in; pose graph, map and session out. Thread-compatible; owned by the backend thread.
class Backend {
 public:
  /// `session_file`: where the session is kept; empty for none. @throws InputError if it cannot be
  /// created.
  /// `loops`: finds places seen before; empty for none.
  /// `earlier`: a session whose map is gone on with; empty for none. The sensor may be anywhere in
  /// it: the last 500 keyframes are held back until their place is found, as correction().placed
  /// tells, and what follows is in the frame of that map. `session_file` then begins with that
  /// session, or is itself gone on with if it is the same; until then neither is written. The place
  /// can be found at once; the map of a large session comes back with the keyframes that follow and
  /// by restore_more(), and until it is whole what was held back waits on.
  /// @throws InputError where it cannot be read.
  /// `use`: with kLocalize neither the map nor any file is ever changed, see MapLocalizer.
  /// `alive`: called now and then while a map is read, which takes long; may be empty.
  explicit Backend(const SlamConfig& config, const std::filesystem::path& session_file = {},
                   Clock clock = {}, LoopSource loops = {},
                   const std::filesystem::path& earlier = {}, MapUse use = MapUse::kExtend,
                   std::function<void()> alive = {});
  ~Backend();
  Backend(const Backend&) = delete;
  Backend& operator=(const Backend&) = delete;

  /// Before the first keyframe: the first epoch, when there was another map before.
  void begin_at_epoch(std::uint32_t epoch);
  /// Where the session is kept; empty while it is nowhere.
  [[nodiscard]] std::filesystem::path session_file() const {
    return store_ ? session_file_ : std::filesystem::path();
  }
  /// The sensor's place is forgotten and looked for anew, near `guess` first; until it is found
  /// keyframes are held back, and make a segment of their own then. False when there is no map to
  /// look in, or no session on the disk that could tell of it: nothing happens then.
  bool search_anew(const std::optional<PlaceGuess>& guess = {});
  /// From here on that is done by itself when tracking restarts in a new segment. (A map that is
  /// only read always does.)
  void search_new_segments() { searches_new_segments_ = true; }
  [[nodiscard]] MapSearch search() const;
  /// Whether the last call gave up the guess that the search began with.
  [[nodiscard]] bool guess_dropped() const;
  /// Ends a search in the own map: what was held back goes where odometry has it.
  void go_on_unfound();
  /// The keyframes held back so far, in their own numbers: for a back end without that map, when
  /// the sensor is nowhere in it.
  [[nodiscard]] std::vector<Keyframe> give_up_search();
  /// Since the first keyframe whose place was looked for; zero when none is.
  [[nodiscard]] double searching_s() const;
  /// Whose scans the keyframes that follow are of.
  void use_sensor(const SensorInfo& info);
  void process(const Keyframe& keyframe);
  /// Nothing follows for now: loops that were not worth a correction each get one together, and the
  /// session is brought onto the disk.
  void finish(Ending ending = Ending::kWhole);
  /// To be called often while no keyframe comes: what the session holds reaches the disk in time.
  void keep_session();
  /// The same: ten more keyframes of an earlier session's map are read. False when all of it is
  /// there.
  bool restore_more();
  /// How much of it is there, 0 to 1.
  [[nodiscard]] double restored() const;
  /// Keyframes of it that turned out to be damaged after it was loaded: the map lacks what they
  /// showed.
  [[nodiscard]] std::uint64_t unreadable_keyframes() const { return unreadable_; }
  /// The session is on the disk when it returns. False when it could not be written; store_error()
  /// says why.
  [[nodiscard]] bool commit_session() { return !store_ || store_->commit(); }
  [[nodiscard]] const MapCorrection& correction() const { return correction_; }
  /// The map now; immutable, to be handed to clients.
  [[nodiscard]] std::shared_ptr<const MapSnapshot> snapshot() const { return snapshot_; }
  /// What map, graph and known places take. Where `map_memory_mb` sets a limit, from 80 % of it on
  /// places seen longer ago, and then tiles, go to a file without a name beside the session (else
  /// among temporary files), and come back when they are seen again. Where that takes no more, at
  /// 100 % keyframes still go into graph and session, but not into map and known places.
  [[nodiscard]] const MapMemory& memory() const { return memory_; }
  /// What the last call found out about loops.
  [[nodiscard]] const std::vector<LoopReport>& loop_reports() const { return loop_reports_; }
  /// Edges in the graph, and candidates that are none, or no more.
  [[nodiscard]] std::uint64_t loops_accepted() const { return graph_.loop_count(); }
  [[nodiscard]] std::uint64_t loops_rejected() const { return loops_rejected_; }
  /// What the last call took (kPgo; kBackend is all of it).
  [[nodiscard]] const StageTimes& stage_times() const { return times_; }
  /// Writes of the session file that failed, and why the last one did; they are tried again.
  [[nodiscard]] std::uint64_t store_failures() const {
    return store_ ? store_->failures() : static_cast<std::uint64_t>(!no_session_because_.empty());
  }
  [[nodiscard]] std::string_view store_error() const;
  /// Keyframes that the session file lacks for it.
  [[nodiscard]] std::uint64_t keyframes_not_stored() const;

 private:
  /// Keyframes of an earlier session that are read at a time.
  static constexpr std::size_t kRestoredWithEach = 10;

  /// Where a scan was found.
  struct Found {
    Relocation relocation;
    Pose T_odom_sensor;
    std::uint32_t segment = 0;
  };
  /// For the place of the sensor in a map that was there before.
  struct PlaceSearch {
    std::filesystem::path session;  ///< Empty: it is that of the map there is.
    Relocalizer relocalizer;
    std::vector<Keyframe> waiting;  ///< That are to be built from once it is found.
    std::optional<SensorTime> begin;
    std::optional<Found> found;  ///< While the map is not whole.
  };
  /// An earlier session of which not all is in the map yet.
  struct Restoring {
    std::shared_ptr<const SessionReader> session;
    std::size_t done = 0;    ///< Of its keyframes, which are the graph's.
    bool as_stored = false;  ///< Its points need no look for what moves.
  };

  void load(const std::filesystem::path& session, MapUse use);
  [[nodiscard]] std::optional<Relocalizer> knowing_own_map();
  [[nodiscard]] bool begins_segment(const Keyframe& keyframe) const;
  void set_apart(std::vector<Keyframe>& waiting);
  [[nodiscard]] std::uint32_t odometry_segment(std::uint32_t map_segment) const;
  [[nodiscard]] Keyframe renumbered(const Keyframe& keyframe) const;
  Relocalizer restore(const std::filesystem::path& file);
  Relocalizer knowing_places(const std::shared_ptr<const SessionReader>& session,
                             const std::function<void(const KeyframeOutline&)>& visit);
  void restore_some(std::size_t keyframes);
  void restore(const SessionKeyframe& stored);
  [[nodiscard]] std::optional<BagOfWords> words_of(const Keyframe& keyframe) const;
  void search_place(const Keyframe& keyframe);
  void wait_for_map(const Keyframe& keyframe);
  void settle_down();
  void continue_session(const std::filesystem::path& session);
  void take(Keyframe keyframe);
  void leave_out_moving(Keyframe& keyframe);
  [[nodiscard]] bool shows_nothing_new(const Keyframe& keyframe, const LoopSearch& found) const;
  [[nodiscard]] bool is_needed(const Keyframe& keyframe, const LoopSearch& found) const;
  void take_loops(LoopSearch& found);
  void settle();
  void take_loops(std::span<const LoopEdge> edges);
  LoopReport& report_of(const LoopEdge& edge);
  std::vector<LoopEdge> optimize();
  void report_restored(const LoopEdge& edge);
  void report_refused(const LoopEdge& edge, const char* reason);
  void correct(const std::vector<Pose>& before);
  void make_map(const Keyframe& first);
  void keep_within_memory();
  static void give_back_memory();
  [[nodiscard]] std::size_t memory_bytes() const;
  void store_changes();
  void publish();

  const SlamConfig config_;
  const std::filesystem::path session_file_;
  const Clock clock_;
  const LoopSource loops_;
  const std::function<void()> alive_;             ///< May be empty.
  std::shared_ptr<const Vocabulary> vocabulary_;  ///< Null where no words are kept.
  PoseGraph graph_;
  MovingPoints moving_;
  std::optional<VoxelMap> map_;     ///< Made with the first keyframe, whose ranges set the voxels.
  std::shared_ptr<ColdFile> cold_;  ///< For what is not to stay in memory; made when it is needed.
  bool cold_tried_ = false;
  MapMemory memory_;
  std::unique_ptr<SessionStore> store_;
  std::string no_session_because_;            ///< Why there is none after the place was found.
  std::shared_ptr<const SensorInfo> sensor_;  ///< For a session that is yet to be made.
  std::optional<Restoring> restoring_;        ///< While the map is not whole.
  std::uint64_t unreadable_ = 0;
  std::optional<PlaceSearch> search_;      ///< While the sensor's place is not known.
  std::optional<MapLocalizer> localizer_;  ///< Of a map that is only read.
  /// What makes the numbers of keyframes and segments those of the map.
  std::uint64_t first_keyframe_ = 0;
  std::uint32_t first_segment_ = 0;
  std::vector<std::uint32_t> set_apart_;  ///< Segments that are not new ones of odometry.
  bool searches_new_segments_ = false;
  MapCorrection correction_;
  std::shared_ptr<const MapSnapshot> snapshot_;
  std::vector<LoopReport> loop_reports_;
  LargestCorrection last_correction_;
  LoopChanges changes_;         ///< For the session file, of this call.
  bool loops_waiting_ = false;  ///< There are edges that poses were not optimised with.
  SensorTime stamp_;            ///< Of the last keyframe.
  std::uint64_t loops_rejected_ = 0;
  StageTimes times_;
};

}  // namespace glint::slam
