#include "fusion-server/journal/event_log.h"

#include <gtest/gtest.h>

#include "tests/support/builders.h"

namespace chorus::journal {
namespace {

using testing::kStart;

Event event(std::string kind, std::string about, Duration after) {
  Event one;
  one.kind = std::move(kind);
  one.about = std::move(about);
  one.time = kStart + after;
  one.message = "It happened.";
  return one;
}

TEST(EventLog, NumbersEventsAndFindsTheNextOne) {
  EventLog log(100);
  EXPECT_FALSE(log.after(0));
  for (int i = 0; i < 3; ++i)
    EXPECT_TRUE(log.add(event("sensor-lost", "s" + std::to_string(i), std::chrono::seconds(i))));
  EXPECT_EQ(log.after(0)->id, 100u);
  EXPECT_EQ(log.after(100)->id, 101u);
  EXPECT_EQ(log.after(101)->about, "s2");
  EXPECT_FALSE(log.after(102));
  EXPECT_FALSE(log.after(~std::uint64_t{0}));
}

TEST(EventLog, KeepsADayAndABoundedNumber) {
  EventLog log(1, {3, std::chrono::hours(24), 6});
  for (int i = 0; i < 5; ++i) log.add(event("k", std::to_string(i), std::chrono::seconds(i)));
  EXPECT_EQ(log.all().size(), 3u);
  EXPECT_EQ(log.after(0)->id, 3u) << "who was away for long begins with the oldest that is kept";
  log.age(kStart + std::chrono::hours(24) + std::chrono::milliseconds(3500));
  EXPECT_EQ(log.all().size(), 1u);
  log.add(event("k", "late", std::chrono::hours(49)));
  EXPECT_EQ(log.all().size(), 1u);
}

TEST(EventLog, OneThingDoesNotPushOutAllOthers) {
  EventLog log(1);
  log.add(event("sensor-lost", "s2", Duration{0}));
  int kept = 0;
  for (int i = 0; i < 50; ++i)
    kept += log.add(event("sensor-lost", "s1", std::chrono::seconds(i))) ? 1 : 0;
  EXPECT_EQ(kept, 6);
  EXPECT_NE(log.all().back().message.find("again and again"), std::string::npos);
  EXPECT_TRUE(log.add(event("sensor-back", "s1", std::chrono::seconds(50)))) << "another kind";
  EXPECT_TRUE(log.add(event("sensor-lost", "s1", std::chrono::seconds(61)))) << "a minute later";
}

}  // namespace
}  // namespace chorus::journal
