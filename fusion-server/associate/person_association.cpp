#include "fusion-server/associate/person_association.h"

#include <algorithm>
#include <iterator>
#include <tuple>
#include <utility>

#include "fusion-server/associate/existence.h"
#include "fusion-server/associate/matching.h"
#include "fusion-server/associate/mirrors.h"
#include "fusion-server/associate/recognition.h"
#include "fusion-server/associate/track_motion.h"
#include "fusion-server/associate/worn_likeness.h"

namespace chorus::associate {
namespace {

constexpr std::size_t kMaxTracks = 256;  // Four times what a frame may contain.
// How long an unpublished track is looked for.
constexpr Duration kCoastUnknown = std::chrono::seconds(1);
// An unseen person has left if sensors on different sides have seen through the person's place for
// this long.
constexpr Duration kGone = std::chrono::milliseconds(200);

/// The views with their cores, ordered by sensor and body, so that the result does not depend on
/// the order of arrival. Views that show no place and no rays are left out.
std::vector<PlacedView> placed_views(std::vector<SensorView> views) {
  std::vector<PlacedView> sights;
  for (SensorView& view : views) {
    const auto core = middle_of(points_of(view.skeleton));
    const bool rays = has_rays_alone(view.skeleton.joints) && view.eye.allFinite();
    if (!core && !rays) continue;
    const PlanError error = rays ? PlanError::Zero() : stated_error(view.skeleton);
    sights.push_back({std::move(view), core.value_or(Eigen::Vector3d::Zero()), error, rays});
  }
  std::sort(sights.begin(), sights.end(), [](const PlacedView& a, const PlacedView& b) {
    return std::tie(a.view.sensor, a.view.body) < std::tie(b.view.sensor, b.view.body);
  });
  return sights;
}

bool is_settled(const Track& track, const AssociationConfig& config) {
  return track.admitted && track.hits >= config.confirm_frames;
}

/// The tracks that are still looked for; the others are passed to miss(). Also forgets people who
/// have been missing for too long.
std::vector<Candidate> expected(Tracks& tracks, Timestamp instant,
                                const AssociationConfig& config) {
  std::vector<Candidate> candidates;
  for (const Track& track : tracks.people) {
    const Duration age = std::chrono::abs(instant - track.placed);
    const Duration coast = track.named && is_settled(track, config)
                               ? config.coast
                               : std::min(config.coast, kCoastUnknown);
    if (age <= coast) {
      candidates.push_back(predict(track, instant, config));
    } else {
      miss(track, tracks);
    }
  }
  forget(tracks, instant, config);
  return candidates;
}

void dress(std::vector<Candidate>& candidates, const WornPeople& worn) {
  for (Candidate& each : candidates) {
    const auto own = worn.find(each.track.id);
    if (own != worn.end()) each.worn = own->second;
  }
}

/// Follows how unlike their wearers the views are.  While no view shows a limb with a sensor, what
/// was known stays.
void compare_worn(std::vector<Candidate>& candidates, double elapsed) {
  constexpr double kMean = 0.5;  // [s]
  const double share = elapsed / (elapsed + kMean);
  for (Candidate& each : candidates) {
    if (each.sights.empty()) continue;
    const auto now = each.worn.empty() ? std::optional(0.0) : unlike_worn(each.sights, each.worn);
    if (now) each.track.unlike += share * (*now - each.track.unlike);
  }
}

/// Removes a new body that only one sensor sees, if this sensor and another one already see a
/// person there: the new body is a second detection of that person.
void drop_rivals(std::vector<std::vector<PlacedView>>& newcomers,
                 const std::vector<Candidate>& candidates, double limit) {
  std::erase_if(newcomers, [&](const std::vector<PlacedView>& members) {
    return members.size() == 1 && std::ranges::any_of(candidates, [&](const Candidate& each) {
             return each.sights.size() > 1 && has_sensor(each.sights, members[0].view.sensor) &&
                    horizontal_distance(each.predicted, members[0].core,
                                        each.track.error + members[0].error, limit) <= limit;
           });
  });
}

bool share_a_sensor(const Candidate& a, const Candidate& b) {
  return std::any_of(a.sights.begin(), a.sights.end(),
                     [&](const PlacedView& s) { return has_sensor(b.sights, s.view.sensor); });
}

/// True if both candidates are seen at one spot at this instant, but by different sensors.
bool on_one_spot(const Candidate& a, const Candidate& b, double limit) {
  return !a.sights.empty() && !b.sights.empty() && !share_a_sensor(a, b) &&
         horizontal_distance(a.track.core, b.track.core, a.track.error + b.track.error, limit) <=
             limit;
}

/// Puts published tracks before the others, and in each group older tracks first (ids only grow).
void seniors_first(std::vector<Candidate>& candidates, const AssociationConfig& config) {
  std::stable_partition(candidates.begin(), candidates.end(), [&](const Candidate& candidate) {
    return is_settled(candidate.track, config);
  });
}

/// Merges tracks on one spot; of each two, the first in the order of seniors_first() is kept.
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
}

/// Removes people whom no sensor sees and through whose place sensors on different sides have seen
/// for kGone.
void leave(std::vector<Candidate>& candidates, const Gaze& gaze, Duration elapsed, Tracks& tracks) {
  std::erase_if(candidates, [&](Candidate& candidate) {
    Track& track = candidate.track;
    if (!candidate.sights.empty()) return false;
    const bool through = gaze.seen_through(track.id, candidate.predicted);
    track.through = through ? track.through + elapsed : Duration{0};
    if (track.through < kGone) return false;
    miss(track, tracks);
    return true;
  });
}

std::vector<Assigned> assigned(const std::vector<Candidate>& candidates,
                               const AssociationConfig& config) {
  std::vector<Assigned> bodies;
  for (const Candidate& candidate : candidates) {
    const bool settled = is_settled(candidate.track, config);
    for (const PlacedView& sight : candidate.sights)
      bodies.push_back({sight.view.sensor, sight.core, sight.error, candidate.track.id, settled,
                        is_on_floor(sight)});
  }
  return bodies;
}

/// True if the sensors' own floors, or the people so far, show that the floor is at y = 0.
bool knows_floor(const std::vector<Observer>& observers, const Tracks& tracks) {
  return tracks.floor_seen || std::ranges::any_of(observers, &Observer::knows_floor);
}

/// Judges everybody who is seen, and removes who has left.
std::vector<Standing> judge_all(std::vector<Candidate>& candidates,
                                const std::vector<Observer>& observers, Duration passed,
                                Tracks& tracks, const AssociationConfig& config) {
  const Duration elapsed = std::min(passed, kLongestInstant);
  reflect(candidates, observers, seconds(elapsed), tracks.mirrors);
  const std::vector<Assigned> bodies = assigned(candidates, config);
  const Gaze gaze(observers, bodies, tracks.fields, config.gate);
  const Sitting sitting{elapsed, passed, config.doubt, knows_floor(observers, tracks)};
  std::vector<Standing> standings;
  for (Candidate& candidate : candidates) {
    if (candidate.sights.empty()) continue;
    standings.push_back(judge(candidate.track, gaze, sitting));
  }
  leave(candidates, gaze, elapsed, tracks);
  for (const Candidate& candidate : candidates) {
    if (candidate.sights.empty()) continue;
    learn(candidate.track, gaze, seconds(elapsed), tracks.fields);
    const bool sure = candidate.track.admitted && candidate.sights.size() > 1;
    const bool stands =
        std::ranges::all_of(gaze.sights_of(candidate.track.id), &Assigned::on_floor);
    tracks.floor_seen = tracks.floor_seen || (sure && stands);
  }
  return standings;
}

/// Keeps only as many people as a frame may contain; false bodies must not displace people whom
/// several sensors see.
void keep_the_best(std::vector<Person>& people) {
  if (people.size() <= kMaxBodies) return;
  std::stable_partition(people.begin(), people.end(),
                        [](const Person& person) { return person.views.size() > 1; });
  people.erase(people.begin() + kMaxBodies, people.end());
  std::sort(people.begin(), people.end(),
            [](const Person& a, const Person& b) { return a.id < b.id; });
}

/// A person with all views; if no sensor sees the person, they are placed where they are expected.
Person person_of(Candidate& candidate) {
  Person person{candidate.track.id, {}};
  if (candidate.sights.empty()) person.carried = candidate.predicted;
  for (PlacedView& sight : candidate.sights) person.views.push_back(std::move(sight.view));
  return person;
}

std::vector<Person> published(std::vector<Candidate>& candidates, Timestamp instant,
                              const AssociationConfig& config) {
  std::vector<Person> people;
  for (Candidate& candidate : candidates) {
    const Track& track = candidate.track;
    // Whom one camera without depth alone sees is tracked for `coast` after others have seen them.
    const bool recent = instant - track.seen <= config.carry;
    const bool shown = track.named && !track.withheld && is_settled(track, config);
    if (!recent || !shown) continue;
    candidate.track.published = instant;
    people.push_back(person_of(candidate));
  }
  keep_the_best(people);
  return people;
}

/// Moves the ray bodies out of `views`, and returns them.
std::vector<PlacedView> taken_rays(std::vector<PlacedView>& views) {
  const auto rays = std::stable_partition(views.begin(), views.end(),
                                          [](const PlacedView& view) { return !view.rays; });
  std::vector<PlacedView> taken(std::make_move_iterator(rays),
                                std::make_move_iterator(views.end()));
  views.erase(rays, views.end());
  return taken;
}

/// Makes each group of views a new candidate, and locates its joints.
std::vector<Candidate> found(std::vector<std::vector<PlacedView>> people, std::uint64_t& next_id,
                             const AssociationConfig& config) {
  std::vector<Candidate> candidates;
  for (auto& members : people) {
    Candidate fresh;
    fresh.track.id = PersonId{next_id++};
    fresh.track.joints = locate(members);
    fresh.track.core = fresh.predicted =
        middle_of(fresh.track.joints).value_or(Eigen::Vector3d::Zero());
    fresh.track.appeared = fresh.track.core;
    fresh.gate = config.gate;
    fresh.sights = std::move(members);
    candidates.push_back(std::move(fresh));
  }
  return candidates;
}

/// Creates new people from the views that fit no track.
std::vector<Candidate> newcomers(std::vector<PlacedView> views,
                                 const std::vector<Candidate>& candidates, std::uint64_t& next_id,
                                 const AssociationConfig& config) {
  std::vector<PlacedView> rays = taken_rays(views);
  auto clusters = cluster(std::move(views), config.cluster);
  drop_rivals(clusters, candidates, config.cluster);
  std::vector<Candidate> fresh = found(std::move(clusters), next_id, config);
  if (rays.empty()) return fresh;
  rays = match(std::move(rays), fresh);
  auto met = meet(std::move(rays), config.ray_cluster, config.bodies);
  std::ranges::move(found(std::move(met), next_id, config), std::back_inserter(fresh));
  return fresh;
}

}  // namespace

