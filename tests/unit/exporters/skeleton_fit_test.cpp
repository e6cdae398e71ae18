#include "common/exporters/skeleton_fit.h"

#include <gmock/gmock.h>

#include <cstdio>

#include "common/base/units.h"
#include "common/body/bones.h"
#include "tests/support/matchers.h"
#include "tests/unit/exporters/poses.h"

namespace chorus::exporters {
namespace {

using chorus::testing::FailsWith;
using chorus::testing::hide;
using chorus::testing::IsOk;
using chorus::testing::VectorNear;

PersonTrack track_of(std::vector<Skeleton<WorldSpace>> frames) {
  return take_of({std::move(frames)}, 30.0).persons.front();
}

/// Largest distance between the chain and the joints of one frame [m].
double largest_distance(const SkeletonFit& fit, const PersonTrack& track, std::size_t frame) {
  const auto places = chain_positions(fit, fit.poses[frame]);
  double largest = 0;
  for (std::size_t i = 0; i < fit.joints.size(); ++i)
    largest = std::max(largest,
                       (places[i] - track.poses[frame].skeleton[fit.joints[i].id].position).norm());
  return largest;
}

TEST(SkeletonFit, OnePoseIsMetExactly) {
  const auto track = track_of({asymmetric_person()});
  const auto fit = fit_skeleton(track);
  ASSERT_THAT(fit, IsOk());
  EXPECT_EQ(fit->joints.size(), kJointCount);
  EXPECT_LT(largest_distance(*fit, track, 0), 1e-5);
}

TEST(SkeletonFit, RestsInATPoseFacingAheadWithTheLeftAtPositiveX) {
  const auto fit = fit_skeleton(track_of({asymmetric_person()}));
  ASSERT_THAT(fit, IsOk());
  const auto rest = rest_positions(*fit);
  const auto at = [&](JointId id) {
    for (std::size_t i = 0; i < fit->joints.size(); ++i) {
      if (fit->joints[i].id == id) return rest[i];
    }
    return Eigen::Vector3d(NAN, NAN, NAN);
  };
  EXPECT_GT(at(JointId::WristLeft).x(), 0.4);
  EXPECT_LT(at(JointId::WristRight).x(), -0.4);
  EXPECT_GT(at(JointId::Head).y(), 0.5);
  EXPECT_LT(at(JointId::AnkleLeft).y(), -0.6);
  EXPECT_GT(at(JointId::FootRight).z(), at(JointId::AnkleRight).z() + 0.05);
  EXPECT_NEAR(at(JointId::WristLeft).y(), at(JointId::ShoulderLeft).y(), 1e-9);
}

TEST(SkeletonFit, FollowsAWalkOfRigidBonesWithinMillimetres) {
  const auto track = track_of(walk());
  const auto fit = fit_skeleton(track);
  ASSERT_THAT(fit, IsOk());
  ASSERT_EQ(fit->poses.size(), track.poses.size());
  // In the walk, SpineBase and the spine's joints are weighted means of bone ends, so their
  // distances are not quite constant.
  EXPECT_LT(fit->residual.rms, mm(8));
  EXPECT_LT(fit->residual.largest, mm(40));
}

TEST(SkeletonFit, StaysNearJointsWhoseDistancesBreathe) {
  const auto fit = fit_skeleton(track_of(breathing_walk()));
  ASSERT_THAT(fit, IsOk());
  EXPECT_LT(fit->residual.rms, mm(30)) << "noise of 20 mm to either side on each axis";
  EXPECT_GT(fit->residual.rms, mm(5)) << "and no chain of constant bones meets that";
  std::printf("walk with 20 mm noise: rms %.1f mm, largest %.1f mm\n", to_mm(fit->residual.rms),
              to_mm(fit->residual.largest));
}

TEST(SkeletonFit, ReportsTheLargestDistanceAndWhere) {
  auto frames = std::vector(5, asymmetric_person());
  frames[3][JointId::KneeLeft].position.y() += 0.2;
  const auto track = track_of(frames);
  const auto fit = fit_skeleton(track);
  ASSERT_THAT(fit, IsOk());
  EXPECT_EQ(fit->residual.frame, 3u);
  EXPECT_NEAR(fit->residual.largest, largest_distance(*fit, track, 3), 1e-12);
  EXPECT_GT(fit->residual.largest, 0.1);
}

TEST(SkeletonFit, QuaternionsAreUnitAndNeverJumpInSign) {
  const auto fit = fit_skeleton(track_of(turning()));
  ASSERT_THAT(fit, IsOk());
  for (std::size_t f = 1; f < fit->poses.size(); ++f) {
    for (std::size_t i = 0; i < fit->joints.size(); ++i) {
      const auto& turn = fit->poses[f].turns[i];
      ASSERT_NEAR(turn.norm(), 1.0, 1e-12);
      ASSERT_GE(turn.dot(fit->poses[f - 1].turns[i]), 0.0) << name_of(fit->joints[i].id);
    }
  }
}

TEST(SkeletonFit, TakesTheTwistOfPelvisAndChestFromTheirLines) {
  const auto still = asymmetric_person();
  Skeleton<WorldSpace> turned = still;
  const Eigen::AngleAxisd quarter(deg(70), Eigen::Vector3d::UnitY());
  const Eigen::Vector3d centre = still[JointId::SpineBase].position;
  for (Joint& joint : turned.joints) joint.position = centre + quarter * (joint.position - centre);
  const auto fit = fit_skeleton(track_of({still, turned}));
  ASSERT_THAT(fit, IsOk());
  EXPECT_THAT(fit->poses[1].turns[0],
              chorus::testing::RotationNear(quarter * fit->poses[0].turns[0], 1e-5));
  for (std::size_t i = 1; i < fit->joints.size(); ++i) {
    EXPECT_THAT(fit->poses[1].turns[i], chorus::testing::RotationNear(fit->poses[0].turns[i], 1e-4))
        << name_of(fit->joints[i].id);
  }
}

TEST(SkeletonFit, HoldsWhatItDoesNotSee) {
  auto frames = std::vector(4, asymmetric_person());
  for (std::size_t f = 0; f < frames.size(); ++f) {
    for (Joint& joint : frames[f].joints) joint.position.x() += 0.1 * static_cast<double>(f);
  }
  for (Joint& joint : frames[0].joints) hide(joint);
  for (Joint& joint : frames[2].joints) hide(joint);
  hide(frames[3][JointId::ElbowLeft]);
  hide(frames[3][JointId::WristLeft]);
  const auto fit = fit_skeleton(track_of(frames));
  ASSERT_THAT(fit, IsOk());
  EXPECT_EQ(fit->poses[0].root, fit->poses[1].root) << "before the first: the first";
  EXPECT_EQ(fit->poses[2].root, fit->poses[1].root) << "nobody there: held";
  const auto places = chain_positions(*fit, fit->poses[3]);
  const auto wanted = [&](JointId id) {
    return Eigen::Vector3d(asymmetric_person()[id].position + Eigen::Vector3d(0.3, 0, 0));
  };
  for (std::size_t i = 0; i < fit->joints.size(); ++i)
    EXPECT_THAT(places[i], VectorNear(wanted(fit->joints[i].id), 1e-3))
        << name_of(fit->joints[i].id) << ": an arm that is not seen goes along with the body";
}

TEST(SkeletonFit, LeavesOutJointsThatAreNeverThere) {
  auto frames = std::vector(3, asymmetric_person());
  for (auto& body : frames) {
    hide(body[JointId::Neck]);
    hide(body[JointId::ThumbLeft]);
  }
  const auto fit = fit_skeleton(track_of(frames));
  ASSERT_THAT(fit, IsOk());
  EXPECT_EQ(fit->joints.size(), kJointCount - 2);
  for (const FittedJoint& joint : fit->joints) {
    EXPECT_NE(joint.id, JointId::Neck);
    if (joint.id == JointId::Head) {
      EXPECT_EQ(fit->joints[joint.parent].id, JointId::SpineShoulder);
    }
  }
  EXPECT_LT(fit->residual.largest, 1e-5);
}

TEST(SkeletonFit, RefusesAPersonWithoutSpineBase) {
  auto body = asymmetric_person();
  hide(body[JointId::SpineBase]);
  EXPECT_THAT(fit_skeleton(track_of({body})), FailsWith(ErrorCode::Unsupported));
}

TEST(SkeletonFit, SurvivesJointsInOnePlaceAndOnOneLine) {
  Skeleton<WorldSpace> point;
  Skeleton<WorldSpace> line;
  for (std::size_t j = 0; j < kJointCount; ++j) {
    point.joints[j].state = line.joints[j].state = JointState::Tracked;
    line.joints[j].position = Eigen::Vector3d(0, 0.1 * static_cast<double>(j), 0);
  }
  const auto fit = fit_skeleton(track_of({point, line, point}));
  ASSERT_THAT(fit, IsOk());
  for (const FittedPose& pose : fit->poses) {
    for (const auto& turn : pose.turns) EXPECT_TRUE(turn.coeffs().allFinite());
  }
}

}  // namespace
}  // namespace chorus::exporters
