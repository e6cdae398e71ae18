#include "services/evaluation/wearer_search.h"

#include <utility>

namespace chorus::evaluation_service {
namespace {

constexpr Duration kBetween = std::chrono::milliseconds(100);
constexpr Duration kEvery = std::chrono::seconds(3);
constexpr Duration kSpan = std::chrono::seconds(8);
/// Who was seen in fewer of the instants than this has just come.
constexpr double kLeastSeen = 0.5;

}  // namespace

void WearerSearch::forget() {
  instants_.clear();
  searched_.reset();
}

std::optional<PersonId> WearerSearch::take(WornInstant instant,
                                           const std::map<std::string, inertial::Limb>& limbs) {
  if (!instants_.empty() && instant.at - instants_.back().at < kBetween) return std::nullopt;
  const Timestamp now = instant.at;
  instants_.push_back(std::move(instant));
  std::erase_if(instants_, [&](const WornInstant& each) { return now - each.at > kSpan; });
  if (!searched_) searched_ = now;
  if (now - *searched_ < kEvery) return std::nullopt;
  searched_ = now;
  return search(limbs);
}

std::optional<PersonId> WearerSearch::search(const std::map<std::string, inertial::Limb>& limbs) {
  std::map<PersonId, std::pair<evaluation::TrackedBody, std::size_t>> people;
  std::map<std::string, evaluation::OrientationTrack> tracks;
  for (const WornInstant& each : instants_) {
    const double time = seconds(each.at - instants_.front().at);
    for (const auto& [person, seen] : each.people) {
      auto& [body, count] = people[person];
      ++count;
      for (const auto& [limb, tracked] : seen) body[limb].push_back({time, tracked});
    }
    for (const auto& [sensor, said] : each.sensors) tracks[sensor].push_back({time, said});
  }
  std::vector<evaluation::WornSensor> sensors;
  std::vector<inertial::Limb> worn;
  for (const auto& [name, track] : tracks) {
    const auto limb = limbs.find(name);
    if (limb == limbs.end()) continue;
    sensors.push_back({name, track});
    worn.push_back(limb->second);
  }
  std::vector<PersonId> ids;
  std::vector<evaluation::TrackedBody> bodies;
  for (auto& [person, seen] : people) {
    if (static_cast<double>(seen.second) < kLeastSeen * static_cast<double>(instants_.size()))
      continue;
    ids.push_back(person);
    bodies.push_back(std::move(seen.first));
  }
  const auto found = evaluation::worn_by(sensors, worn, bodies);
  reason_ = found ? "" : found.error().message;
  return found ? std::optional(ids[*found]) : std::nullopt;
}

}  // namespace chorus::evaluation_service
