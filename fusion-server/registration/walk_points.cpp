#include "fusion-server/registration/walk_points.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "fusion-server/registration/pairs.h"

namespace chorus::registration {
namespace {

constexpr std::size_t kMaxPoints = 1500;  // of the walk; successive ones are redundant
constexpr double kPointsEach = 100.0;     // at least this many per sensor, if two see each point
// The least time between two instants of one sensor.
constexpr Duration kFrame = std::chrono::milliseconds(33);
// The direction of a point is computed from its way during this time before and after it [s].
constexpr double kAside = 0.3;
// A point that moves less than this has no direction [m].
constexpr double kLeastWay = 0.06;
// Two points of a slot that are farther apart than this are not successive [s].
constexpr double kSuccessive = 0.5;
// The largest correlation of successive errors.
constexpr double kMostAlike = 0.98;

/// Adds the slots that several sensors saw at one instant.
void add_instant(const std::vector<std::optional<TrailMoment>>& moments,
                 const std::vector<Station>& stations, std::span<const Slot> slots, double time,
                 std::vector<WalkPoint>& points) {
  for (std::size_t slot = 0; slot < slots.size(); ++slot) {
    WalkPoint point{time, slot, {}, {}};
    for (std::size_t i = 0; i < stations.size(); ++i) {
      if (!moments[i] || !moments[i]->frame.has(slot)) continue;
      const Eigen::Vector3d& x = moments[i]->frame.points[slot];
      const Eigen::Isometry3d& turn = stations[i].level_from_sensor;
      point.seen.push_back({i, turn * x, turn.linear() * x.normalized(), slots[slot].sigma});
    }
    point.counted = point.seen;
    if (point.seen.size() > 1) points.push_back(std::move(point));
  }
}

/// How many sensors see the person at once, on average.  `instants` are sorted.
double watchers(const std::vector<Timestamp>& instants) {
  std::size_t frames = 0;
  std::optional<Timestamp> last;
  for (const Timestamp instant : instants) {
    if (last && instant - *last < kFrame) continue;
    last = instant;
    ++frames;
  }
  return static_cast<double>(instants.size()) /
         static_cast<double>(std::max<std::size_t>(1, frames));
}

/// Each sensor's own instants at which the person had moved, thinned out to save time: every
/// sensor is included so that no overlap is missed.
std::vector<Timestamp> instants_of(const std::vector<Station>& stations, std::size_t slots) {
  std::vector<Timestamp> all;
  for (const Station& station : stations) {
    for (const TrailFrame& frame : station.walker->trail.frames) {
      if (frame.moved) all.push_back(frame.captured);
    }
  }
  std::sort(all.begin(), all.end());
  const std::size_t most = std::max(
      kMaxPoints, static_cast<std::size_t>(kPointsEach * static_cast<double>(stations.size()) *
                                           2.0 / std::max(2.0, watchers(all))));
  const std::size_t step = std::max<std::size_t>(1, all.size() * slots / most);
  std::vector<Timestamp> instants;
  for (std::size_t i = 0; i < all.size(); i += step) instants.push_back(all[i]);
  return instants;
}

/// For each point the one of the same slot before it, if it was seen shortly before; else itself.
std::vector<std::size_t> before_each(const std::vector<WalkPoint>& points) {
  std::map<std::size_t, std::size_t> last;
  std::vector<std::size_t> before(points.size());
  for (std::size_t k = 0; k < points.size(); ++k) {
    const auto [at, first] = last.try_emplace(points[k].slot, k);
    before[k] = points[k].time - points[at->second].time <= kSuccessive ? at->second : k;
    at->second = k;
  }
  return before;
}

/// Calls each(i, j) for the sights i of `now` and j of `then` by the same sensor.
template <class Each>
void for_both(const PointMeasurements& now, const PointMeasurements& then, const Each& each) {
  for (std::size_t i = 0; i < now.size(); ++i) {
    for (std::size_t j = 0; j < then.size(); ++j) {
      if (now[i].sensor == then[j].sensor) each(i, j);
    }
  }
}

}  // namespace

std::vector<WalkPoint> points_of(const std::vector<Station>& stations,
                                 const RegistrationConfig& config) {
  const auto slots = slots_of(config.joints);
  std::vector<TrailReader> readers;
  for (const Station& station : stations) {
    readers.emplace_back(station.walker->trail, config.max_gap);
  }
  std::vector<WalkPoint> points;
  const std::vector<Timestamp> instants = instants_of(stations, slots.size());
  for (const Timestamp instant : instants) {
    std::vector<std::optional<TrailMoment>> moments;
    for (TrailReader& reader : readers) {
      moments.push_back(reader.at(instant));
      if (moments.back() && moments.back()->speed > config.max_speed) moments.back().reset();
    }
    add_instant(moments, stations, slots, seconds(instant - instants.front()), points);
  }
  return points;
}

double memory_of(const std::vector<WalkPoint>& points, const std::vector<FusedPoint>& fused,
                 const std::vector<double>& weights) {
  const std::vector<std::size_t> before = before_each(points);
  double product = 0.0;
  double squares = 0.0;
  double lags = 0.0;
  double count = 0.0;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const std::size_t then = before[k];
    if (then == k || !(weights[k] > 0.0) || !(weights[then] > 0.0)) continue;
    for_both(points[k].seen, points[then].seen, [&](std::size_t i, std::size_t j) {
      const Eigen::Vector3d off = fused[k].x - fused[k].seen[i];
      const Eigen::Vector3d was = fused[then].x - fused[then].seen[j];
      product += off.dot(was);
      squares += 0.5 * (off.squaredNorm() + was.squaredNorm());
      lags += points[k].time - points[then].time;
      count += 1.0;
    });
  }
  if (!(product > 0.0)) return 0.0;
  return -lags / count / std::log(std::min(product / squares, kMostAlike));
}

