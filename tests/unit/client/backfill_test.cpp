// Gaps of a stream, and which of them are worth a request.
#include "common/client/backfill.h"

#include <gtest/gtest.h>

namespace chorus::client {
namespace {

using std::chrono::milliseconds;

std::vector<std::uint64_t> all(Backfill& backfill, Duration now) {
  std::vector<std::uint64_t> sequences;
  while (const auto next = backfill.next(now)) sequences.push_back(*next);
  return sequences;
}

TEST(Backfill, NoGapNothingToFetch) {
  Backfill backfill;
  for (std::uint64_t i = 100; i < 200; ++i) backfill.saw(i, milliseconds(i));
  EXPECT_TRUE(backfill.empty());
}

TEST(Backfill, TheOldestFirstAndEachOnce) {
  Backfill backfill;
  backfill.saw(10, milliseconds(0));
  backfill.saw(13, milliseconds(1));
  backfill.saw(15, milliseconds(2));
  EXPECT_EQ(all(backfill, milliseconds(3)), (std::vector<std::uint64_t>{11, 12, 14}));
  EXPECT_TRUE(all(backfill, milliseconds(4)).empty());
}

TEST(Backfill, NotWhatNobodyUsesAnyMore) {
  Backfill backfill;
  backfill.saw(10, milliseconds(0));
  backfill.saw(12, milliseconds(0));
  backfill.saw(14, milliseconds(900));
  EXPECT_EQ(all(backfill, milliseconds(1000)), (std::vector<std::uint64_t>{13}));
}

TEST(Backfill, AnotherRunOfTheSensorOrAnAbsurdJumpIsNoGap) {
  Backfill backfill;
  backfill.saw(1000, milliseconds(0));
  backfill.saw(3, milliseconds(1));
  EXPECT_TRUE(backfill.empty());
  backfill.saw(~std::uint64_t{0}, milliseconds(2));
  EXPECT_TRUE(backfill.empty());
}

TEST(Backfill, ASensorThatKeepsNoFramesIsNotAskedForEver) {
  Backfill backfill;
  int requests = 0;
  for (std::uint64_t i = 1; i < 200; i += 2) {
    backfill.saw(i, milliseconds(i));
    while (backfill.next(milliseconds(i))) {
      ++requests;
      backfill.answered(false);
    }
  }
  EXPECT_EQ(requests, 8);
  backfill.restart();
  backfill.saw(1, milliseconds(1));
  backfill.saw(3, milliseconds(2));
  EXPECT_FALSE(backfill.empty());
}

}  // namespace
}  // namespace chorus::client
