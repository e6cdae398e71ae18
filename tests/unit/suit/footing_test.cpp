#include "common/suit/footing.h"

#include <cmath>

#include <gtest/gtest.h>

#include "common/motion/cmu_walk.h"
#include "common/motion/motion.h"
#include "common/suit/walk.h"
#include "tests/support/builders.h"
#include "tests/support/matchers.h"

namespace chorus::suit {
namespace {

constexpr double kRate = 100.0;

SuitPose at(const Skeleton<WorldSpace>& body, int frame) {
  return pose_of(body, from_seconds(frame / kRate));
}

/// A person who stands, with the pelvis at this height above where it stands upright.
Skeleton<WorldSpace> raised(double by) { return chorus::testing::standing_person({0, by, 0}); }

/// Draws the pelvis to the feet: they stay where they are while everything else sinks.
Skeleton<WorldSpace> bent(double by) {
  using enum JointId;
  Skeleton<WorldSpace> body = chorus::testing::standing_person();
  for (std::size_t i = 0; i < kJointCount; ++i) {
    const auto id = static_cast<JointId>(i);
    if (id == AnkleLeft || id == AnkleRight || id == FootLeft || id == FootRight) continue;
    body[id].position.y() -= by;
  }
  return body;
}

TEST(Footing, APersonWhoStandsDoesNotMove) {
  Walk walk;
  for (int i = 0; i < 300; ++i) (void)walk.next(at(raised(0.3), i));
  const Walked& end = walk.next(at(raised(0.3), 300));
  EXPECT_EQ(end.distance, 0.0);
  EXPECT_EQ(end.covariance(0, 0), 0.0);
}

TEST(Footing, WhoBendsTheKneesSinksAndStays) {
  Walk walk;
  const double upright = walk.next(at(bent(0.0), 0)).place.y();
  Walked end;
  for (int i = 1; i <= 200; ++i) end = walk.next(at(bent(0.3 * i / 200.0), i));
  EXPECT_NEAR(end.place.y(), upright - 0.3, 0.005);
  EXPECT_NE(end.stance, Stance::Flight);
  EXPECT_LT(end.place.head<1>().norm(), 1e-6);
}

/// Takes off with this speed after pushing for so long.
struct Jump {
  static constexpr double kSpeed = 2.5;  // [m/s]
  static constexpr double kPush = 0.24;  // [s]
};

TEST(Footing, AJumpIsToldFromBothFeetAndIsAsHighAsItWas) {
  // Before the push the person sinks slowly; the push accelerates evenly to kSpeed.
  const double depth = 0.5 * Jump::kSpeed * Jump::kPush;
  Footing footing;
  double highest = 0.0;
  double upright = 0.0;
  bool flew = false;
  int frame = 0;
  const auto next = [&](double sunk) {
    const Step step = footing.next(at(bent(sunk), frame++));
    highest = std::max(highest, step.height);
    flew = flew || step.stance == Stance::Flight;
    return step;
  };
  upright = next(0.0).height;
  for (int i = 1; i <= 100; ++i) next(depth * i / 100.0);
  for (int i = 1; i <= 24; ++i) {
    const double t = i / kRate;
    next(depth - 0.5 * (Jump::kSpeed / Jump::kPush) * t * t);
  }
  for (int i = 0; i < 50; ++i) next(0.0);  // The legs hang; they land straight.
  for (int i = 0; i < 100; ++i) next(0.0);
  EXPECT_TRUE(flew);
  EXPECT_NEAR(highest - upright, Jump::kSpeed * Jump::kSpeed / (2.0 * 9.81), 0.06);
  const Step end = next(0.0);
  EXPECT_NE(end.stance, Stance::Flight);
  EXPECT_NEAR(end.height, upright, 1e-9);
}

/// A recorded walk of the CMU library.
motion::Motion recorded_walk() {
  const motion::CmuWalk& walk = motion::cmu_walk();
  const auto motion = motion::motion_from_amc(walk.skeleton, walk.takes.front());
  EXPECT_THAT(motion, chorus::testing::IsOk());
  return motion ? *motion : motion::Motion{};
}

TEST(Footing, WalksARecordedWalkToWithinSevenPercent) {
  const motion::Motion motion = recorded_walk();
  const auto take = take_of(motion, 0.0);
  ASSERT_THAT(take, chorus::testing::IsOk());
  Walk walk(stature_of(take->poses.front()));
  Walked end;
  for (const SuitPose& pose : take->poses) end = walk.next(pose);
  Eigen::Vector3d truth = take->claimed.back() - take->claimed.front();
  truth.y() = 0.0;
  ASSERT_GT(truth.norm(), 1.0);
  Eigen::Vector3d found = end.place;
  found.y() = 0.0;
  EXPECT_LT((found - truth).norm(), 0.07 * truth.norm())
      << found.transpose() << " " << truth.transpose();
  EXPECT_GT(end.covariance(0, 0), 0.0);
}

TEST(Footing, ACovarianceGrowsWithTheDistanceAlone) {
  const motion::Motion motion = recorded_walk();
  const auto take = take_of(motion, 0.0);
  ASSERT_THAT(take, chorus::testing::IsOk());
  Walk walk;
  Walked half;
  Walked end;
  for (std::size_t i = 0; i < take->poses.size(); ++i) {
    end = walk.next(take->poses[i]);
    if (i == take->poses.size() / 2) half = end;
  }
  EXPECT_NEAR(end.covariance(0, 0) / half.covariance(0, 0), end.distance / half.distance, 1e-6);
}

TEST(Footing, APoseWithoutAnklesMovesNobody) {
  Footing footing;
  SuitPose pose = at(raised(0.0), 0);
  (void)footing.next(pose);
  pose.joints[JointId::AnkleLeft].state = JointState::NotTracked;
  pose.time = from_seconds(0.01);
  const Step step = footing.next(pose);
  EXPECT_EQ(step.stance, Stance::Unknown);
  EXPECT_EQ(step.moved.norm(), 0.0);
}

}  // namespace
}  // namespace chorus::suit
