// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "daemon/told_by_worker.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "daemon/protocol_image.hpp"

namespace glint::daemon {
namespace {

constexpr double kDefaultToldRateHz = 1.0;
constexpr double kMaxImageRateHz = 5.0;
constexpr double kMaxMapRateHz = 2.0;

std::optional<Json> no_fields() { return Json::object(); }

double told_rate_hz(double asked_hz, double most_hz) {
  return std::min(asked_hz == 0.0 ? kDefaultToldRateHz : asked_hz, most_hz);
}

class ImageTopic : public ToldByWorker {
 public:
  ImageTopic(Api& api, const Json& params, double rate_hz, std::function<void()> on_line)
      : ToldByWorker(api, "image", rate_hz, std::move(on_line)), kind_(image_kind(params)) {}

  [[nodiscard]] Json settings() const override {
    return Json{{"rate_hz", rate_hz()}, {"kind", kind_}};
  }

 protected:
  [[nodiscard]] bool has_news() const override { return true; }
  Api::WorkerStep next_step() override { return api().next_image(kind_, told_); }

 private:
  const std::string kind_;
  const std::shared_ptr<std::optional<SensorTime>> told_ =
      std::make_shared<std::optional<SensorTime>>();
};

class MapTopic : public ToldByWorker {
 public:
  MapTopic(Api& api, const Json& params, double rate_hz, std::function<void()> on_line)
      : ToldByWorker(api, "map", rate_hz, std::move(on_line)), query_(parse_map_query(params)) {
    query_.cursor.reset();
    query_.since_revision = 0;
  }

  [[nodiscard]] Json settings() const override {
    Json out{{"rate_hz", rate_hz()},
             {"voxel_m", query_.voxel_m},
             {"encoding", query_.base64 ? "base64" : "json"}};
    if (!query_.region) return out;
    const auto corner = [](const Eigen::Vector3d& p) { return Json{p.x(), p.y(), p.z()}; };
    out["region"] =
        Json{{"min_m", corner((*query_.region)[0])}, {"max_m", corner((*query_.region)[1])}};
    return out;
  }

 protected:
  [[nodiscard]] bool has_news() const override {
    const auto map = api().map();
    if (is_known(*map)) return map->revision != told_->revision;
    // An empty map is news for who holds another one.
    return map->revision > 0 || told_->revision > 0;
  }
  [[nodiscard]] bool goes_on() const override { return told_->cursor.has_value(); }

  // All pages are of one map; where it has moved or been changed meanwhile they begin anew.
  Api::WorkerStep next_step() override {
    auto map = api().map();
    const bool anew = !is_known(*map);
    if (anew) *told_ = {map->epoch, 0, {}, {}};
    MapQuery query = query_;
    query.since_revision = told_->revision;
    query.cursor = told_->cursor;
    return [query = std::move(query), map = std::move(map), told = told_, anew] {
      Json page = map_page(query, *map);
      told->pages_of = query.cursor ? told->pages_of : map->revision;
      told->cursor = next_cursor(page);
      if (!told->cursor) told->revision = told->pages_of;
      const bool whole = !query.cursor && !told->cursor;
      if (whole && !anew && page["tiles"].empty() && page["removed"].empty()) return no_fields();
      page.erase("next_cursor");
      page["anew"] = anew;
      page["more"] = told->cursor.has_value();
      return std::optional(std::move(page));
    };
  }

 private:
  /// What the client has. Of the worker while a query is there, else of the main thread.
  struct Told {
    std::uint32_t epoch = 0;
    std::uint64_t revision = 0;       ///< Of what it has all of.
    std::optional<MapCursor> cursor;  ///< Where the pages go on.
    std::uint64_t pages_of = 0;       ///< The revision that is complete with the last of them.
  };

  [[nodiscard]] bool is_known(const slam::MapSnapshot& map) const {
    return told_->revision + told_->pages_of > 0 && map.epoch == told_->epoch &&
           (!told_->cursor || told_->cursor->revision >= map.moved_revision);
  }

  MapQuery query_;
  const std::shared_ptr<Told> told_ = std::make_shared<Told>();
};

}  // namespace

ToldByWorker::ToldByWorker(Api& api, std::string topic, double rate_hz,
                           std::function<void()> on_line)
    : api_(api),
      topic_(std::move(topic)),
      rate_hz_(rate_hz),
      period_ns_(std::llround(1e9 / rate_hz)),
      on_line_(std::move(on_line)) {}

bool ToldByWorker::tick(std::int64_t now_ns) {
  if (now_ns < next_due_ns_) return false;
  next_due_ns_ = std::max(next_due_ns_ + period_ns_, now_ns + period_ns_ / 2);
  // What is known of the client is the worker's while it is asked.
  if (asked_) return false;
  if (line_.empty()) {
    // A page that the worker had no time for is asked for again.
    if (goes_on() || has_news()) ask();
    return false;
  }
  if (goes_on() || !has_news()) return false;
  // The client has not taken the last one yet.
  ++missed_;
  return true;
}

std::optional<std::string> ToldByWorker::take_line() {
  if (line_.empty()) return std::nullopt;
  std::string line = std::exchange(line_, {});
  if (goes_on()) ask();
  return line;
}

void ToldByWorker::ask() {
  asked_ = true;
  Json params{{"seq", seq_}, {"missed", missed_}};
  api_.make({topic_, std::move(params), next_step()},
            [weak = std::weak_ptr<ToldByWorker*>(self_)](std::string line) {
              const auto self = weak.lock();
              if (!self) return;
              ToldByWorker& topic = **self;
              topic.asked_ = false;
              if (line.empty()) return;
              ++topic.seq_;
              topic.line_ = std::move(line);
              topic.on_line_();
            });
}

std::unique_ptr<ToldByWorker> tell_images(Api& api, const Json& params, double rate_hz,
                                          std::function<void()> on_line) {
  return std::make_unique<ImageTopic>(api, params, told_rate_hz(rate_hz, kMaxImageRateHz),
                                      std::move(on_line));
}

std::unique_ptr<ToldByWorker> tell_map(Api& api, const Json& params, double rate_hz,
                                       std::function<void()> on_line) {
  return std::make_unique<MapTopic>(api, params, told_rate_hz(rate_hz, kMaxMapRateHz),
                                    std::move(on_line));
}

}  // namespace glint::daemon
