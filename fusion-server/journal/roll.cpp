#include "fusion-server/journal/roll.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "fusion-server/journal/person_name.h"

namespace chorus::journal {
namespace {

/// Ids that are never listed again: only those of the last moments can still be in a snapshot.
constexpr std::size_t kMostForgotten = 64;

double rounded(double value, double step) {
  return std::isfinite(value) ? std::round(value / step) * step : value;
}

std::vector<SensorId> seen_by(const FusedBody& body, const std::vector<SensorId>& sensors) {
  std::uint64_t all = 0;
  for (const std::uint64_t joint : body.contributors) all |= joint;
  std::vector<SensorId> seeing;
  for (std::size_t i = 0; i < sensors.size() && i < 64; ++i) {
    if ((all >> i & 1) != 0) seeing.push_back(sensors[i]);
  }
  return seeing;
}

void update(KnownPerson& person, const FusedBody& body, const Snapshot& snapshot) {
  constexpr double kPercent = 0.01;
  constexpr double kCentimetre = 0.01;
  const bool seen = !body.carried_for;
  if (seen) {
    person.last_seen.reset();
  } else if (person.presence != Presence::Expected) {
    person.last_seen = snapshot.instant - from_seconds(*body.carried_for);
  }
  person.presence = seen ? Presence::Seen : Presence::Expected;
  person.slot = body.slot;
  person.sensors = seen_by(body, snapshot.sensors);
  if (body.sides_confidence) person.sides_confidence = rounded(*body.sides_confidence, kPercent);
  if (body.stature) {
    person.stature = LearnedLength{rounded(body.stature->length, kCentimetre),
                                   rounded(body.stature->sigma, kCentimetre)};
  }
}

bool same(const KnownPerson& a, const KnownPerson& b) {
  const auto lengths = [](const KnownPerson& p) {
    return p.stature ? std::pair{p.stature->length, p.stature->sigma} : std::pair{0.0, 0.0};
  };
  return a.id == b.id && a.name == b.name && a.presence == b.presence && a.slot == b.slot &&
         a.sides_confidence == b.sides_confidence && lengths(a) == lengths(b) &&
         a.sensors == b.sensors && a.correction == b.correction;
}

tl::unexpected<Error> unknown(PersonId id) {
  return fail(ErrorCode::NotFound, "people/" + std::to_string(id.value),
              "nobody with this id is known; GET /people/ lists who is");
}

}  // namespace

std::string_view name_of(Presence presence) {
  switch (presence) {
    case Presence::Seen:
      return "seen";
    case Presence::Expected:
      return "expected";
    case Presence::Left:
      break;
  }
  return "left";
}

KnownPerson& Roll::entry_of(PersonId id, Timestamp instant) {
  const auto place = std::ranges::lower_bound(people_, id, {}, &KnownPerson::id);
  if (place != people_.end() && place->id == id) return *place;
  KnownPerson newcomer;
  newcomer.id = id;
  newcomer.since = instant;
  return *people_.insert(place, std::move(newcomer));
}

bool Roll::take(const Snapshot& snapshot) {
  const auto before = people_;
  if (instant_ - snapshot.instant > remember_)
    people_.clear();
  else if (snapshot.instant < instant_)
    return false;
  instant_ = snapshot.instant;
  std::set<PersonId> here;
  for (const FusedBody& body : snapshot.bodies) {
    if (forgotten_.contains(body.id)) continue;
    here.insert(body.id);
    update(entry_of(body.id, snapshot.instant), body, snapshot);
  }
  for (const Correction& each : snapshot.corrections) {
    if (here.contains(each.person)) entry_of(each.person, snapshot.instant).correction = each;
  }
  for (KnownPerson& person : people_) {
    if (here.contains(person.id) || person.presence == Presence::Left) continue;
    if (!person.last_seen) person.last_seen = snapshot.instant;
    person.presence = Presence::Left;
    person.slot.reset();
    person.sensors.clear();
  }
  std::erase_if(people_, [&](const KnownPerson& person) {
    return person.presence == Presence::Left &&
           snapshot.instant - person.last_seen.value_or(snapshot.instant) > remember_;
  });
  return !std::ranges::equal(before, people_, same);
}

const KnownPerson* Roll::find(PersonId id) const {
  const auto place = std::ranges::lower_bound(people_, id, {}, &KnownPerson::id);
  return place != people_.end() && place->id == id ? &*place : nullptr;
}

Result<void> Roll::rename(PersonId id, std::string_view name) {
  auto checked = checked_name(name);
  if (!checked) return pass(checked);
  if (find(id) == nullptr) return unknown(id);
  for (KnownPerson& other : people_) {
    if (checked->empty() || other.id == id || other.name != *checked) continue;
    if (other.presence != Presence::Left)
      return fail(ErrorCode::Conflict, "name",
                  "person " + std::to_string(other.id.value) + ", who is here, has this name");
    other.name.clear();
  }
  entry_of(id, {}).name = std::move(*checked);
  return {};
}

Result<void> Roll::forget(PersonId id) {
  if (find(id) == nullptr) return unknown(id);
  std::erase_if(people_, [&](const KnownPerson& person) { return person.id == id; });
  forgotten_.insert(id);
  if (forgotten_.size() > kMostForgotten) forgotten_.erase(forgotten_.begin());
  return {};
}

}  // namespace chorus::journal
