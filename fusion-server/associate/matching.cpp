#include "fusion-server/associate/matching.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "fusion-server/associate/assignment.h"
#include "fusion-server/associate/track_motion.h"
#include "fusion-server/associate/worn_likeness.h"

namespace chorus::associate {
namespace {

constexpr int kRounds = 3;  // Rounds in which sensors use each other's matches.
// Weight of the track's expected place; one sensor's view of the person has weight 1.
constexpr double kOwnWeight = 1.0;
// [m]; cost of limbs that have nothing to do with what the track's inertial sensors say.  Half the
// gate: sensors on wrong limbs make nobody lose a body that stands where it is expected.
constexpr double kWornReach = 0.3;
constexpr double kSizeReach = 0.5;    // [m]; cost of a body that is larger by a factor of e.
constexpr double kInformative = 1.0;  // Time in view [s] from which a learned length is used.
constexpr double kDoubtful = 0.3;     // Cost added for unpublished tracks, as a share of the gate.

/// A view while it is being matched.
struct Loose {
  PlacedView view;
  Spans spans;
  std::vector<double> unlike = {};  ///< For each track, see unlike_worn().
  std::optional<std::size_t> track = {};
};

using BySensor = std::map<SensorId, std::vector<Loose>>;

/// Log ratio of the body's size to the known size of the track's person; 0 if unknown.
double size_difference(const Spans& spans, const Build& build) {
  double sum = 0.0;
  double count = 0.0;
  for (std::size_t i = 0; i < kSpans; ++i) {
    if (!spans.length[i] || build.sight[i] < kInformative) continue;
    sum += *spans.length[i] - build.mean[i];
    count += 1.0;
  }
  return count > 0 ? sum / count : 0.0;
}

/// For each track, the weighted mean of its expected place and of its places in the sensors' views.
class Places {
 public:
  explicit Places(const std::vector<Candidate>& candidates) {
    for (const Candidate& each : candidates) sums_.push_back({each.predicted, kOwnWeight});
  }
  void add(const Loose& loose, double sign) {
    if (!loose.track || loose.view.rays) return;
    Sum& sum = sums_[*loose.track];
    sum.place = (sum.weight * sum.place + sign * loose.view.core) / (sum.weight + sign);
    sum.weight += sign;
  }
  [[nodiscard]] const Eigen::Vector3d& at(std::size_t track) const { return sums_[track].place; }

 private:
  struct Sum {
    Eigen::Vector3d place;
    double weight;
  };
  std::vector<Sum> sums_;
};

/// Cost of assigning a body to a track; a distance as long as the track's gate costs 1. For a ray
/// body it is the misfit of the rays, NaN if there is none. For other bodies it combines the
/// distance from `place` with the difference in size, and is higher for a track that is not
/// admitted. `unlike`: see unlike_worn().
double cost_of(const Loose& loose, const Candidate& candidate, const Eigen::Vector3d& place,
               double unlike) {
  const PlacedView& body = loose.view;
  const double otherwise = kWornReach * unlike;
  if (!body.rays) {
    const Track& track = candidate.track;
    return std::hypot(
               horizontal_distance(body.core, place, body.error + track.error, candidate.gate),
               kSizeReach * size_difference(loose.spans, track.usual), otherwise) /
               candidate.gate +
           (candidate.track.admitted ? 0.0 : kDoubtful);
  }
  const Eigen::Vector3d shift = candidate.predicted - candidate.track.core;
  auto off = misfit(body.view, candidate.track.joints, shift);
  if (!off) off = misfit(body.view, candidate.predicted);
  return off ? std::hypot(*off, otherwise) / candidate.gate
             : std::numeric_limits<double>::quiet_NaN();
}

/// Assigns one sensor's bodies to the tracks; true if anything changed.
bool assign_sensor(std::vector<Loose>& bodies, const std::vector<Candidate>& candidates,
                   const Places& places) {
  CostTable table{bodies.size(), candidates.size(), {}, 1.0, 1.0};
  for (const Loose& body : bodies) {
    for (std::size_t i = 0; i < candidates.size(); ++i)
      table.cost.push_back(cost_of(body, candidates[i], places.at(i), body.unlike[i]));
  }
  const auto chosen = assign(table);
  bool changed = false;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    changed = changed || bodies[i].track != chosen[i];
    bodies[i].track = chosen[i];
  }
  return changed;
}

BySensor by_sensor(std::vector<PlacedView> views, const std::vector<Candidate>& candidates) {
  BySensor sensors;
  for (PlacedView& view : views) {
    Loose loose{std::move(view), {}};
    loose.spans = spans_of({&loose.view, 1}, {});
    for (const Candidate& each : candidates)
      loose.unlike.push_back(unlike_worn(loose.view.view, each.worn).value_or(0.0));
    sensors[loose.view.view.sensor].push_back(std::move(loose));
  }
  return sensors;
}

void assign_all(BySensor& sensors, const std::vector<Candidate>& candidates) {
  Places places(candidates);
  const Places expected = places;
  for (auto& [sensor, bodies] : sensors) {
    assign_sensor(bodies, candidates, expected);
    for (const Loose& body : bodies) places.add(body, 1.0);
  }
  bool changed = sensors.size() > 1;
  for (int round = 0; round < kRounds && changed; ++round) {
    changed = false;
    for (auto& [sensor, bodies] : sensors) {
      for (const Loose& body : bodies) places.add(body, -1.0);
      changed = assign_sensor(bodies, candidates, places) || changed;
      for (const Loose& body : bodies) places.add(body, 1.0);
    }
  }
}

/// Complete linkage: distance of the view to the farthest member; none when its sensor already has
/// a member.
std::optional<double> linkage(const std::vector<PlacedView>& cluster, const PlacedView& view,
                              double limit) {
  if (has_sensor(cluster, view.view.sensor)) return std::nullopt;
  double farthest = 0.0;
  for (const PlacedView& member : cluster) {
    farthest = std::max(
        farthest, horizontal_distance(member.core, view.core, member.error + view.error, limit));
  }
  return farthest;
}

}  // namespace

std::vector<PlacedView> match(std::vector<PlacedView> views, std::vector<Candidate>& candidates) {
  BySensor sensors = by_sensor(std::move(views), candidates);
  assign_all(sensors, candidates);
  std::vector<PlacedView> leftovers;
  for (auto& [sensor, bodies] : sensors) {
    for (Loose& body : bodies) {
      auto& home = body.track ? candidates[*body.track].sights : leftovers;
      home.push_back(std::move(body.view));
    }
  }
  return leftovers;
}

std::vector<std::vector<PlacedView>> cluster(std::vector<PlacedView> views, double limit) {
  std::vector<std::vector<PlacedView>> clusters;
  for (PlacedView& view : views) {
    std::vector<PlacedView>* nearest = nullptr;
    double least = limit;
    for (auto& members : clusters) {
      const auto distance = linkage(members, view, limit);
      if (!distance || *distance > least) continue;
      nearest = &members;
      least = *distance;
    }
    if (nearest) {
      nearest->push_back(std::move(view));
    } else {
      clusters.emplace_back().push_back(std::move(view));
    }
  }
  return clusters;
}

bool has_sensor(const std::vector<PlacedView>& views, const SensorId& sensor) {
  return std::ranges::any_of(views, [&](const PlacedView& s) { return s.view.sensor == sensor; });
}

}  // namespace chorus::associate
