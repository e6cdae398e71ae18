#include "common/synthetic/performer.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "common/motion/cmu_walk.h"
#include "tests/support/temporary_folder.h"

namespace chorus::synthetic {
namespace {

using ::testing::HasSubstr;

constexpr const char* kTake = "common/motion/assets/02_01.amc";  // CMU: a few steps straight ahead
constexpr Duration kPerformerStep = std::chrono::milliseconds(1);

std::shared_ptr<const Performance> take() {
  return std::make_shared<const Performance>(read_performance({kTake}).value());
}

std::string refusal(const MotionFile& file) {
  const auto read = read_performance(file);
  return read ? "" : to_string(read.error());
}

/// A BVH file of a person a few centimetres tall, with twelve joints and a head, who is lower in
/// the second frame.
std::string small_bvh() {
  const auto limb = [](const std::string& a, const std::string& b, const std::string& c,
                       const std::string& at, const std::string& reach, const std::string& tip) {
    const std::string turns = "CHANNELS 3 Zrotation Xrotation Yrotation\n";
    return "JOINT " + a + " {\nOFFSET " + at + "\n" + turns + "JOINT " + b + " {\nOFFSET " + reach +
           "\n" + turns + "JOINT " + c + " {\nOFFSET " + reach + "\n" + turns +
           "End Site {\nOFFSET " + tip + "\n}\n}\n}\n}\n";
  };
  std::string text =
      "HIERARCHY\nROOT Hips {\nOFFSET 0 0 0\n"
      "CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation\n";
  text += limb("LeftUpLeg", "LeftLeg", "LeftFoot", "10 0 0", "0 -42 0", "0 0 10");
  text += limb("RightUpLeg", "RightLeg", "RightFoot", "-10 0 0", "0 -42 0", "0 0 10");
  text += limb("LeftArm", "LeftForeArm", "LeftHand", "18 50 0", "0 -28 0", "0 -16 0");
  text += limb("RightArm", "RightForeArm", "RightHand", "-18 50 0", "0 -28 0", "0 -16 0");
  text += "JOINT Head {\nOFFSET 0 70 0\nCHANNELS 3 Zrotation Xrotation Yrotation\n";
  text += "End Site {\nOFFSET 0 15 0\n}\n}\n}\nMOTION\nFrames: 3\nFrame Time: 0.5\n";
  for (const char* root : {"500 90 100", "500 70 100", "520 90 100"}) {
    text += root;
    for (int i = 0; i < 3 + 13 * 3; ++i) text += " 0";
    text += "\n";
  }
  return text;
}

std::vector<Eigen::Vector3d> way_of(const Performer& performer, JointId joint, Duration step) {
  std::vector<Eigen::Vector3d> way;
  for (Duration t{0}; t < performer.loop(); t += step) {
    way.push_back(performer.at(t)[joint].position);
  }
  return way;
}

TEST(Performance, ReadsATakeWithTheSkeletonBesideIt) {
  const auto performance = take();
  ASSERT_EQ(performance->roles.size(), 1u);
  EXPECT_EQ(performance->roles[0].rate_hz, motion::kCmuRateHz);
  EXPECT_EQ(performance->roles[0].frames.size(), motion::cmu_walk().takes[0].size());
}

TEST(Performance, ABvhGetsTheJointsItLacks) {
  const chorus::testing::TemporaryFolder folder;
  std::ofstream(folder / "sit.BVH") << small_bvh();
  const auto performance = read_performance({folder / "sit.BVH"});
  ASSERT_TRUE(performance) << to_string(performance.error());
  for (const auto& body : performance->roles.at(0).frames) {
    for (const Joint& joint : body.joints) EXPECT_EQ(joint.state, JointState::Tracked);
    const auto x = [&](JointId id) { return body[id].position; };
    EXPECT_GT(x(JointId::ThumbLeft).z(), x(JointId::HandLeft).z() + 0.02) << "thumbs to the front";
    EXPECT_LT(x(JointId::HandTipRight).y(), x(JointId::WristRight).y());
    EXPECT_GT(x(JointId::Neck).y(), x(JointId::SpineShoulder).y());
  }
}

TEST(Performance, AGapIsCrossedStraightAndAnAbsentFootGuessed) {
  motion::Motion role = take()->roles[0];
  role.frames.resize(60);
  const Eigen::Vector3d before = role.frames[9][JointId::WristLeft].position;
  const Eigen::Vector3d after = role.frames[30][JointId::WristLeft].position;
  for (std::size_t i = 10; i < 30; ++i) role.frames[i][JointId::WristLeft] = Joint{};
  for (auto& body : role.frames) body[JointId::FootRight] = Joint{};
  const auto performance = staged({role});
  ASSERT_TRUE(performance) << to_string(performance.error());
  const auto& frames = performance->roles.at(0).frames;
  const Eigen::Vector3d shift = frames[9][JointId::WristLeft].position - before;
  const Eigen::Vector3d half = before + (after - before) * 10.0 / 21.0 + shift;
  EXPECT_TRUE(frames[19][JointId::WristLeft].position.isApprox(half, 1e-9));
  EXPECT_EQ(frames[19][JointId::WristLeft].state, JointState::Tracked);
  const double foot =
      (frames[5][JointId::FootRight].position - frames[5][JointId::AnkleRight].position).norm();
  EXPECT_GT(foot, 0.1);
  EXPECT_LT(foot, 0.2);
}

TEST(Performance, APoseBeforeTheMotionIsLeftOut) {
  motion::Motion role = take()->roles[0];
  const std::size_t count = role.frames.size();
  role.frames.insert(role.frames.begin(), role.frames[0]);
  EXPECT_EQ(staged({role})->roles[0].frames.size(), count + 1) << "standing still is no pose";
  role.frames[0][JointId::WristLeft].position += Eigen::Vector3d(0.6, 0.6, 0);
  EXPECT_EQ(staged({role})->roles[0].frames.size(), count);
}

TEST(Performance, WhatCannotBePlayedIsRefusedWithTheReason) {
  const chorus::testing::TemporaryFolder folder;
  std::ofstream(folder / "lost.amc") << "1\n";
  std::ofstream(folder / "torn.bvh") << "HIERARCHY\nROOT";
  std::ofstream(folder / "sit.bvh") << small_bvh();
  EXPECT_THAT(refusal({"/no/such.bvh"}), HasSubstr("/no/such.bvh"));
  EXPECT_THAT(refusal({folder / "walk.fbx"}), HasSubstr(".bvh, .amc (with its .asf)"));
  EXPECT_THAT(refusal({folder / "lost.amc"}), HasSubstr("lost.asf"));
  EXPECT_THAT(refusal({folder / "torn.bvh"}), HasSubstr("torn.bvh"));
  EXPECT_THAT(refusal({folder / "sit.bvh", 1.0}), HasSubstr("metres_per_unit"));
  EXPECT_THAT(refusal({folder / "sit.bvh", 0.0254}), HasSubstr("metres_per_unit"));
  std::filesystem::create_directory(folder / "all.bvh");
  EXPECT_THAT(refusal({folder / "all.bvh"}), HasSubstr("folder"));
  EXPECT_FALSE(staged({}));
  EXPECT_FALSE(staged({motion::Motion{}}));
  motion::Motion handless = take()->roles[0];
  for (auto& body : handless.frames) body[JointId::WristLeft] = Joint{};
  EXPECT_THAT(to_string(staged({handless}).error()), HasSubstr("WristLeft"));
  EXPECT_TRUE(staged({handless, take()->roles[0]})) << "somebody else is whole";
  motion::Motion long_one = take()->roles[0];
  long_one.frames.resize(kMaxMotionFrames + 1);
  EXPECT_EQ(staged({long_one}).error().code, ErrorCode::TooLarge);
}

TEST(Performer, NeitherPlaceNorVelocityJumps) {
  const Performer performer(take(), {});
  constexpr double kMaxSpeed = 6.0;           // largest speed of a wrist in this walk [m/s]
  constexpr double kMaxAcceleration = 400.0;  // heels strike; corners would have 2000 [m/s^2]
  const double dt = seconds(kPerformerStep);
  for (const JointId joint : {JointId::SpineBase, JointId::WristRight, JointId::FootLeft}) {
    std::vector<Eigen::Vector3d> way = way_of(performer, joint, kPerformerStep);
    way.insert(way.end(), way.begin(), way.begin() + 100);  // past the end of the loop
    for (std::size_t i = 2; i < way.size(); ++i) {
      EXPECT_LT((way[i] - way[i - 1]).norm(), kMaxSpeed * dt) << i;
      EXPECT_LT((way[i] - 2 * way[i - 1] + way[i - 2]).norm(), kMaxAcceleration * dt * dt) << i;
    }
  }
}

TEST(Performer, PlaysTheTakeForwardsAndBack) {
  const auto performance = take();
  const Performer performer(performance, {});
  const auto& role = performance->roles[0];
  const double length = static_cast<double>(role.frames.size() - 1) / role.rate_hz;
  const Duration half = from_seconds(length / 2);
  const auto middle = motion::at(role, length / 2);
  for (const Duration t : {half, 3 * half, half + performer.loop(), half - performer.loop()}) {
    for (const JointId joint : {JointId::SpineBase, JointId::HandTipLeft}) {
      EXPECT_LT((performer.at(t)[joint].position - middle[joint].position).norm(), 2e-3);
    }
  }
}

TEST(Performer, StandsOnTheFloorAtTheCentreInItsSize) {
  const Eigen::Vector2d centre(1.5, -2.0);
  const Performer small(take(), {.centre = centre, .body_scale = 0.8});
  const Performer usual(take(), {});
  Eigen::Vector3d least = Eigen::Vector3d::Constant(1e9);
  Eigen::Vector3d most = -least;
  for (const Eigen::Vector3d& x : way_of(small, JointId::SpineBase, 10 * kPerformerStep)) {
    least = least.cwiseMin(x);
    most = most.cwiseMax(x);
  }
  EXPECT_NEAR(0.5 * (least.x() + most.x()), centre.x(), 0.02);
  EXPECT_NEAR(0.5 * (least.z() + most.z()), centre.y(), 0.02);
  EXPECT_GT((most - least).norm(), 1.0) << "somebody walks";
  double lowest = 1e9;
  for (const Eigen::Vector3d& x : way_of(usual, JointId::FootLeft, 10 * kPerformerStep)) {
    lowest = std::min(lowest, x.y());
  }
  EXPECT_NEAR(lowest, 0.03, 0.03);
  const Duration t = std::chrono::seconds(1);
  EXPECT_NEAR(small.at(t)[JointId::Head].position.y(),
              0.8 * usual.at(t)[JointId::Head].position.y(), 1e-9);
}

TEST(Performer, SeveralPeopleStandApartAndDoNotMoveAlike) {
  WalkerScript script;
  script.reach = 2.0;
  const auto people = make_performers(take(), script, 3);
  ASSERT_EQ(people.size(), 3u);
  const Duration t = std::chrono::seconds(1);
  for (std::size_t i = 0; i < people.size(); ++i) {
    const auto one = people[i](t);
    const auto other = people[(i + 1) % people.size()](t);
    EXPECT_GT((one[JointId::Neck].position - other[JointId::Neck].position).norm(), 0.5);
    // The distance between the hands, divided by that between the hips, is independent of size and
    // place.
    const auto spread = [](const Skeleton<WorldSpace>& body) {
      const auto between = [&](JointId a, JointId b) {
        return (body[a].position - body[b].position).norm();
      };
      return between(JointId::HandLeft, JointId::HandRight) /
             between(JointId::HipLeft, JointId::HipRight);
    };
    EXPECT_GT(std::abs(spread(one) - spread(other)), 0.02);
  }
  const auto alone = make_performers(take(), script, 1);
  EXPECT_EQ(alone[0](t)[JointId::Neck].position,
            Performer(take(), {}).at(t)[JointId::Neck].position);
}

TEST(Performer, PeopleOfOneFileStayAsCaptured) {
  motion::Motion first = take()->roles[0];
  motion::Motion second = first;
  for (auto& body : second.frames) {
    for (Joint& joint : body.joints) joint.position.x() += 1.0;
  }
  const auto pair = std::make_shared<const Performance>(staged({first, second}).value());
  const auto people = make_performers(pair, {}, 2);
  for (const int s : {0, 1, 2, 3}) {
    const auto a = people[0](std::chrono::seconds(s))[JointId::Head].position;
    const auto b = people[1](std::chrono::seconds(s))[JointId::Head].position;
    EXPECT_TRUE((b - a).isApprox(Eigen::Vector3d::UnitX(), 1e-9));
  }
}

TEST(Performer, NobodyWithoutAPerformance) {
  EXPECT_FALSE(Performer(nullptr, {}).at(kPerformerStep)[JointId::Neck].seen());
  EXPECT_FALSE(Performer(take(), {.role = 7}).at(kPerformerStep)[JointId::Neck].seen());
  EXPECT_TRUE(make_performers(nullptr, {}, 0).empty());
  motion::Motion still = take()->roles[0];
  still.frames.resize(1);
  const auto statue = std::make_shared<const Performance>(staged({still}).value());
  const Performer performer(statue, {});
  EXPECT_EQ(performer.at(kPerformerStep)[JointId::Neck].position,
            performer.at(-99 * kPerformerStep)[JointId::Neck].position);
}

}  // namespace
}  // namespace chorus::synthetic
