#include "fusion-server/associate/recognition.h"

#include <algorithm>
#include <optional>
#include <utility>

namespace chorus::associate {
namespace {

constexpr std::size_t kMostMissingTracks = 64;
// Time in view [s], summed over the views, after which builds can exclude people.
constexpr double kGlance = 1.5;
// With n times as many views as this, a fraction 1/n of the time is enough to recognise somebody.
constexpr double kManyViews = 4.0;
constexpr double kUsual = 2.0;        // [s] in view after which a build is the person's usual one
constexpr double kImpossible = -4.0;  // Log odds at which a person is excluded.
// Prior log odds that a person found after a gap, at the expected place, is the one from before it.
constexpr double kContinuity = 1.5;
// Log odds below which a person found after a gap is not published while the builds are compared.
constexpr double kUnlikely = -0.5;
// A newcomer not recognised within this time plus config.recognise is taken for a new person.
constexpr Duration kNoBones = std::chrono::seconds(2);

/// True if the candidate's person is missing.  A candidate without an id passed it on in become(),
/// and is about to be erased.
bool has_left(const Candidate& candidate) {
  return candidate.track.id != PersonId{} && candidate.sights.empty() &&
         (candidate.track.named || candidate.track.before);
}

Missing missing_of(const Track& track) {
  return {track.id, track.before ? track.lost : track.seen, track.before.value_or(track.build)};
}

/// The people who were already missing at `found`, when a track was found that may be one of them.
std::vector<Missing> missing_before(Timestamp found, const std::vector<Candidate>& candidates,
                                    const Tracks& tracks) {
  std::vector<Missing> all = tracks.missing;
  for (const Candidate& each : candidates) {
    if (has_left(each)) all.push_back(missing_of(each.track));
  }
  std::erase_if(all, [&](const Missing& each) { return each.seen > found; });
  return all;
}

/// True if the build was seen long enough to decide whether two people are the same.
bool is_looked_at(const Build& build, const AssociationConfig& config) {
  return sight_of(build) * std::max(1.0, build.views / kManyViews) >= seconds(config.recognise);
}

bool is_glance(const Build& build) { return sight_of(build) * build.views >= kGlance; }

/// The person that a build most likely belongs to; `odds` are log odds.
struct Likeliest {
  std::optional<PersonId> id;
  double odds = 0.0;
};

Likeliest likeliest_of(const Build& build, const std::vector<Missing>& missing,
                       const Repeatability& repeatability) {
  Likeliest best;
  for (const Missing& each : missing) {
    const double odds = likeness(build, each.build, repeatability);
    if (!best.id || odds > best.odds) best = {each.id, odds};
  }
  return best;
}

/// Gives a missing person's id to the track.
void become(Track& track, PersonId id, std::vector<Candidate>& candidates, Tracks& tracks) {
  for (Missing& each : tracks.missing) {
    if (each.id == id) track.build.add(each.build);
  }
  std::erase_if(tracks.missing, [&](const Missing& each) { return each.id == id; });
  for (Candidate& each : candidates) {
    if (each.track.id != id || !has_left(each)) continue;
    track.build.add(missing_of(each.track).build);
    each.track.id = PersonId{};  // This candidate is removed later.
  }
  track.id = id;
}

/// Gives a newcomer the id of the missing person whom the build shows them to be.  True once it is
/// decided who they are: recognised, new to all, or taken for new after a time.
bool name(Candidate& candidate, std::vector<Candidate>& candidates, Tracks& tracks,
          const AssociationConfig& config) {
  Track& track = candidate.track;
  const auto missing = missing_before(track.found, candidates, tracks);
  if (missing.empty()) return true;
  const Likeliest best = likeliest_of(track.build, missing, tracks.repeatability);
  const bool looked_at = is_looked_at(track.build, config);
  if (looked_at && best.odds > 0) {
    become(track, *best.id, candidates, tracks);
    return true;
  }
  const bool new_to_all = is_glance(track.build) && best.odds < kImpossible;
  return looked_at || new_to_all || track.seen - track.found > kNoBones + config.recognise;
}

/// Compares the builds from before and after the gap, of a person who was found again.
void question(Track& track, Tracks& tracks, const AssociationConfig& config) {
  const double odds = kContinuity + likeness(*track.before, track.build, tracks.repeatability);
  const bool looked_at = is_looked_at(track.build, config);
  track.named = !is_glance(track.build) || odds > kUnlikely;
  if ((is_glance(track.build) && odds < kImpossible) || (looked_at && odds < 0)) {
    miss(track, tracks);
    track.id = PersonId{tracks.next_id++};
    track.before.reset();
    track.named = false;
    track.found = track.lost;
  } else if (looked_at) {
    track.build.add(*std::exchange(track.before, std::nullopt));
    track.named = true;
  }
}

/// Learns from a person who stays in view how well the sensors repeat a build.
void compare_seconds(Track& track, Repeatability& repeatability) {
  if (sight_of(track.second) < 1.0) return;
  if (!track.before && sight_of(track.build) >= kUsual)
    repeatability.learn(track.second, track.build);
  track.second = {};
}

}  // namespace

void miss(const Track& track, Tracks& tracks) {
  if (!(track.named || track.before) || !track.admitted) return;
  tracks.missing.push_back(missing_of(track));
  if (tracks.missing.size() > kMostMissingTracks) tracks.missing.erase(tracks.missing.begin());
}

void forget(Tracks& tracks, Timestamp instant, const AssociationConfig& config) {
  std::erase_if(tracks.missing, [&](const Missing& each) {
    return instant < each.seen || instant - each.seen > config.remember;
  });
}

void forget(PersonId person, Tracks& tracks) {
  const auto is_this = [&](const auto& each) { return each.id == person; };
  std::erase_if(tracks.people, is_this);
  std::erase_if(tracks.missing, is_this);
}

void recognise(std::vector<Candidate>& candidates, Tracks& tracks,
               const AssociationConfig& config) {
  for (Candidate& each : candidates) {
    if (each.sights.empty()) continue;
    compare_seconds(each.track, tracks.repeatability);
    if (each.track.before) question(each.track, tracks, config);
    if (!each.track.named && !each.track.before && each.track.hits >= config.confirm_frames)
      each.track.named = name(each, candidates, tracks, config);
  }
  std::erase_if(candidates, [](const Candidate& each) { return each.track.id == PersonId{}; });
}

}  // namespace chorus::associate
