#include "fusion-server/associate/person_association.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <optional>
#include <tuple>
#include <utility>

#include "common/body/bones.h"
#include "fusion-server/associate/admission.h"
#include "fusion-server/associate/assignment.h"

namespace chorus::associate {
namespace {

constexpr std::size_t kMaxTracks = 256;  // four times what a frame holds
constexpr double kVelocityBlend = 0.2;   // exponential smoothing of the velocity; ~0.15 s at 30 Hz
constexpr double kFastest = 4.0;         // [m/s] a sprint; limits the harm of one wrong view

double horizontal_distance(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::hypot(a.x() - b.x(), a.z() - b.z());
}

/// Ordered by sensor and body, so that the result does not depend on the order of arrival.
std::vector<PlacedView> placed_views(std::vector<SensorView> views) {
  std::vector<PlacedView> sights;
  for (SensorView& view : views) {
    const auto core = middle_of(points_of(view.skeleton));
    const bool rays = has_rays_alone(view.skeleton.joints) && view.eye.allFinite();
    if (core || rays)
      sights.push_back({std::move(view), core.value_or(Eigen::Vector3d::Zero()), rays});
  }
  std::sort(sights.begin(), sights.end(), [](const PlacedView& a, const PlacedView& b) {
    return std::tie(a.view.sensor, a.view.body) < std::tie(b.view.sensor, b.view.body);
  });
  return sights;
}

/// A track while its instant is being processed.
struct Candidate {
  Track track;
  Eigen::Vector3d predicted = Eigen::Vector3d::Zero();
  std::vector<PlacedView> sights;
};

std::vector<Candidate> predict(const Tracks& tracks, Timestamp instant,
                               const AssociationConfig& config) {
  std::vector<Candidate> candidates;
  for (const Track& track : tracks.people) {
    const Duration age = instant - track.seen;
    if (age > config.coast || age < -config.coast) continue;
    candidates.push_back({track, track.core + seconds(age) * track.velocity, {}});
  }
  return candidates;
}

/// Distance of a body from a track [m]; NaN when it cannot be told.
double cost_of(const PlacedView& body, const Candidate& candidate) {
  if (!body.rays) return horizontal_distance(body.core, candidate.predicted);
  const Eigen::Vector3d shift = candidate.predicted - candidate.track.core;
  auto off = misfit(body.view, candidate.track.joints, shift);
  if (!off) off = misfit(body.view, candidate.predicted);
  return off.value_or(std::numeric_limits<double>::quiet_NaN());
}

/// Assigns one sensor's bodies to the tracks; returns those without a track.
std::vector<PlacedView> match_sensor(std::vector<PlacedView> bodies,
                                     std::vector<Candidate>& candidates, double gate) {
  CostTable table{bodies.size(), candidates.size(), {}, gate};
  for (const PlacedView& body : bodies) {
    for (const Candidate& c : candidates) {
      table.cost.push_back(cost_of(body, c));
    }
  }
  const auto chosen = assign(table);
  std::vector<PlacedView> leftovers;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    auto& home = chosen[i] ? candidates[*chosen[i]].sights : leftovers;
    home.push_back(std::move(bodies[i]));
  }
  return leftovers;
}

std::vector<PlacedView> match(std::vector<PlacedView> sights, std::vector<Candidate>& candidates,
                              double gate) {
  std::map<SensorId, std::vector<PlacedView>> by_sensor;
  for (PlacedView& sight : sights) by_sensor[sight.view.sensor].push_back(std::move(sight));
  std::vector<PlacedView> leftovers;
  for (auto& [sensor, bodies] : by_sensor) {
    for (PlacedView& left : match_sensor(std::move(bodies), candidates, gate)) {
      leftovers.push_back(std::move(left));
    }
  }
  return leftovers;
}

bool has_sensor(const std::vector<PlacedView>& sights, const SensorId& sensor) {
  return std::any_of(sights.begin(), sights.end(),
                     [&](const PlacedView& s) { return s.view.sensor == sensor; });
}

/// Complete linkage: distance to the farthest member; none when the sensor already has a member.
std::optional<double> linkage(const std::vector<PlacedView>& cluster, const PlacedView& sight) {
  if (has_sensor(cluster, sight.view.sensor)) return std::nullopt;
  double farthest = 0.0;
  for (const PlacedView& member : cluster) {
    farthest = std::max(farthest, horizontal_distance(member.core, sight.core));
  }
  return farthest;
}

std::vector<std::vector<PlacedView>> cluster(std::vector<PlacedView> sights, double limit) {
  std::vector<std::vector<PlacedView>> clusters;
  for (PlacedView& sight : sights) {
    std::vector<PlacedView>* nearest = nullptr;
    double least = limit;
    for (auto& members : clusters) {
      const auto distance = linkage(members, sight);
      if (!distance || *distance > least) continue;
      nearest = &members;
      least = *distance;
    }
    if (nearest) {
      nearest->push_back(std::move(sight));
    } else {
      clusters.emplace_back().push_back(std::move(sight));
    }
  }
  return clusters;
}

bool share_a_sensor(const Candidate& a, const Candidate& b) {
  return std::any_of(a.sights.begin(), a.sights.end(),
                     [&](const PlacedView& s) { return has_sensor(b.sights, s.view.sensor); });
}

/// Mean of the views that have a place, else where the rays meet; nothing for a single ray body.
std::optional<Eigen::Vector3d> centre_of(const Candidate& candidate) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double count = 0.0;
  for (const PlacedView& s : candidate.sights) {
    if (s.rays) continue;
    sum += s.core;
    count += 1.0;
  }
  if (count == 0.0) return middle_of(candidate.track.joints);
  return Eigen::Vector3d(sum / count);
}

