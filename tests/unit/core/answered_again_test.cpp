// Instants that are answered again with frames that came late: who was published stays.
#include <algorithm>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "fusion-server/core/fusion_core.h"
#include "tests/unit/core/ring_of_three.h"

namespace chorus::core {
namespace {

using std::chrono::milliseconds;
using testing::kStart;

/// A person comes into view of each sensor at another time; the frames of all sensors but the first
/// come late.
struct Arrival {
  Duration second_sees{0};  ///< How much later than the first sensor the second shows the person.
  Duration third_sees{0};
  Duration late = milliseconds(300);
};

struct AnsweredTwice {
  std::map<std::uint64_t, std::set<PersonId>> first;
  std::map<std::uint64_t, std::set<PersonId>> again;
};

std::set<PersonId> people_in(const Snapshot& snapshot) {
  std::set<PersonId> people;
  for (const FusedBody& body : snapshot.bodies) people.insert(body.id);
  return people;
}

AnsweredTwice answered_twice(const Arrival& arrival) {
  constexpr Duration kComes = milliseconds(1000);
  FusionCore core(of_three<CoreConfig>(), ring());
  std::vector<std::pair<Duration, SensorFrame>> on_the_way;
  AnsweredTwice all;
  for (Duration t{0}; t < milliseconds(4000); t += milliseconds(1)) {
    for (int i = 0; i < kSensors; ++i) {
      if ((t - milliseconds(7 * i)) % milliseconds(33) != Duration{0}) continue;
      SensorFrame frame = sight(i, t);
      frame.sequence = static_cast<std::uint64_t>(t / milliseconds(33));
      const Duration sees = kComes + (i == 1   ? arrival.second_sees
                                      : i == 2 ? arrival.third_sees
                                               : Duration{0});
      if (t < sees) frame.bodies.clear();
      const Duration comes = t + (i == 0 ? milliseconds(2) : arrival.late);
      frame.received = kStart + comes;
      on_the_way.emplace_back(comes, std::move(frame));
    }
    std::erase_if(on_the_way, [&](auto& each) {
      if (each.first > t) return false;
      core.take(std::move(each.second));
      return true;
    });
    while (const auto snapshot = core.tick(kStart + t)) {
      all.first[snapshot->sequence] = people_in(*snapshot);
      if (const auto better = core.amended(kStart + t))
        all.again[better->sequence] = people_in(*better);
    }
  }
  return all;
}

TEST(AnsweredAgain, WhoWasPublishedStays) {
  // When the first sensor alone has shown the person for long enough, the others show nobody yet:
  // with their frames, the person would not be published at that instant.
  const AnsweredTwice all = answered_twice({milliseconds(100), milliseconds(300)});
  for (const auto& [sequence, people] : all.again)
    EXPECT_TRUE(std::ranges::includes(people, all.first.at(sequence))) << sequence;
  EXPECT_TRUE(std::ranges::any_of(
      all.again, [&](const auto& each) { return !all.first.at(each.first).empty(); }));
  EXPECT_GE(all.again.size(), 78u) << "all others are";
}

}  // namespace
}  // namespace chorus::core
