// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
//
// Client of glintd in one header: C++17, POSIX sockets, nlohmann's JSON. daemon/PROTOCOL.md says
// what methods and results mean; what is absent from a result is unknown.
//
//   glint_client::Client glint("127.0.0.1:7788");  // or the path of a Unix socket
//   std::cout << glint.get_pose().state << '\n';
//   auto poses = glint.subscribe({"pose"});        // goes on when the daemon has been restarted
//   while (auto pose = poses.next()) std::cout << pose->params["t"] << '\n';
#pragma once

#include <netdb.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstdint>
#include <cstring>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

namespace glint_client {

using Json = nlohmann::json;
using Milliseconds = std::chrono::milliseconds;

/// The daemon cannot be reached, went away, does not answer, or is something else than glintd.
class ConnectionLost : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The daemon answered with an error; what() is its sentence.
class RequestError : public std::runtime_error {
 public:
  explicit RequestError(const Json& error)
      : std::runtime_error(error.value("message", "error without a message")),
        number_(error.value("code", 0)),
        data_(error.value("data", Json::object())) {}
  /// JSON-RPC's code.
  [[nodiscard]] int number() const { return number_; }
  /// Its name, such as "BUSY", and the parameter or key that is meant; empty where there is none.
  [[nodiscard]] std::string code() const { return data_.value("code", ""); }
  [[nodiscard]] std::string field() const { return data_.value("field", ""); }
  [[nodiscard]] const Json& data() const { return data_; }

 private:
  int number_;
  Json data_;
};

/// How a daemon is reached. Value type.
struct Options {
  std::string target = "127.0.0.1:7788";  ///< HOST:PORT, or the path of a Unix socket.
  std::string token;                      ///< For daemons that ask for one; empty: none.
  Milliseconds timeout{10'000};           ///< For an answer.
};

/// A pose in `frame`, as far as it is known: p_m and q_xyzw hold only while `known`. Value type.
struct Pose {
  std::string state;
  bool known = false;
  std::int64_t t_ns = 0;
  std::array<double, 3> p_m{};
  std::array<double, 4> q_xyzw{0.0, 0.0, 0.0, 1.0};
  std::uint32_t map_epoch = 0;
  Json all;  ///< With everything else that the daemon said of it.
};

inline Pose to_pose(Json result) {
  Pose pose;
  pose.state = result.at("state").get<std::string>();
  pose.t_ns = result.value("t_ns", std::int64_t{0});
  pose.map_epoch = result.value("map_epoch", 0U);
  pose.known = result.contains("p_m");
  if (pose.known) {
    result.at("p_m").get_to(pose.p_m);
    result.at("q_xyzw").get_to(pose.q_xyzw);
  }
  pose.all = std::move(result);
  return pose;
}

/// In frame `map`.
struct MapPoint {
  float x_m, y_m, z_m, intensity;
};
static_assert(sizeof(MapPoint) == 16, "points come as they lie in memory");

/// Points by tile; `revision`, `map_epoch` and `instance` (a start of the daemon) say which map
/// this is. Value type.
struct Map {
  std::map<std::array<int, 3>, std::vector<MapPoint>> tiles;
  std::uint64_t revision = 0;
  std::uint32_t map_epoch = 0;
  std::string instance;
  double tile_m = 0.0;
};

/// What came by itself: `method` is "pose", "status" or "event".
struct Notification {
  std::string method;
  Json params;
};

namespace detail {

/// Lines of JSON to and from the daemon, after its hello and, where it asks for that,
/// authentication.
class Connection {
 public:
  explicit Connection(Options options) : options_(std::move(options)) {
    open();
    try {
      greet();
      if (!options_.token.empty() && hello_.value("authentication", "") == "token") {
        call("authenticate", {{"token", options_.token}});
      }
    } catch (...) {
      ::close(socket_);
      throw;
    }
  }
  ~Connection() { ::close(socket_); }
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  [[nodiscard]] const Json& hello() const { return hello_; }

  /// The result of a method; notifications that come meanwhile are dropped.
  Json call(const std::string& method, const Json& params) {
    const std::int64_t id = next_id_++;
    send_all(Json{{"jsonrpc", "2.0"}, {"id", id}, {"method", method}, {"params", params}}.dump() +
             "\n");
    while (auto message = read(options_.timeout)) {
      const Json reply_id = message->value("id", Json());
      // A line that the daemon cannot make out it refuses without its id.
      if (message->contains("error") && (reply_id == id || reply_id.is_null())) {
        throw RequestError(message->at("error"));
      }
      if (reply_id == id) return std::move(message->at("result"));
    }
    throw lost("does not answer " + method);
  }