/// A track seen by only one camera stays at its predicted place, for as long as unseen tracks last.
void update(Candidate& candidate, Timestamp instant) {
  if (candidate.sights.empty()) return;
  Track& track = candidate.track;
  const bool rays = std::ranges::any_of(candidate.sights, &PlacedView::rays);
  const Located before = std::exchange(track.joints, {});
  if (rays) track.joints = locate(candidate.sights);
  const auto found = centre_of(candidate);
  const auto place_rays = [&](const Eigen::Vector3d& core) {
    for (PlacedView& sight : candidate.sights) {
      if (sight.rays) sight.core = core;
    }
  };
  place_rays(found.value_or(candidate.predicted));
  if (!found) {
    track.joints = before;
    return;
  }
  const Eigen::Vector3d& centre = *found;
  const double elapsed = seconds(instant - track.seen);
  if (track.hits > 0 && elapsed > 0) {
    const Eigen::Vector3d step = (centre - track.core) / elapsed;
    track.velocity += kVelocityBlend * (step - track.velocity);
    const double speed = track.velocity.norm();
    if (speed > kFastest) track.velocity *= kFastest / speed;
  }
  track.core = centre;
  track.seen = instant;
  ++track.hits;
}

bool is_settled(const Track& track, const AssociationConfig& config) {
  return track.admitted && track.hits >= config.confirm_frames;
}

/// Both are seen at the same spot at this instant, but by different sensors.
bool on_one_spot(const Candidate& a, const Candidate& b, double limit) {
  return !a.sights.empty() && !b.sights.empty() && !share_a_sensor(a, b) &&
         horizontal_distance(a.track.core, b.track.core) <= limit;
}

/// Published tracks first; within each group the older first (ids only grow).
void seniors_first(std::vector<Candidate>& candidates, const AssociationConfig& config) {
  std::stable_partition(candidates.begin(), candidates.end(), [&](const Candidate& candidate) {
    return is_settled(candidate.track, config);
  });
}

/// Of two tracks on the same spot the first in this order keeps the person.
void merge_doubles(std::vector<Candidate>& candidates, const AssociationConfig& config) {
  seniors_first(candidates, config);
  for (std::size_t i = 1; i < candidates.size(); ++i) {
    Candidate& young = candidates[i];
    const auto end = candidates.begin() + static_cast<std::ptrdiff_t>(i);
    const auto old = std::find_if(candidates.begin(), end, [&](const Candidate& older) {
      return on_one_spot(older, young, config.cluster);
    });
    young.track.shadowed = old == end ? 0 : young.track.shadowed + 1;
    const bool published = is_settled(young.track, config);
    const bool same_person =
        old != end && (!published || young.track.shadowed >= config.merge_frames);
    if (!same_person) continue;
    std::move(young.sights.begin(), young.sights.end(), std::back_inserter(old->sights));
    candidates.erase(end);
    --i;
  }
  std::ranges::sort(candidates, {}, [](const Candidate& one) { return one.track.id; });
}