void whiten(std::vector<WalkPoint>& points, double memory) {
  if (!(memory > 0.0)) return;
  const std::vector<std::size_t> before = before_each(points);
  for (std::size_t k = 0; k < points.size(); ++k) {
    if (before[k] == k) continue;
    const WalkPoint& old = points[before[k]];
    const double alike = std::min(kMostAlike, std::exp(-(points[k].time - old.time) / memory));
    PointMeasurements news;
    for_both(points[k].seen, old.seen, [&](std::size_t i, std::size_t j) {
      PointMeasurement fresh = points[k].seen[i];
      fresh.x -= alike * old.seen[j].x;
      fresh.nearer -= alike * old.seen[j].nearer;
      fresh.lever = 1.0 - alike;
      fresh.sigma *= std::sqrt(1.0 - alike * alike);
      news.push_back(fresh);
    });
    if (news.size() > 1) points[k].counted = std::move(news);
  }
}

std::vector<std::optional<Eigen::Vector3d>> ways_of(const std::vector<WalkPoint>& points,
                                                    const std::vector<Eigen::Vector3d>& places) {
  std::map<std::size_t, std::vector<std::size_t>> by_slot;
  for (std::size_t k = 0; k < points.size(); ++k) by_slot[points[k].slot].push_back(k);
  std::vector<std::optional<Eigen::Vector3d>> ways(points.size());
  for (const auto& [slot, own] : by_slot) {
    std::size_t before = 0;
    std::size_t after = 0;
    for (const std::size_t k : own) {
      while (points[own[before]].time < points[k].time - kAside) ++before;
      while (after + 1 < own.size() && points[own[after]].time < points[k].time + kAside) ++after;
      Eigen::Vector3d way = places[own[after]] - places[own[before]];
      way.y() = 0.0;
      if (way.norm() > kLeastWay) ways[k] = way;
    }
  }
  return ways;
}

}  // namespace chorus::registration
