#include "common/net/capacity.h"

#include <gtest/gtest.h>

#include <vector>

namespace chorus::net {
namespace {

constexpr Capacity kTwoOfOne{3, 2, "server.max", "server.max_per_address"};

TEST(Capacity, ThereIsRoomBelowBothLimits) {
  EXPECT_EQ(objection(kTwoOfOne, {2, 1}, "192.0.2.7"), "");
}

TEST(Capacity, TheLimitThatIsReachedIsNamedWithItsKey) {
  EXPECT_EQ(objection(kTwoOfOne, {3, 0}, "192.0.2.7"),
            "there are 3 already, as many as server.max allows");
  EXPECT_EQ(objection(kTwoOfOne, {2, 2}, "192.0.2.7"),
            "there are 2 already of 192.0.2.7, as many as server.max_per_address allows");
}

SteadyTime at(int seconds) { return SteadyTime(std::chrono::seconds(seconds)); }

TEST(MakesRoom, NobodyWhileThereIsRoom) {
  const std::vector<Occupant> all{{"a", false, at(0)}, {"b", false, at(0)}};
  EXPECT_EQ(who_makes_room({3, 2, "", ""}, all, "a", at(100)), std::nullopt);
  EXPECT_EQ(who_makes_room({3, 2, "", ""}, {}, "a", at(100)), std::nullopt);
}

TEST(MakesRoom, WhoNeverGreetedBeforeWhoFellSilent) {
  const std::vector<Occupant> all{
      {"a", true, at(1)}, {"a", false, at(60)}, {"a", false, at(50)}, {"b", false, at(0)}};
  EXPECT_EQ(who_makes_room({9, 3, "", ""}, all, "a", at(61)), 2u);
}

TEST(MakesRoom, TheLongestSilentButNobodyAtWork) {
  const std::vector<Occupant> all{
      {"a", true, at(1), true}, {"a", true, at(20)}, {"a", true, at(10)}, {"a", true, at(55)}};
  EXPECT_EQ(who_makes_room({9, 4, "", ""}, all, "a", at(60)), 2u);
  const std::vector<Occupant> busy{{"a", true, at(55)}, {"a", true, at(59)}};
  EXPECT_EQ(who_makes_room({9, 2, "", ""}, busy, "a", at(60)), std::nullopt);
}

TEST(MakesRoom, OfTheHostWithTheMostWhenAllPlacesAreTaken) {
  const std::vector<Occupant> all{{"a", false, at(0)}, {"b", false, at(5)}, {"b", false, at(6)}};
  EXPECT_EQ(who_makes_room({3, 9, "", ""}, all, "c", at(60)), 1u);
}

}  // namespace
}  // namespace chorus::net