  /// The next message; null when there is none within `timeout` (null: however long it takes).
  std::optional<Json> read(std::optional<Milliseconds> timeout) {
    const auto begin = std::chrono::steady_clock::now();
    std::size_t searched = 0;
    while (true) {
      const auto end = input_.find('\n', searched);
      if (end != std::string::npos) {
        Json message = Json::parse(input_.begin(), input_.begin() + static_cast<long>(end), nullptr,
                                   /*allow_exceptions=*/false);
        input_.erase(0, end + 1);
        if (!message.is_object()) throw lost("sends what is no JSON-RPC, so it is no glintd");
        return message;
      }
      searched = input_.size();
      if (searched > max_line_) throw lost("sends a longer line than it said it would");
      int left_ms = -1;
      if (timeout) {
        const auto left = begin + *timeout - std::chrono::steady_clock::now();
        left_ms = static_cast<int>(
            std::max<std::int64_t>(0, std::chrono::ceil<Milliseconds>(left).count()));
      }
      if (!fill(left_ms)) return std::nullopt;
    }
  }

 private:
  [[nodiscard]] ConnectionLost lost(const std::string& why) const {
    return ConnectionLost("glintd at " + options_.target + " " + why);
  }

  void open() {
    if (options_.target.find('/') != std::string::npos) return open_unix();
    const auto colon = options_.target.rfind(':');
    if (colon == std::string::npos) throw lost("cannot be: neither HOST:PORT nor a socket's path");
    std::string host = options_.target.substr(0, colon);
    if (host.size() > 1 && host.front() == '[') host = host.substr(1, host.size() - 2);
    addrinfo hints{};
    hints.ai_socktype = SOCK_STREAM;
    addrinfo* list = nullptr;
    const int failure =
        ::getaddrinfo(host.c_str(), options_.target.c_str() + colon + 1, &hints, &list);
    if (failure != 0) throw lost(std::string("cannot be reached: ") + ::gai_strerror(failure));
    const std::unique_ptr<addrinfo, decltype(&::freeaddrinfo)> addresses(list, &::freeaddrinfo);
    int error = 0;
    for (const addrinfo* a = list; a != nullptr; a = a->ai_next) {
      if (try_address(a->ai_family, a->ai_addr, a->ai_addrlen)) return;
      error = errno;
    }
    throw lost(std::string("cannot be reached: ") + std::strerror(error) + "; is it running?");
  }

  void open_unix() {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    if (options_.target.size() >= sizeof address.sun_path) {
      throw lost("cannot be: too long for the path of a socket");
    }
    std::memcpy(address.sun_path, options_.target.c_str(), options_.target.size() + 1);
    const void* generic = &address;
    if (!try_address(AF_UNIX, static_cast<const sockaddr*>(generic), sizeof address)) {
      throw lost(std::string("cannot be reached: ") + std::strerror(errno) + "; is it running?");
    }
  }

  bool try_address(int family, const sockaddr* address, socklen_t size) {
    socket_ = ::socket(family, SOCK_STREAM | SOCK_CLOEXEC, 0);
    if (socket_ < 0) return false;
    // A connect or a send that hangs for so long fails.
    const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(options_.timeout);
    const timeval limit{std::max<time_t>(1, seconds.count()), 0};
    ::setsockopt(socket_, SOL_SOCKET, SO_SNDTIMEO, &limit, sizeof limit);
    // A daemon whose machine vanished is noticed also by who only listens.
    const int on = 1;
    ::setsockopt(socket_, SOL_SOCKET, SO_KEEPALIVE, &on, sizeof on);
    if (::connect(socket_, address, size) == 0) return true;
    const int error = errno;
    ::close(socket_);
    errno = error;
    return false;
  }

  void greet() {
    const auto message = read(options_.timeout);
    if (!message) throw lost("says nothing; is it glintd?");
    if (message->contains("error")) throw RequestError(message->at("error"));
    if (message->value("method", "") != "hello") throw lost("does not begin with hello");
    hello_ = message->at("params");
    const std::string protocol = hello_.value("protocol", "");
    if (protocol.rfind("1.", 0) != 0) {
      throw lost("speaks protocol " + protocol + ", this client 1.x; update the older one");
    }
    max_line_ = hello_.value("max_line", max_line_);
  }

