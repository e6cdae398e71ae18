#include "common/base/strong_id.h"

#include <unordered_set>

#include "tests/support/matchers.h"

namespace chorus {
namespace {

using testing::FailsWith;

TEST(SensorIdText, AcceptsWhatIsSafeInUrisFilesAndLabels) {
  for (const char* good : {"s1", "cam_01", "Left-Front", "0", "_", "-"}) {
    const auto id = SensorId::parse(good);
    ASSERT_TRUE(id) << good;
    EXPECT_EQ(id->str(), good);
  }
  EXPECT_TRUE(SensorId::parse(std::string(64, 'a')));
}

TEST(SensorIdText, RefusesTheRest) {
  for (const char* bad : {"", " ", "a b", "a/b", "../x", "s1\n", "ä", "a.b", "a#b", "%41"}) {
    EXPECT_THAT(SensorId::parse(bad), FailsWith(ErrorCode::InvalidArgument)) << bad;
  }
  EXPECT_THAT(SensorId::parse(std::string(65, 'a')), FailsWith(ErrorCode::InvalidArgument));
  EXPECT_THAT(SensorId::parse(std::string_view("a\0b", 3)), FailsWith(ErrorCode::InvalidArgument));
}

TEST(SensorIdText, AGiganticOneIsNotRepeatedInTheMessage) {
  const auto id = SensorId::parse(std::string(1'000'000, '!'));
  ASSERT_FALSE(id);
  EXPECT_LT(to_string(id.error()).size(), 200u);
}

TEST(StrongIds, CompareAndHashByValue) {
  EXPECT_LT(BodyId{1}, BodyId{2});
  EXPECT_EQ(PersonId{3}, PersonId{3});
  EXPECT_LT(*SensorId::parse("s1"), *SensorId::parse("s2"));
  const std::unordered_set<SensorId> ids{*SensorId::parse("s1"), *SensorId::parse("s1")};
  EXPECT_EQ(ids.size(), 1u);
}

}  // namespace
}  // namespace chorus
