#include "common/importers/pose_people.h"

#include <algorithm>
#include <limits>

#include <Eigen/Geometry>

namespace chorus::importers {
namespace {

// Share of a person's size that the person may move from one picture to the next.
constexpr double kNear = 0.5;
constexpr int kRemembered = 30;  // pictures
constexpr double kSure = 0.1;    // lowest confidence of a point that counts here

Eigen::AlignedBox2d box_of(const PosePerson& person) {
  Eigen::AlignedBox2d box;
  for (const PosePoint& point : person.points) {
    if (point.confidence >= kSure) box.extend(point.pixel);
  }
  return box;
}

bool all_have_their_own_id(const std::vector<PosePerson>& people) {
  for (std::size_t i = 0; i < people.size(); ++i) {
    if (!people[i].id) return false;
    for (std::size_t j = 0; j < i; ++j) {
      if (people[j].id == people[i].id) return false;
    }
  }
  return true;
}

}  // namespace

std::vector<PeopleNumbers::Pair> PeopleNumbers::pairs(const std::vector<PosePerson>& people) const {
  std::vector<Pair> all;
  for (std::size_t i = 0; i < people.size(); ++i) {
    const auto box = box_of(people[i]);
    for (std::size_t k = 0; k < known_.size() && !box.isEmpty(); ++k) {
      const double distance = (box.center() - known_[k].middle).norm();
      if (distance <= kNear * std::max(box.diagonal().norm(), known_[k].size))
        all.push_back({distance, i, k});
    }
  }
  std::sort(all.begin(), all.end(),
            [](const Pair& a, const Pair& b) { return a.distance < b.distance; });
  return all;
}

void PeopleNumbers::follow(const std::vector<PosePerson>& people,
                           std::vector<std::uint64_t>& numbers) {
  std::vector<bool> taken(known_.size(), false);
  for (const Pair& pair : pairs(people)) {
    if (numbers[pair.person] != 0 || taken[pair.known]) continue;
    taken[pair.known] = true;
    numbers[pair.person] = known_[pair.known].number;
    const auto box = box_of(people[pair.person]);
    known_[pair.known] = {numbers[pair.person], box.center(), box.diagonal().norm(), 0};
  }
}

std::vector<std::uint64_t> PeopleNumbers::number(const std::vector<PosePerson>& people) {
  std::vector<std::uint64_t> numbers(people.size(), 0);
  // Done even if the picture shows nobody, or people with ids, so that people are forgotten in
  // time.
  std::erase_if(known_, [](const Known& each) { return each.missed > kRemembered; });
  for (Known& each : known_) ++each.missed;
  if (!people.empty() && all_have_their_own_id(people)) {
    for (std::size_t i = 0; i < people.size(); ++i) {
      numbers[i] = *people[i].id;
      last_ = std::max(last_, numbers[i]);  // our numbers must differ from the tracker's ids
    }
    return numbers;
  }
  follow(people, numbers);
  for (std::size_t i = 0; i < people.size(); ++i) {
    if (numbers[i] != 0) continue;
    numbers[i] = ++last_;
    const auto box = box_of(people[i]);
    if (!box.isEmpty()) known_.push_back({numbers[i], box.center(), box.diagonal().norm(), 0});
  }
  return numbers;
}

}  // namespace chorus::importers