  void send_all(std::string_view bytes) {
    while (!bytes.empty()) {
      const ssize_t sent = ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
      if (sent < 0 && errno == EINTR) continue;
      if (sent < 0) throw lost(std::string("went away: ") + std::strerror(errno));
      bytes.remove_prefix(static_cast<std::size_t>(sent));
    }
  }

  /// Takes in what has come; false when nothing has come in time.
  bool fill(int timeout_ms) {
    pollfd waiting{socket_, POLLIN, 0};
    const int ready = ::poll(&waiting, 1, timeout_ms);
    if (ready == 0) return false;
    std::array<char, 65536> chunk;
    const ssize_t got = ready < 0 ? -1 : ::recv(socket_, chunk.data(), chunk.size(), 0);
    if (got < 0 && errno == EINTR) return true;
    if (got < 0) throw lost(std::string("went away: ") + std::strerror(errno));
    if (got == 0) throw lost("closed the connection");
    input_.append(chunk.data(), static_cast<std::size_t>(got));
    return true;
  }

  const Options options_;
  int socket_ = -1;
  std::string input_;
  std::size_t max_line_ = 1 << 20;
  Json hello_;
  std::int64_t next_id_ = 1;
};

inline int base64_value(char c) {
  if (c >= 'A' && c <= 'Z') return c - 'A';
  if (c >= 'a' && c <= 'z') return c - 'a' + 26;
  if (c >= '0' && c <= '9') return c - '0' + 52;
  if (c == '+') return 62;
  return c == '/' ? 63 : -1;
}

/// Appends the points that `text` holds; those of a big-endian machine are turned round.
inline void append_points(const std::string& text, std::vector<MapPoint>& points) {
  std::vector<unsigned char> bytes;
  bytes.reserve(text.size() * 3 / 4);
  std::uint32_t bits = 0;
  int have = 0;
  for (const char c : text) {
    const int value = base64_value(c);
    if (value < 0) break;
    bits = bits << 6U | static_cast<std::uint32_t>(value);
    have += 6;
    if (have < 8) continue;
    have -= 8;
    bytes.push_back(static_cast<unsigned char>(bits >> have & 0xFFU));
  }
  const std::uint16_t probe = 1;
  unsigned char first = 0;
  std::memcpy(&first, &probe, 1);
  if (first == 0) {
    for (std::size_t i = 0; i + 4 <= bytes.size(); i += 4) {
      std::reverse(&bytes[i], &bytes[i] + 4);
    }
  }
  const std::size_t before = points.size();
  points.resize(before + bytes.size() / sizeof(MapPoint));
  if (points.size() == before) return;
  std::memcpy(&points[before], bytes.data(), (points.size() - before) * sizeof(MapPoint));
}

}  // namespace detail

/// Notifications as they come, over a connection of their own, which is made anew when it was lost;
/// what happened meanwhile is not told, and reconnects() counts how often. Thread-compatible.
class Subscription {
 public:
  Subscription(Options options, Json params)
      : options_(std::move(options)), params_(std::move(params)) {
    connect();
  }

  /// The next one; null when there is none within `timeout` (null: however long it takes).
  /// @throws RequestError when the daemon refuses to go on with the subscription.
  std::optional<Notification> next(std::optional<Milliseconds> timeout = std::nullopt) {
    const auto begin = std::chrono::steady_clock::now();
    while (true) {
      std::optional<Milliseconds> left;
      if (timeout) {
        const auto passed = std::chrono::steady_clock::now() - begin;
        left =
            std::max(Milliseconds(0), *timeout - std::chrono::duration_cast<Milliseconds>(passed));
      }
      try {
        if (!connection_) {
          connect();
          ++reconnects_;
        }
        auto message = connection_->read(left);
        if (!message) return std::nullopt;
        if (!message->contains("method")) continue;
        return Notification{message->at("method").get<std::string>(),
                            std::move(message->at("params"))};
      } catch (const ConnectionLost&) {
        connection_.reset();
      } catch (const RequestError& error) {
        if (error.code() != "BUSY") throw;  // One client too many, for now.
      }
      if (left && *left < kRetryDelay) return std::nullopt;
      std::this_thread::sleep_for(kRetryDelay);
    }
  }

