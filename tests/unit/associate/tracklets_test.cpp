// Where a track's person changed is found by the builds before and after each cut.
#include "fusion-server/associate/tracklets.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/builders.h"

namespace chorus::associate {
namespace {

using testing::kFrameInterval;
using testing::kStart;
using testing::standing_person;

constexpr Repeatability kRepeated{1.0, 1.0};

Spans spans_of_size(double size) {
  std::vector<PlacedView> views(4);
  for (PlacedView& each : views) {
    each.view.skeleton = standing_person();
    for (Joint& joint : each.view.skeleton.joints) joint.position *= size;
  }
  return spans_of(views, {});
}

/// One track, instant by instant.
struct Sight {
  Tracklets tracklets = {};
  Timestamp instant = kStart;

  void see(double size, double time, const std::vector<std::uint64_t>& bodies = {}) {
    const Spans spans = spans_of_size(size);
    for (const Timestamp begun = instant; seconds(instant - begun) < time;) {
      instant += kFrameInterval;
      tracklets.add(spans, instant, seconds(kFrameInterval), bodies);
    }
  }
  [[nodiscard]] double odds() const {
    return tracklets.doubt(kRepeated).value_or(Doubt{0, 99}).odds;
  }
};

TEST(Tracklets, OfOnePersonLeaveNoDoubt) {
  Sight sight;
  sight.see(1.0, 0.9);
  EXPECT_FALSE(sight.tracklets.doubt(kRepeated)) << "there is no cut";
  sight.see(1.0, 5.0);
  EXPECT_GT(sight.odds(), Tracklets::kUnbroken - 1.0);
  EXPECT_NEAR(sight_of(sight.tracklets.whole()), 5.9, 0.1);
}

TEST(Tracklets, TellWhereThePersonChanged) {
  Sight sight;
  sight.see(1.0, 5.0);
  const Timestamp changed = sight.instant;
  sight.see(1.08, 3.0);
  const auto doubt = sight.tracklets.doubt(kRepeated);
  ASSERT_TRUE(doubt);
  EXPECT_LT(doubt->odds, -5.0);
  EXPECT_NEAR(seconds(sight.tracklets.all()[doubt->cut].begin - changed), 0.0, 0.6);
  const double larger = sight.tracklets.after(doubt->cut).mean[0];
  EXPECT_NEAR(larger - sight.tracklets.before(doubt->cut).mean[0], std::log(1.08), 0.02);
}

TEST(Tracklets, AreCutWhereAChangeIsLikely) {
  Sight cut;
  cut.see(1.0, 5.0);
  cut.tracklets.cut(1.5);
  Sight uncut = cut;
  uncut.tracklets = {};
  uncut.see(1.0, 5.0);
  const Timestamp changed = cut.instant;
  for (Sight* each : {&cut, &uncut}) each->see(1.03, 0.5);
  EXPECT_LT(cut.odds(), 0.0);
  EXPECT_GT(uncut.odds(), 0.0);
  const auto doubt = cut.tracklets.doubt(kRepeated);
  EXPECT_EQ(cut.tracklets.all()[doubt->cut].begin, changed + kFrameInterval);
}

TEST(Tracklets, OfManyBodiesThatGoOnHardlyBecomeSomebodyNew) {
  Sight sight;
  sight.see(1.0, 5.0, {1, 2, 3, 4});
  for (const double after : {0.5, 1.0, 2.0, 4.0}) {
    sight.see(1.04, after, {1, 2, 3, 4});
    const auto doubt = sight.tracklets.doubt(kRepeated);
    ASSERT_TRUE(doubt);
    EXPECT_NEAR(doubt->carried, 3.0 * Tracklets::kUnbroken, 0.1) << after;
    EXPECT_EQ(doubt->against_new(), doubt->odds + doubt->carried);
  }
}

TEST(Tracklets, OfOneBodyThatGoesOnAreCarriedByItAlone) {
  Sight sight;
  sight.see(1.0, 5.5, {1, 2, 3, 4});
  sight.see(1.08, 2.5, {1, 7, 8, 9});  // within a tracklet, three sensors have new bodies
  const auto doubt = sight.tracklets.doubt(kRepeated);
  ASSERT_TRUE(doubt);
  EXPECT_LT(doubt->carried, 0.5 * Tracklets::kUnbroken);
}

TEST(Tracklets, OfNewBodiesAreCarriedByNone) {
  Sight sight;
  sight.see(1.0, 5.0, {1, 2, 3, 4});
  sight.tracklets.cut(1.5);
  sight.see(1.08, 2.0, {5, 6, 7, 8});
  const auto doubt = sight.tracklets.doubt(kRepeated);
  ASSERT_TRUE(doubt);
  EXPECT_EQ(doubt->carried, 0.0);
}

TEST(Tracklets, HardlyInViewAreNotCutAgain) {
  Sight sight;
  sight.see(1.0, 0.5);
  sight.tracklets.cut(3.0);
  sight.see(1.0, 0.1);
  for (int i = 0; i < 5; ++i) sight.tracklets.cut(1.5);
  sight.see(1.0, 0.3);
  ASSERT_EQ(sight.tracklets.all().size(), 2u);
  EXPECT_EQ(sight.tracklets.all()[1].continuity, 1.5);
}

TEST(Tracklets, AreJoinedWhenTheyAreMany) {
  Sight sight;
  sight.see(1.0, 40.0);
  EXPECT_LE(sight.tracklets.all().size(), 12u);
  EXPECT_NEAR(sight_of(sight.tracklets.whole()), 40.0, 0.2);
  EXPECT_EQ(sight.tracklets.all()[0].begin, kStart + kFrameInterval);
}

TEST(Tracklets, GoOnWithWhatIsKnownOfAPerson) {
  Sight before;
  before.see(1.0, 3.0);
  Sight sight;
  sight.see(1.08, 1.0);
  sight.tracklets.precede(before.tracklets.whole(), kStart, 1.0);
  EXPECT_LT(sight.odds(), -3.0) << "the claim is questioned";
  sight.tracklets.keep_after(1);
  EXPECT_EQ(sight.odds(), 99.0);
}

TEST(Tracklets, WithoutLengthsSayNothing) {
  Tracklets tracklets;
  tracklets.cut(1.0);
  for (int i = 0; i < 100; ++i) {
    tracklets.add({}, kStart + i * kFrameInterval, 0.033);
    tracklets.cut(1.0);
  }
  EXPECT_FALSE(tracklets.doubt(kRepeated));
  EXPECT_LE(tracklets.all().size(), 12u);
}

}  // namespace
}  // namespace chorus::associate
