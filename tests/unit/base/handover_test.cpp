// The producer never waits; the consumer learns how much it missed.
#include "common/base/handover.h"

#include <thread>

#include <gtest/gtest.h>

namespace chorus {
namespace {

using std::chrono::milliseconds;

TEST(Handover, GivesInOrderAndAllAtOnce) {
  Handover<int> h(10);
  for (int i = 0; i < 5; ++i) h.give(i);
  EXPECT_EQ(h.take(std::chrono::seconds(0)), (std::vector<int>{0, 1, 2, 3, 4}));
  EXPECT_TRUE(h.take(std::chrono::seconds(0)).empty());
}

TEST(Handover, DropsTheOldestAndCountsThem) {
  Handover<int> h(3);
  for (int i = 0; i < 10; ++i) h.give(i);
  EXPECT_EQ(h.take(std::chrono::seconds(0)), (std::vector<int>{7, 8, 9}));
  EXPECT_EQ(h.dropped(), 7u);
}

TEST(Handover, ACapacityOfZeroIsOne) {
  Handover<int> h(0);
  h.give(1);
  h.give(2);
  EXPECT_EQ(h.take(std::chrono::seconds(0)), std::vector<int>{2});
}

TEST(Handover, WakesTheTakerFromAnotherThread) {
  Handover<int> h(3);
  std::jthread giver([&] { h.give(42); });
  std::vector<int> got;
  while (got.empty()) got = h.take(std::chrono::seconds(10));
  EXPECT_EQ(got, std::vector<int>{42});
}

TEST(Handover, CloseWakesTheTakerAndIgnoresWhatComesAfter) {
  Handover<int> h(3);
  std::jthread closer([&] { h.close(); });
  while (!h.closed()) EXPECT_TRUE(h.take(std::chrono::seconds(10)).empty());
  h.give(1);
  EXPECT_TRUE(h.take(milliseconds(0)).empty());
}

}  // namespace
}  // namespace chorus