  /// What the daemon has in effect.
  [[nodiscard]] const Json& settings() const { return settings_; }
  [[nodiscard]] std::uint64_t reconnects() const { return reconnects_; }

 private:
  static constexpr Milliseconds kRetryDelay{250};

  void connect() {
    auto fresh = std::make_unique<detail::Connection>(options_);
    settings_ = fresh->call("subscribe", params_).at("settings");
    connection_ = std::move(fresh);
  }

  Options options_;
  Json params_;
  Json settings_;
  std::unique_ptr<detail::Connection> connection_;
  std::uint64_t reconnects_ = 0;
};

/// A connection to glintd. One that was lost is made anew by the next call. Thread-compatible.
/// Every call throws ConnectionLost and RequestError.
class Client {
 public:
  explicit Client(Options options) : options_(std::move(options)) { connect(); }
  /// `target`: HOST:PORT, or the path of a Unix socket.
  explicit Client(const std::string& target) : Client(Options{target, {}, Milliseconds(10'000)}) {}

  [[nodiscard]] const Json& hello() const { return hello_; }

  /// The result of any method of the protocol.
  Json call(const std::string& method, const Json& params = Json::object()) {
    if (!connection_) connect();
    try {
      return connection_->call(method, params);
    } catch (const ConnectionLost&) {
      connection_.reset();
      throw;
    }
  }

  /// `params` of get_pose: frame, child, at_ns, predict_ms.
  Pose get_pose(const Json& params = Json::object()) { return to_pose(call("get_pose", params)); }
  Json get_status() { return call("get_status"); }

  /// Topics "pose", "status", "events", "map", "image"; `more` params of subscribe: frame, child,
  /// rate_hz, voxel_m, region, encoding, kind.
  Subscription subscribe(const std::vector<std::string>& topics, Json more = Json::object()) {
    more["topics"] = topics;
    return {options_, std::move(more)};
  }

  /// The whole map, or what `query` (voxel_m, region) asks for.
  Map get_map(const Json& query = Json::object()) {
    Map map;
    while (!take_pages(query, map)) map = {};
    return map;
  }

  /// Takes over what changed in `map`, which came from get_map with the same `query`.
  void update(Map& map, const Json& query = Json::object()) {
    if (take_pages(query, map)) return;
    map = get_map(query);
  }

 private:
  void connect() {
    connection_ = std::make_unique<detail::Connection>(options_);
    hello_ = connection_->hello();
  }

  /// False when what is known does not belong to the map of now: it was corrected, or is another.
  bool take_pages(Json query, Map& map) {
    Map fresh = map;
    const bool anew = map.revision == 0;
    query["since_revision"] = map.revision;
    for (bool first = true; first || query.contains("cursor"); first = false) {
      Json page;
      try {
        page = call("get_map", query);
      } catch (const RequestError& error) {
        if (!first && error.code() == "OUT_OF_RANGE") return false;
        throw;
      }
      const auto epoch = page.at("map_epoch").get<std::uint32_t>();
      const auto instance = hello_.at("instance").get<std::string>();
      const bool other = epoch != fresh.map_epoch || instance != fresh.instance;
      if (other && !(anew && first)) return false;
      fresh.map_epoch = epoch;
      fresh.instance = instance;
      if (first) take_head(page, fresh);
      for (const Json& tile : page.at("tiles")) take_tile(tile, fresh);
      query.erase("cursor");
      if (page.contains("next_cursor")) query["cursor"] = page["next_cursor"];
    }
    map = std::move(fresh);
    return true;
  }

  static void take_head(const Json& page, Map& map) {
    page.at("revision").get_to(map.revision);
    page.at("tile_m").get_to(map.tile_m);
    for (const Json& index : page.at("removed")) map.tiles.erase(index.get<std::array<int, 3>>());
  }

  static void take_tile(const Json& tile, Map& map) {
    std::vector<MapPoint>& points = map.tiles[tile.at("index").get<std::array<int, 3>>()];
    if (!tile.at("continued").get<bool>()) points.clear();
    detail::append_points(tile.at("points").get_ref<const std::string&>(), points);
  }

  Options options_;
  std::unique_ptr<detail::Connection> connection_;
  Json hello_;
};

}  // namespace glint_client
