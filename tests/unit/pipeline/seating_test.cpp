// People keep their slots, and all outputs show the same.
#include "fusion-server/pipeline/seating.h"

#include <gtest/gtest.h>

namespace chorus::pipeline {
namespace {

using std::chrono::milliseconds;

constexpr Timestamp kSeatingStart = from_unix_ns(1'790'000'000'000'000'000);
constexpr Duration kKeep = std::chrono::seconds(1);

using Slots = std::vector<std::pair<std::size_t, std::uint64_t>>;

/// Gives the people in a room their slots, instant by instant.
struct Room {
  Slots at(Duration after, const std::vector<std::uint64_t>& persons) {
    std::vector<FusedBody> bodies(persons.size());
    for (std::size_t i = 0; i < persons.size(); ++i) bodies[i].id = {persons[i]};
    seating.seat(bodies, kSeatingStart + after, keep, {front});
    Slots slots;
    for (const FusedBody& body : bodies) slots.emplace_back(body.slot.value_or(99), body.id.value);
    std::sort(slots.begin(), slots.end());
    return slots;
  }

  Duration keep = kKeep;
  std::size_t front = 6;
  Seating seating;
};

TEST(Seating, StaysWithAPersonWhenAnotherLeaves) {
  Room room;
  EXPECT_EQ(room.at(milliseconds(0), {4, 7}), (Slots{{0, 4}, {1, 7}}));
  EXPECT_EQ(room.at(milliseconds(33), {7}), (Slots{{1, 7}}));
  EXPECT_EQ(room.at(milliseconds(1033), {7, 8, 9}), (Slots{{0, 8}, {1, 7}, {2, 9}}))
      << "the newcomer takes the slot that is free by then";
}

TEST(Seating, IsFoundAgainAfterAnInstantWithoutAnybody) {
  Room room;
  room.at(milliseconds(0), {3});
  room.at(milliseconds(33), {2, 3});
  EXPECT_EQ(room.at(milliseconds(66), {}), Slots{});
  EXPECT_EQ(room.at(milliseconds(100), {2, 3}), (Slots{{0, 3}, {1, 2}}));
}

TEST(Seating, OfAHiddenPersonIsNotGivenToOneWhoEnters) {
  Room room;
  room.at(milliseconds(0), {1, 2});
  EXPECT_EQ(room.at(milliseconds(33), {2, 4}), (Slots{{1, 2}, {2, 4}}));
  EXPECT_EQ(room.at(milliseconds(66), {1, 2, 4}), (Slots{{0, 1}, {1, 2}, {2, 4}}));
}

TEST(Seating, GoesToWhoCameMeanwhileWhenTheHiddenPersonStaysAway) {
  Room room;
  room.at(milliseconds(0), {1});
  // The same person comes under a new id, then a second person.
  EXPECT_EQ(room.at(milliseconds(33), {5, 6}), (Slots{{1, 5}, {2, 6}}));
  EXPECT_EQ(room.at(milliseconds(1034), {5, 6}), (Slots{{0, 5}, {2, 6}}));
}

TEST(Seating, GoesToWhoIsStillThereAfterSeveralNewIdsOfOnePerson) {
  Room room;
  room.at(milliseconds(0), {1});
  room.at(milliseconds(300), {2});
  room.at(milliseconds(600), {3});
  EXPECT_EQ(room.at(milliseconds(900), {4}), (Slots{{3, 4}}));
  EXPECT_EQ(room.at(milliseconds(1001), {4}), (Slots{{0, 4}})) << "as soon as the first has left";
  EXPECT_EQ(room.at(milliseconds(9000), {4}), (Slots{{0, 4}}));
}

TEST(Seating, OfOneWhoStoodInAndLeftGoesToTheNextOfThem) {
  Room room;
  room.at(milliseconds(0), {1});
  room.at(milliseconds(33), {5, 6});  // both could be person 1
  EXPECT_EQ(room.at(milliseconds(66), {6}), (Slots{{2, 6}}));
  EXPECT_EQ(room.at(milliseconds(1001), {6}), (Slots{{0, 6}}));
  EXPECT_EQ(room.at(milliseconds(1002), {5, 6}), (Slots{{0, 6}, {1, 5}})) << "5 was only hidden";
}

TEST(Seating, OfOneWhoCameBackIsNotWaitedForAnyLonger) {
  Room room;
  room.at(milliseconds(0), {1});
  room.at(milliseconds(33), {5});
  room.at(milliseconds(66), {1, 5});
  EXPECT_EQ(room.at(milliseconds(5000), {5}), (Slots{{1, 5}}));
}

TEST(Seating, IsKeptAsLongAsAskedToTheInstant) {
  Room room;
  room.keep = milliseconds(200);
  room.at(milliseconds(0), {1});
  EXPECT_EQ(room.at(milliseconds(200), {2}), (Slots{{1, 2}}));
  EXPECT_EQ(room.at(milliseconds(201), {2}), (Slots{{0, 2}}));
  // If the clock is set back by more than `keep`, everything starts over, as in association.
  EXPECT_EQ(room.at(milliseconds(-100), {3}), (Slots{{0, 3}}));
}

TEST(Seating, WhoSitsBeyondTheFrontMovesUpWhenAFrontSlotIsFree) {
  Room room;
  room.front = 2;
  EXPECT_EQ(room.at(milliseconds(0), {1, 2, 3}), (Slots{{0, 1}, {1, 2}, {2, 3}}));
  EXPECT_EQ(room.at(milliseconds(33), {2, 3}), (Slots{{1, 2}, {2, 3}})) << "0 is still kept";
  EXPECT_EQ(room.at(milliseconds(1034), {2, 3}), (Slots{{0, 3}, {1, 2}}));
}

TEST(Seating, WithinTheFrontNobodyMovesWithoutNeed) {
  Room room;
  room.at(milliseconds(0), {1, 2, 3});
  EXPECT_EQ(room.at(milliseconds(1034), {2, 3}), (Slots{{1, 2}, {2, 3}}));
}

TEST(Seating, WhoMovedUpPastAnAwaitedSlotStaysThere) {
  Room room;
  room.front = 1;
  room.at(milliseconds(0), {1, 2});
  room.at(milliseconds(500), {1});     // 2 is occluded, its slot 1 stays reserved
  room.at(milliseconds(600), {1, 3});  // 3 waits in slot 2 for slot 1
  room.at(milliseconds(700), {2, 3});  // 1 has left, 2 is back
  room.at(milliseconds(800), {3});     // 2 is occluded again
  EXPECT_EQ(room.at(milliseconds(1650), {3}), (Slots{{0, 3}})) << "slot 0 is free now";
  EXPECT_EQ(room.at(milliseconds(2500), {3}), (Slots{{0, 3}}));
}

TEST(Seating, ThereAreAsManySlotsAsAFrameMayHaveBodies) {
  Room room;
  std::vector<std::uint64_t> crowd(kMaxBodies + 1);
  for (std::size_t i = 0; i < crowd.size(); ++i) crowd[i] = i + 1;
  const Slots slots = room.at(milliseconds(0), crowd);
  EXPECT_EQ(slots[kMaxBodies - 1], (std::pair<std::size_t, std::uint64_t>{63, 64}));
  EXPECT_EQ(slots[kMaxBodies].first, 99u) << "no slot";
}

}  // namespace
}  // namespace chorus::pipeline
