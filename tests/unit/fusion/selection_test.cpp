// The methods that use one view at a time.
#include "fusion-server/fusion/selection.h"

#include <limits>

#include <gtest/gtest.h>

#include "common/base/units.h"
#include "fusion-server/fusion/fuse.h"
#include "fusion-server/fusion/view_score.h"
#include "tests/unit/fusion/views.h"

namespace chorus::fusion {
namespace {

using enum JointId;

const std::vector<SensorId> kSelectionSensors{sensor(1), sensor(2), sensor(3)};

/// A view that tracks the first `count` joints, all of them at x, of a body turned by `facing`.
SensorView view_of(int number, std::size_t count, double facing, double x = 0.0) {
  SensorView view = neck_view(number, {x, 1, 0}, 0.5);
  view.facing = facing;
  const Joint tracked = view.skeleton[Neck];
  for (std::size_t i = 0; i < kJointCount; ++i)
    view.skeleton.joints[i] = i < count ? tracked : Joint{};
  return view;
}

FusedBody fused(Method method, std::vector<SensorView> views) {
  FusionConfig config;
  config.method = method;
  return fuse({PersonId{1}, std::move(views)}, kSelectionSensors, config);
}

double x_of(const FusedBody& body, JointId joint) { return body.skeleton[joint].position.x(); }

TEST(ViewScore, IsTheTrackedSharePlusHowSquarelyTheBodyFacesTheSensor) {
  EXPECT_DOUBLE_EQ(view_score(view_of(1, 25, 0.0)), 2.0);
  EXPECT_NEAR(view_score(view_of(1, 5, deg(90))), 0.2 + 0.5, 1e-12);
  EXPECT_NEAR(view_score(view_of(1, 25, deg(180))), 1.0, 1e-12);
  EXPECT_DOUBLE_EQ(view_score(view_of(1, 0, std::numeric_limits<double>::quiet_NaN())), 0.5);
}

TEST(JointCounting, TakesTheMostTrackedJointsWhateverTheFacing) {
  const auto body = fused(Method::JointCounting, {view_of(1, 20, 0, 1), view_of(2, 21, deg(180), 2),
                                                  view_of(3, 21, 0, 3)});
  EXPECT_EQ(x_of(body, Neck), 2);  // of two equal ones, the one with the lower id
  EXPECT_EQ(body.contributors[index_of(Neck)], 2u);
  EXPECT_FALSE(fused(Method::JointCounting, {}).skeleton[Neck].seen());
}

TEST(Substitution, TakesWhatTheBestSkeletonDoesNotTrackFromTheNextBestThatDoes) {
  auto best = view_of(1, 25, 0, 1);
  auto second = view_of(2, 25, deg(60), 2);
  auto third = view_of(3, 25, deg(90), 3);
  best.skeleton[WristLeft].state = JointState::Inferred;
  best.skeleton[FootLeft].state = second.skeleton[FootLeft].state = JointState::Inferred;
  third.skeleton[FootLeft] = Joint{};
  const FusedBody body = fused(Method::Substitution, {third, second, best});
  EXPECT_EQ(x_of(body, Neck), 1);
  EXPECT_EQ(x_of(body, WristLeft), 2);
  EXPECT_EQ(body.contributors[index_of(WristLeft)], 2u);
  EXPECT_GT(body.variance[index_of(WristLeft)], 0.0);
  EXPECT_EQ(x_of(body, FootLeft), 1);  // nobody tracks this joint: the guess stays
  EXPECT_EQ(body.skeleton[FootLeft].state, JointState::Inferred);
}

TEST(BestSkeleton, IsWholeEvenWhereItGuesses) {
  auto best = view_of(1, 25, 0, 1);
  best.skeleton[WristLeft].state = JointState::Inferred;
  const FusedBody body = fused(Method::BestSkeleton, {best, view_of(2, 25, deg(60), 2)});
  EXPECT_EQ(x_of(body, WristLeft), 1);
  EXPECT_EQ(body.contributors[index_of(WristLeft)], 1u);
}

}  // namespace
}  // namespace chorus::fusion