Grouping group(Scene scene, const Tracks& before, const AssociationConfig& config) {
  const Timestamp instant = scene.instant;
  Grouping grouping{{}, {}, before, {}};
  Tracks& tracks = grouping.tracks;
  tracks.next_id = std::max<std::uint64_t>(tracks.next_id, 1);
  std::vector<Candidate> candidates = expected(tracks, instant, config);
  dress(candidates, scene.worn);
  std::vector<PlacedView> leftovers = match(placed_views(std::move(scene.views)), candidates);
  for (Candidate& each : newcomers(std::move(leftovers), candidates, tracks.next_id, config)) {
    if (candidates.size() < kMaxTracks) candidates.push_back(std::move(each));
  }
  for (Candidate& candidate : candidates) update(candidate, instant);
  merge_doubles(candidates, config);
  const Duration passed = std::clamp(instant - before.instant, Duration{0}, config.coast);
  grouping.standings = judge_all(candidates, scene.observers, passed, tracks, config);
  compare_worn(candidates, seconds(std::min(passed, kLongestInstant)));
  grouping.corrections = recognise(candidates, tracks, {instant, scene.worn}, config);
  std::ranges::sort(candidates, {}, [](const Candidate& one) { return one.track.id; });
  grouping.people = published(candidates, instant, config);
  tracks.people.clear();
  for (Candidate& each : candidates) tracks.people.push_back(std::move(each.track));
  tracks.instant = instant;
  return grouping;
}

}  // namespace chorus::associate
