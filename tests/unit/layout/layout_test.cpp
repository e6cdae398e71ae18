// Skeleton layouts: tables without mistakes, and joints computed from landmarks.
#include "common/layout/layout.h"

#include <algorithm>
#include <cctype>
#include <map>
#include <set>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/body/bones.h"
#include "common/geometry/rotation.h"
#include "common/layout/tables.h"
#include "tests/support/matchers.h"

namespace chorus::layout {
namespace {

using testing::FailsWith;
using ::testing::HasSubstr;

std::string lower(std::string_view text) {
  std::string low(text);
  std::transform(low.begin(), low.end(), low.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  return low;
}

/// The counterpart on the other side of the body: "LShoulder" <-> "RShoulder", "mouth_left" <-> ...
std::string mirrored(std::string name) {
  for (const auto& [one, other] : std::map<std::string, std::string>{
           {"LEFT", "RIGHT"}, {"left", "right"}, {"Left", "Right"}}) {
    if (const auto at = name.find(one); at != std::string::npos)
      return name.replace(at, one.size(), other);
    if (const auto at = name.find(other); at != std::string::npos)
      return name.replace(at, other.size(), one);
  }
  const bool short_form = name.size() > 1 &&
                          std::isupper(static_cast<unsigned char>(name[1])) != 0 &&
                          std::islower(static_cast<unsigned char>(name[2])) != 0;
  if (short_form && (name[0] == 'L' || name[0] == 'R')) name[0] = name[0] == 'L' ? 'R' : 'L';
  return name;
}

/// Landmark name -> weight.
std::map<std::string, double> parts(const Layout& layout, const Recipe& recipe) {
  std::map<std::string, double> result;
  for (const Share& share : recipe.shares) {
    if (share.weight > 0.0) result[std::string(layout.landmarks[share.landmark])] += share.weight;
  }
  return result;
}

std::vector<const Recipe*> recipes_for(const Layout& layout, JointId joint) {
  std::vector<const Recipe*> found;
  for (const Recipe& recipe : layout.recipes) {
    if (recipe.joint == joint) found.push_back(&recipe);
  }
  return found;
}

class EveryLayout : public ::testing::TestWithParam<const Layout*> {};

INSTANTIATE_TEST_SUITE_P(Tables, EveryLayout,
                         ::testing::ValuesIn(layouts().begin(), layouts().end()),
                         [](const auto& row) { return std::string(row.param->name); });

TEST_P(EveryLayout, NamesItsSourceAndEachLandmarkOnce) {
  const Layout& layout = *GetParam();
  EXPECT_THAT(std::string(layout.source), HasSubstr("://"));
  const std::set<std::string_view> names(layout.landmarks.begin(), layout.landmarks.end());
  EXPECT_EQ(names.size(), layout.landmarks.size());
  EXPECT_EQ(names.count(""), 0U);
  EXPECT_TRUE(layout.name.ends_with("_" + std::to_string(layout.landmarks.size()))) << layout.name;
  EXPECT_GE(layout.tracked_from, layout.inferred_from);
}

TEST_P(EveryLayout, IsMadeOfItsOwnLandmarksWithWeightsThatSumToOne) {
  const Layout& layout = *GetParam();
  for (const Recipe& recipe : layout.recipes) {
    double sum = 0.0;
    for (const Share& share : recipe.shares) {
      sum += share.weight;
      EXPECT_LT(share.landmark, layout.landmarks.size()) << name_of(recipe.joint);
    }
    EXPECT_NEAR(sum, 1.0, 1e-12) << name_of(recipe.joint);
  }
}

TEST_P(EveryLayout, IsTheSameOnBothSidesOfTheBody) {
  const Layout& layout = *GetParam();
  for (const Recipe& recipe : layout.recipes) {
    const auto other = joint_named(mirrored(std::string(name_of(recipe.joint))));
    ASSERT_TRUE(other);
    std::map<std::string, double> wanted;
    for (const auto& [name, weight] : parts(layout, recipe)) wanted[mirrored(name)] += weight;
    const auto twins = recipes_for(layout, *other);
    EXPECT_TRUE(std::any_of(twins.begin(), twins.end(), [&](const Recipe* twin) {
      return parts(layout, *twin) == wanted;
    })) << name_of(recipe.joint);
  }
}

TEST_P(EveryLayout, TakesLimbsFromLandmarksOfThatName) {
  const Layout& layout = *GetParam();
  for (const char* part : {"Shoulder", "Elbow", "Wrist", "Hip", "Knee", "Ankle"}) {
    for (const char* side : {"Left", "Right"}) {
      const auto found = recipes_for(layout, *joint_named(std::string(part) + side));
      if (found.empty()) {
        EXPECT_STREQ(part, "Ankle") << "all have the other limbs";
        continue;
      }
      const auto made_of = parts(layout, *found.front());
      ASSERT_EQ(made_of.size(), 1U);
      const std::string name = made_of.begin()->first;
      EXPECT_THAT(lower(name), HasSubstr(lower(part)));
      const char short_side = static_cast<char>(std::toupper(static_cast<unsigned char>(side[0])));
      EXPECT_TRUE(lower(name).find(lower(side)) != std::string::npos || name[0] == short_side)
          << name << " for " << part << side;
    }
  }
}

TEST_P(EveryLayout, GivesTheJointsThatRegistrationNeeds) {
  for (const JointId joint :
       {JointId::SpineBase, JointId::SpineShoulder, JointId::Neck, JointId::Head})
    EXPECT_FALSE(recipes_for(*GetParam(), joint).empty()) << name_of(joint);
}

TEST(Layouts, AreFoundByName) {
  const auto found = find_layout("halpe_26");
  ASSERT_THAT(found, testing::IsOk());
  EXPECT_EQ((*found)->landmarks[17], "Head");
  EXPECT_EQ(landmark_named(**found, "LBigToe"), 20U);
  EXPECT_EQ(landmark_named(**found, "Tail"), std::nullopt);
}

TEST(Layouts, AnUnknownNameIsToldTheKnownOnes) {
  const auto found = find_layout("body_26");
  ASSERT_THAT(found, FailsWith(ErrorCode::NotFound));
  for (const Layout* layout : layouts())
    EXPECT_THAT(found.error().message, HasSubstr(std::string(layout->name)));
}

std::vector<Landmark> row_of(std::size_t count) {
  std::vector<Landmark> landmarks(count);
  for (std::size_t i = 0; i < count; ++i)
    landmarks[i] = {Eigen::Vector3d(static_cast<double>(i), 1.0, 2.0), JointState::Tracked};
  return landmarks;
}

const Joint& joint_in(const std::array<Joint, kJointCount>& joints, JointId id) {
  return joints[index_of(id)];
}

TEST(LandmarkJoints, AreMeansAsSureAsTheirLeastSureLandmark) {
  auto landmarks = row_of(33);
  landmarks[24].state = JointState::Inferred;
  landmarks[31].state = JointState::NotTracked;
  const auto joints = joints_of(kMediapipe, landmarks);
  EXPECT_DOUBLE_EQ(joint_in(joints, JointId::SpineBase).position.x(), 23.5);
  EXPECT_EQ(joint_in(joints, JointId::SpineBase).state, JointState::Inferred);
  EXPECT_EQ(joint_in(joints, JointId::FootLeft).state, JointState::NotTracked);
  EXPECT_EQ(joint_in(joints, JointId::FootLeft).position, Eigen::Vector3d::Zero());
}

TEST(LandmarkJoints, AStandInIsAtMostInferred) {
  auto landmarks = row_of(17);
  landmarks[4].state = JointState::NotTracked;  // the right ear
  const auto joints = joints_of(kCoco17, landmarks);
  EXPECT_DOUBLE_EQ(joint_in(joints, JointId::Head).position.x(), 3.0);
  EXPECT_EQ(joint_in(joints, JointId::Head).state, JointState::Inferred);
  EXPECT_EQ(joint_in(joints, JointId::ShoulderLeft).state, JointState::Tracked);
}

TEST(LandmarkJoints, MissingAndBrokenLandmarksMakeNoJoint) {
  auto landmarks = row_of(12);  // up to the left hip
  landmarks[5].position.x() = std::nan("");
  const auto joints = joints_of(kCoco17, landmarks);
  EXPECT_EQ(joint_in(joints, JointId::ShoulderLeft).state, JointState::NotTracked);
  EXPECT_EQ(joint_in(joints, JointId::SpineBase).state, JointState::NotTracked);
  EXPECT_EQ(joint_in(joints, JointId::HipLeft).state, JointState::Tracked);
  for (const Joint& joint : joints_of(kCoco17, {})) EXPECT_EQ(joint.state, JointState::NotTracked);
}

TEST(LandmarkJoints, OfRaysAreUnitRaysBetweenThem) {
  std::vector<Landmark> landmarks(17);
  landmarks[11] = {Eigen::Vector3d(0.1, 0.0, 1.0).normalized(), JointState::Tracked,
                   Measurement::Ray};
  landmarks[12] = {Eigen::Vector3d(-0.1, 0.0, 1.0).normalized(), JointState::Tracked,
                   Measurement::Ray};
  const auto joints = joints_of(kCoco17, landmarks);
  const Joint& base = joint_in(joints, JointId::SpineBase);
  EXPECT_EQ(base.measurement, Measurement::Ray);
  EXPECT_TRUE(base.bears());
  EXPECT_THAT(base.position, testing::VectorNear(Eigen::Vector3d(0, 0, 1), 1e-12));
  landmarks[12].measurement = Measurement::Point;
  EXPECT_EQ(joint_in(joints_of(kCoco17, landmarks), JointId::SpineBase).state,
            JointState::NotTracked)
      << "a ray and a point have no mean";
}

TEST(LandmarkJoints, CovarianceIsThatOfTheMeanAndKnownOnlyOfAll) {
  auto landmarks = row_of(17);
  landmarks[11].covariance = Covariance(Eigen::Matrix3d(Eigen::Matrix3d::Identity() * 0.04));
  const auto half_known = joints_of(kCoco17, landmarks);
  EXPECT_TRUE(joint_in(half_known, JointId::HipLeft).covariance.known());
  EXPECT_FALSE(joint_in(half_known, JointId::SpineBase).covariance.known());
  landmarks[12].covariance = landmarks[11].covariance;
  const auto joints = joints_of(kCoco17, landmarks);
  EXPECT_NEAR(joint_in(joints, JointId::SpineBase).covariance.matrix()(0, 0), 0.02, 1e-7);
}

TEST(Confidence, IsTrackedInferredOrNothing) {
  EXPECT_EQ(state_of(0.6, 0.6, 0.2), JointState::Tracked);
  EXPECT_EQ(state_of(0.59, 0.6, 0.2), JointState::Inferred);
  EXPECT_EQ(state_of(0.19, 0.6, 0.2), JointState::NotTracked);
  EXPECT_EQ(state_of(std::nan(""), 0.6, 0.2), JointState::NotTracked);
}

/// Nose, eyes and ears of a head with the eyes 3 cm above and the nose 3 cm below the ears.
std::vector<Landmark> face_of(const Eigen::Quaterniond& turn) {
  std::vector<Landmark> landmarks(33);
  const Eigen::Vector3d place(0.4, 1.6, 2.0);
  const auto put = [&](std::size_t number, const Eigen::Vector3d& in_head) {
    landmarks[number] = {place + turn * in_head, JointState::Tracked};
  };
  put(0, {0, -0.06, 0.11});
  put(2, {0.03, 0.03, 0.09});
  put(5, {-0.03, 0.03, 0.09});
  put(7, {0.075, 0, 0});
  put(8, {-0.075, 0, 0});
  return landmarks;
}

TEST(HeadTurn, FollowsNoseEyesAndEars) {
  for (const Eigen::Vector3d& turn :
       {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(0.3, 0, 0), Eigen::Vector3d(0, -0.8, 0),
        Eigen::Vector3d(0.2, 2.5, -0.3)}) {
    const Eigen::Quaterniond true_turn = exp_map(turn);
    const auto landmarks = face_of(true_turn);
    const auto joints = joints_of(kMediapipe, landmarks);
    EXPECT_LT(angular_distance(joints[index_of(JointId::Head)].orientation, true_turn), 1e-6);
    EXPECT_FALSE(is_unit(joints[index_of(JointId::Neck)].orientation));
  }
}

TEST(HeadTurn, IsUnknownWithoutAllMarksAsPoints) {
  auto hidden = face_of(Eigen::Quaterniond::Identity());
  hidden[8].state = JointState::NotTracked;
  EXPECT_FALSE(head_turn(kMediapipe, hidden));
  auto rays = face_of(Eigen::Quaterniond::Identity());
  rays[0].measurement = Measurement::Ray;
  EXPECT_FALSE(head_turn(kMediapipe, rays));
  auto flat = face_of(Eigen::Quaterniond::Identity());
  for (const std::size_t mark : {0u, 2u, 5u}) flat[mark].position = flat[7].position;
  EXPECT_FALSE(head_turn(kMediapipe, flat));
  EXPECT_FALSE(head_turn(kKinectV2, hidden));
}

}  // namespace
}  // namespace chorus::layout
