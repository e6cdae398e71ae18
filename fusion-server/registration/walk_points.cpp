#include "fusion-server/registration/walk_points.h"

#include <algorithm>
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

/// Adds the slots that several sensors saw at one instant.
void add_instant(const std::vector<std::optional<TrailMoment>>& moments,
                 const std::vector<Station>& stations, std::span<const Slot> slots, double time,
                 std::vector<WalkPoint>& points) {
  for (std::size_t slot = 0; slot < slots.size(); ++slot) {
    WalkPoint point{time, slot, {}};
    for (std::size_t i = 0; i < stations.size(); ++i) {
      if (!moments[i] || !moments[i]->frame.has(slot)) continue;
      const Eigen::Vector3d& x = moments[i]->frame.points[slot];
      const Eigen::Isometry3d& turn = stations[i].level_from_sensor;
      point.seen.push_back({i, turn * x, turn.linear() * x.normalized(), slots[slot].sigma});
    }
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

std::vector<std::optional<Eigen::Vector3d>> ways_of(const std::vector<WalkPoint>& points,
                                                    const std::vector<FusedPoint>& fused) {
  std::map<std::size_t, std::vector<std::size_t>> by_slot;
  for (std::size_t k = 0; k < points.size(); ++k) by_slot[points[k].slot].push_back(k);
  std::vector<std::optional<Eigen::Vector3d>> ways(points.size());
  for (const auto& [slot, own] : by_slot) {
    std::size_t before = 0;
    std::size_t after = 0;
    for (const std::size_t k : own) {
      while (points[own[before]].time < points[k].time - kAside) ++before;
      while (after + 1 < own.size() && points[own[after]].time < points[k].time + kAside) ++after;
      Eigen::Vector3d way = fused[own[after]].x - fused[own[before]].x;
      way.y() = 0.0;
      if (way.norm() > kLeastWay) ways[k] = way;
    }
  }
  return ways;
}

}  // namespace chorus::registration
