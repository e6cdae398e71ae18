#include "fusion-server/site/site_id.h"

#include <gtest/gtest.h>

#include <set>

namespace chorus::site {
namespace {

const CellId kHall = *SensorId::parse("hall-a");
constexpr Timestamp kNow = from_unix_ns(1'795'000'000'000'000'000);

TEST(SiteIds, ThatAreOlderAreSmallerWhicheverCellGaveThem) {
  SiteIdSource a(kHall, 1);
  SiteIdSource b(*SensorId::parse("a-longer-name"), 7);
  const SiteId first = a.next(kNow);
  const SiteId second = b.next(kNow + std::chrono::milliseconds(1));
  const SiteId third = a.next(kNow + std::chrono::hours(24 * 365));
  EXPECT_LT(first, second);
  EXPECT_LT(second, third);
}

TEST(SiteIds, AreNotGivenTwiceByACellThatForgotEverything) {
  std::set<SiteId> given;
  for (const std::uint64_t boot : {1U, 2U, 3U}) {
    SiteIdSource source(kHall, boot);
    for (int i = 0; i < 100; ++i) EXPECT_TRUE(given.insert(source.next(kNow)).second);
  }
}

TEST(SiteIds, AreReadAsTheyAreWrittenAndNothingElseIs) {
  const SiteId id = SiteIdSource(kHall, 1).next(kNow);
  ASSERT_TRUE(SiteId::parse(id.str()));
  EXPECT_EQ(*SiteId::parse(id.str()), id);
  for (const char* bad : {"", "a b", "a.b", "a>", "*", "\xc3\xa4"})
    EXPECT_FALSE(SiteId::parse(bad));
  EXPECT_FALSE(SiteId::parse(std::string(65, 'a')));
}

}  // namespace
}  // namespace chorus::site