void admit(std::vector<Candidate>& candidates, const std::vector<Observer>& observers,
           Duration elapsed, const AssociationConfig& config) {
  const auto waits = [](const Candidate& candidate) { return !candidate.track.admitted; };
  if (std::ranges::none_of(candidates, waits)) return;
  std::vector<Assigned> bodies;
  for (const Candidate& candidate : candidates) {
    const bool settled = is_settled(candidate.track, config);
    for (const PlacedView& sight : candidate.sights)
      bodies.push_back({sight.view.sensor, sight.core, candidate.track.id, settled});
  }
  const Admission admission(observers, bodies, elapsed, config);
  for (Candidate& candidate : candidates) admission.judge(candidate.track);
}

/// Keeps as many as a frame holds; false bodies must not displace people whom several sensors see.
void keep_the_best(std::vector<Person>& people) {
  if (people.size() <= kMaxBodies) return;
  std::stable_partition(people.begin(), people.end(),
                        [](const Person& person) { return person.views.size() > 1; });
  people.erase(people.begin() + kMaxBodies, people.end());
  std::sort(people.begin(), people.end(),
            [](const Person& a, const Person& b) { return a.id < b.id; });
}

Grouping publish(std::vector<Candidate> candidates, const AssociationConfig& config) {
  Grouping grouping;
  for (Candidate& candidate : candidates) {
    grouping.tracks.people.push_back(candidate.track);
    if (candidate.sights.empty() || !is_settled(candidate.track, config)) continue;
    Person person{candidate.track.id, {}};
    for (PlacedView& sight : candidate.sights) person.views.push_back(std::move(sight.view));
    grouping.people.push_back(std::move(person));
  }
  keep_the_best(grouping.people);
  return grouping;
}

/// Moves the ray bodies out of `views` and returns them.
std::vector<PlacedView> taken_rays(std::vector<PlacedView>& views) {
  const auto rays = std::stable_partition(views.begin(), views.end(),
                                          [](const PlacedView& view) { return !view.rays; });
  std::vector<PlacedView> taken(std::make_move_iterator(rays),
                                std::make_move_iterator(views.end()));
  views.erase(rays, views.end());
  return taken;
}

/// Makes a candidate of each group of views, with the places of its joints.
std::vector<Candidate> found(std::vector<std::vector<PlacedView>> people, std::uint64_t& next_id) {
  std::vector<Candidate> candidates;
  for (auto& members : people) {
    Candidate fresh;
    fresh.track.id = PersonId{next_id++};
    fresh.track.joints = locate(members);
    fresh.track.core = fresh.predicted =
        middle_of(fresh.track.joints).value_or(Eigen::Vector3d::Zero());
    fresh.sights = std::move(members);
    candidates.push_back(std::move(fresh));
  }
  return candidates;
}

}  // namespace

Grouping group(Scene scene, const Tracks& tracks, const AssociationConfig& config) {
  const Timestamp instant = scene.instant;
  std::vector<Candidate> candidates = predict(tracks, instant, config);
  std::vector<PlacedView> leftovers =
      match(placed_views(std::move(scene.views)), candidates, config.gate);
  std::uint64_t next_id = std::max<std::uint64_t>(tracks.next_id, 1);
  std::vector<PlacedView> rays = taken_rays(leftovers);
  std::vector<Candidate> fresh = found(cluster(std::move(leftovers), config.cluster), next_id);
  if (!rays.empty()) {
    rays = match(std::move(rays), fresh, config.gate);
    for (Candidate& each : found(meet(std::move(rays), config.ray_cluster, config.bodies), next_id))
      fresh.push_back(std::move(each));
  }
  for (Candidate& each : fresh) {
    if (candidates.size() < kMaxTracks) candidates.push_back(std::move(each));
  }
  for (Candidate& candidate : candidates) update(candidate, instant);
  merge_doubles(candidates, config);
  const Duration elapsed = std::clamp(instant - tracks.instant, Duration{0}, config.coast);
  admit(candidates, scene.observers, elapsed, config);
  Grouping grouping = publish(std::move(candidates), config);
  grouping.tracks.next_id = next_id;
  grouping.tracks.instant = instant;
  return grouping;
}

}  // namespace chorus::associate
