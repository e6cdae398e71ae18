// Bodies move gradually from where the old registration puts them to where the new one does.
#include "fusion-server/core/cross_fade.h"

#include <gtest/gtest.h>

#include "tests/support/builders.h"

namespace chorus::core {
namespace {

using std::chrono::milliseconds;
using testing::kStart;

std::vector<FusedBody> body_at(double x, std::uint64_t id = 1) {
  FusedBody body;
  body.id = PersonId{id};
  body.skeleton = testing::standing_person({x, 0, 0});
  return {body};
}

double place_of(const std::vector<FusedBody>& bodies) {
  return bodies.front().skeleton[JointId::Neck].position.x();
}

TEST(CrossFade, BeginsWhereBodiesWereAndEndsWhereTheyAre) {
  CrossFade fade;
  fade.begin(body_at(0.1), body_at(0.0), kStart);
  double last = 0.1;
  for (Duration t{0}; t <= std::chrono::seconds(1); t += milliseconds(33)) {
    auto bodies = body_at(0.0);
    fade.apply(bodies, kStart + t);
    EXPECT_LE(place_of(bodies), last + 1e-9);
    EXPECT_LT(last - place_of(bodies), 0.01) << "no step is large";
    last = place_of(bodies);
  }
  auto bodies = body_at(0.0);
  fade.apply(bodies, kStart);
  EXPECT_NEAR(place_of(bodies), 0.1, 1e-9);
  bodies = body_at(0.0);
  fade.apply(bodies, kStart + std::chrono::seconds(2));
  EXPECT_EQ(place_of(bodies), 0.0);
}

TEST(CrossFade, ConcernsTheSamePersonNearby) {
  CrossFade fade;
  fade.begin(body_at(0.1), body_at(0.0, 2), kStart);
  auto bodies = body_at(0.0, 2);
  fade.apply(bodies, kStart);
  EXPECT_EQ(place_of(bodies), 0.0) << "somebody else";
  fade.begin(body_at(3.0), body_at(0.0), kStart);
  bodies = body_at(0.0);
  fade.apply(bodies, kStart);
  EXPECT_EQ(place_of(bodies), 0.0) << "another world";
}

TEST(CrossFade, LeavesJointsThatAreNotSeen) {
  CrossFade fade;
  auto before = body_at(0.1);
  testing::hide(before.front().skeleton[JointId::Head]);
  fade.begin(before, body_at(0.0), kStart);
  auto bodies = body_at(0.0);
  testing::hide(bodies.front().skeleton[JointId::Neck]);
  const auto given = bodies;
  fade.apply(bodies, kStart);
  EXPECT_EQ(bodies.front().skeleton[JointId::Head].position,
            given.front().skeleton[JointId::Head].position);
  EXPECT_EQ(bodies.front().skeleton[JointId::Neck].position,
            given.front().skeleton[JointId::Neck].position);
  fade.stop();
  bodies = body_at(0.0);
  fade.apply(bodies, kStart);
  EXPECT_NEAR(bodies.front().skeleton[JointId::SpineMid].position.x(), 0.0, 1e-9);
}

}  // namespace
}  // namespace chorus::core
