#include "common/synthetic/walker.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "common/base/units.h"
#include "common/body/bones.h"
#include "common/geometry/rotation.h"

namespace chorus::synthetic {
namespace {

constexpr Duration kStep = std::chrono::milliseconds(10);

class EveryPath : public ::testing::TestWithParam<std::tuple<PathKind, std::uint64_t>> {
 protected:
  WalkerScript script() const {
    WalkerScript script;
    script.path = std::get<0>(GetParam());
    script.seed = std::get<1>(GetParam());
    return script;
  }
};

TEST_P(EveryPath, NothingJumpsAlsoWhereTheLoopCloses) {
  const Walker walker(script());
  const Duration loop = walker.path().loop();
  auto before = walker.at(Duration::zero());
  for (Duration t = kStep; t < loop + std::chrono::seconds(2); t += kStep) {
    const auto now = walker.at(t);
    for (std::size_t j = 0; j < kJointCount; ++j) {
      const double step = (now.joints[j].position - before.joints[j].position).norm();
      ASSERT_LT(step / seconds(kStep), 8.0) << kJointNames[j] << " at " << seconds(t) << " s";
    }
    before = now;
  }
}

TEST_P(EveryPath, BonesKeepTheirLengthAndFeetStayOnTheFloor) {
  const Walker walker(script());
  const auto first = walker.at(Duration::zero());
  for (Duration t{}; t < std::chrono::seconds(60); t += 7 * kStep) {
    const auto body = walker.at(t);
    for (const Bone& bone : kBones) {
      const double length = (body[bone.child].position - body[bone.parent].position).norm();
      const double was = (first[bone.child].position - first[bone.parent].position).norm();
      ASSERT_NEAR(length, was, 0.003) << name_of(bone.child);
    }
    const double lowest =
        std::min(body[JointId::FootLeft].position.y(), body[JointId::FootRight].position.y());
    ASSERT_NEAR(lowest, 0.04, 0.04) << seconds(t);
    ASSERT_LT(
        std::hypot(body[JointId::SpineBase].position.x(), body[JointId::SpineBase].position.z()),
        1.2 + 0.15)
        << "stays in its area";
  }
}

TEST_P(EveryPath, IsAFunctionOfTimeAlone) {
  const Walker one(script());
  const Walker other(script());
  const Duration late = std::chrono::hours(24 * 365 * 56) + std::chrono::milliseconds(1234);
  EXPECT_EQ(one.at(late)[JointId::HandLeft].position, other.at(late)[JointId::HandLeft].position);
  EXPECT_TRUE(one.at(late)[JointId::HandLeft].position.allFinite());
  const auto a = one.at(std::chrono::seconds(3))[JointId::HandLeft].position;
  const auto b = one.at(std::chrono::seconds(3) + one.path().loop())[JointId::HandLeft].position;
  EXPECT_TRUE(a.isApprox(b, 1e-6)) << "repeats after one loop";
  EXPECT_TRUE(one.at(std::chrono::seconds(-5))[JointId::HandLeft].position.allFinite());
}

INSTANTIATE_TEST_SUITE_P(Paths, EveryPath,
                         ::testing::Combine(::testing::Values(PathKind::Random, PathKind::Circle,
                                                              PathKind::Line, PathKind::Stand,
                                                              PathKind::Turn, PathKind::Assembly),
                                            ::testing::Values(1, 2)));

TEST(Walker, WalksForward) {
  WalkerScript script;
  script.path = PathKind::Circle;
  const Walker walker(script);
  for (int i = 0; i < 50; ++i) {
    const Duration t = i * std::chrono::milliseconds(97);
    const auto body = walker.at(t);
    const Eigen::Vector3d way =
        walker.at(t + kStep)[JointId::SpineBase].position - body[JointId::SpineBase].position;
    const Eigen::Vector3d to_left =
        body[JointId::ShoulderLeft].position - body[JointId::ShoulderRight].position;
    EXPECT_GT(to_left.cross(Eigen::Vector3d::UnitY()).dot(way), 0.0);
  }
}

TEST(Gait, TheSeamIsAsSmoothAsTheRest) {
  for (const std::size_t take : {0u, 1u}) {
    const Gait& gait = Gait::built_in(take);
    constexpr int kSteps = 200;
    // Second differences inside one cycle and across the seam, in arbitrary units.
    double inside = 0, seam = 0;
    for (int i = 0; i < kSteps; ++i) {
      const auto body = [&](int step) {
        return gait.pose(static_cast<double>(step) / kSteps, 1.0);
      };
      const auto before = body(i - 1), now = body(i), after = body(i + 1);
      for (std::size_t j = 0; j < kJointCount; ++j) {
        const double bend =
            (after.joints[j].position - 2 * now.joints[j].position + before.joints[j].position)
                .norm();
        double& most = i <= 2 || i >= kSteps - 2 ? seam : inside;
        most = std::max(most, bend);
      }
    }
    EXPECT_LT(seam, 1.5 * inside) << "take " << take;
  }
}

TEST(Walker, StandingFeetDoNotSlideFar) {
  // The steps match the speed: a standing foot (low, for a while) hardly moves over the floor.
  WalkerScript script;
  script.path = PathKind::Circle;
  script.reach = 3.0;
  const Walker walker(script);
  double slid = 0, walked = 0;
  for (int i = 0; i < 1000; ++i) {
    const auto now = walker.at(i * kStep);
    const auto next = walker.at((i + 1) * kStep);
    const auto step_of = [&](JointId id) { return (next[id].position - now[id].position).norm(); };
    slid += std::min(step_of(JointId::FootLeft), step_of(JointId::FootRight));
    walked += step_of(JointId::SpineBase);
  }
  EXPECT_LT(slid, 0.25 * walked);
}

TEST(Walker, RandomWalkCoversItsAreaAndTurnsEverywhere) {
  const Walker walker(WalkerScript{});
  Eigen::Vector2d least(9, 9), most(-9, -9);
  std::array<bool, 8> headings{};
  for (Duration t{}; t < std::chrono::seconds(60); t += 10 * kStep) {
    const PathPoint point = walker.path().at(t);
    least = least.cwiseMin(point.place);
    most = most.cwiseMax(point.place);
    const double turned = (wrap_angle(point.heading) + std::numbers::pi) / (2 * std::numbers::pi);
    headings[std::min<std::size_t>(7, static_cast<std::size_t>(8 * turned))] = true;
  }
  EXPECT_GT((most - least).minCoeff(), 1.2);
  for (const bool seen : headings) EXPECT_TRUE(seen);
}

TEST(Walker, WaysMayBeTooShortForACruise) {  // ends the process where the library's assertions hold
  for (unsigned seed = 1; seed <= 20; ++seed) {
    WalkerScript script;
    script.seed = seed;
    script.reach = 0.4;
    const Walker walker(script);
    for (Duration t{}; t < std::chrono::seconds(60); t += 10 * kStep)
      ASSERT_LT(walker.path().at(t).place.cwiseAbs().maxCoeff(), 0.5) << seed;
  }
}

TEST(Walker, TurnsInPlaceOnceRoundToEitherSideWithPauses) {
  WalkerScript script;
  script.path = PathKind::Turn;
  script.centre = {0.4, -0.3};
  const Walker walker(script);
  double turned = 0, most = 0, least = 0, fastest = 0;
  Duration still{};
  for (Duration t{}; t < walker.path().loop(); t += kStep) {
    const PathPoint now = walker.path().at(t);
    ASSERT_TRUE(now.place.isApprox(script.centre)) << "stays where it is";
    const double step = wrap_angle(walker.path().at(t + kStep).heading - now.heading);
    turned += step;
    most = std::max(most, turned);
    least = std::min(least, turned);
    fastest = std::max(fastest, std::abs(step) / seconds(kStep));
    if (step == 0) still += kStep;
  }
  EXPECT_NEAR(most - least, 2 * std::numbers::pi, 0.01) << "a full turn";
  EXPECT_NEAR(turned, 0.0, 0.01) << "and back";
  EXPECT_GT(fastest, deg(100));
  EXPECT_LT(fastest, deg(220)) << "human speed";
  EXPECT_NEAR(seconds(still), 3.0, 0.3);
}

/// The times at which a hand is far in front of the body, and where it is then, in one assembly
/// loop.
std::vector<std::pair<Duration, Eigen::Vector3d>> reaches(const Walker& walker, bool left) {
  std::vector<std::pair<Duration, Eigen::Vector3d>> all;
  for (Duration t{}; t < walker.path().loop(); t += kStep) {
    const PathPoint point = walker.path().at(t);
    if (point.reach.amount < 1 || point.reach.left != left) continue;
    const auto body = walker.at(t);
    all.emplace_back(t, body[left ? JointId::WristLeft : JointId::WristRight].position);
  }
  return all;
}

TEST(Walker, AtAWorkplaceHandsTakeTurnsAtPointsOfDifferentHeights) {
  WalkerScript script;
  script.path = PathKind::Assembly;
  const Walker walker(script);
  for (const bool left : {true, false}) {
    double lowest = 9, highest = 0;
    const auto held = reaches(walker, left);
    ASSERT_FALSE(held.empty());
    for (const auto& [time, wrist] : held) {
      const auto body = walker.at(time);
      const auto& other = body[left ? JointId::WristRight : JointId::WristLeft].position;
      const auto& own = body[left ? JointId::ShoulderLeft : JointId::ShoulderRight].position;
      EXPECT_GT((wrist - own).cross(Eigen::Vector3d::UnitY()).norm(), 0.25) << "stretched out";
      EXPECT_LT(other.y(), 1.05) << "the other hand hangs";
      lowest = std::min(lowest, wrist.y());
      highest = std::max(highest, wrist.y());
    }
    EXPECT_GT(highest - lowest, 0.4);
  }
}

TEST(Walker, AtAWorkplaceTheBodyStepsAsideWithoutTurning) {
  WalkerScript script;
  script.path = PathKind::Assembly;
  const Walker walker(script);
  const double heading = walker.path().at(Duration::zero()).heading;
  const Eigen::Vector2d front(std::sin(heading), std::cos(heading));
  const Eigen::Vector2d first = walker.path().at(Duration::zero()).place;
  double farthest = 0;
  for (Duration t{}; t < walker.path().loop(); t += kStep) {
    const PathPoint point = walker.path().at(t);
    ASSERT_EQ(point.heading, heading);
    ASSERT_NEAR((point.place - first).dot(front), 0.0, 1e-9);
    farthest = std::max(farthest, (point.place - first).norm());
  }
  EXPECT_NEAR(farthest, 0.8, 1e-6) << "three stations, 0.4 m apart";
}

TEST(Walker, AnyScriptIsSurvived) {
  for (const double odd : {0.0, -1.0, 1e9, std::nan("")}) {
    WalkerScript script;
    script.speed = odd;
    script.body_scale = odd;
    EXPECT_NO_FATAL_FAILURE((void)Walker(script).at(std::chrono::seconds(1)));
  }
  WalkerScript nowhere;
  nowhere.reach = 0;
  EXPECT_TRUE(Walker(nowhere).at(std::chrono::seconds(1))[JointId::Neck].position.allFinite());
}

}  // namespace
}  // namespace chorus::synthetic
