// The three workplaces of Otto et al., section 8, as they are shipped: the antenna on the roof is a
// question of reach, screwing one of posture, the battery one of stress.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/base/file.h"
#include "common/base/units.h"
#include "common/ergonomics/all_methods.h"
#include "common/ergonomics/live.h"
#include "common/ergonomics/task.h"
#include "common/workplace/held_prop.h"
#include "common/workplace/reach.h"
#include "common/workplace/scene.h"
#include "services/ergonomics/workplace_nodes.h"
#include "tests/support/builders.h"

namespace chorus::ergonomics_service {
namespace {

using chorus::testing::kFrameInterval;
using chorus::testing::kStart;
using Eigen::Vector3d;
using enum JointId;

constexpr double kAtTheCar = -std::numbers::pi / 2.0;  // faces -x, the car

std::string shipped(const std::string& name) {
  const auto text = read_file("deploy/workplaces/" + name, 100'000);
  EXPECT_TRUE(text) << to_string(text.error());
  return text.value_or("");
}

workplace::Scene scene_of(const std::string& name) {
  const auto scene = workplace::read_scene(shipped(name), name);
  EXPECT_TRUE(scene) << to_string(scene.error());
  return scene.value_or(workplace::Scene{});
}

ergonomics::Asked task_of(const std::string& name) {
  const auto task = ergonomics::read_task(shipped(name), name);
  EXPECT_TRUE(task) << to_string(task.error());
  return task.value_or(ergonomics::Task{}).asked_at(0.0);
}

/// Turns everything above the hips forward.
Skeleton<WorldSpace> bent(Skeleton<WorldSpace> body, double angle) {
  const Vector3d hips = 0.5 * (body[HipLeft].position + body[HipRight].position);
  const Vector3d axis = (body[HipLeft].position - body[HipRight].position).normalized();
  const Eigen::AngleAxisd turn(angle, axis);
  constexpr std::array kLegs{HipLeft,  KneeLeft,  AnkleLeft,  FootLeft, SpineBase,
                             HipRight, KneeRight, AnkleRight, FootRight};
  for (std::size_t j = 0; j < kJointCount; ++j) {
    if (std::ranges::find(kLegs, static_cast<JointId>(j)) != kLegs.end()) continue;
    body.joints[j].position = hips + turn * (body.joints[j].position - hips);
  }
  return body;
}

/// Upper arm and forearm straight at a point, as far as they go.
void point_arm(Skeleton<WorldSpace>& body, bool left, const Vector3d& at) {
  const Vector3d shoulder = body[left ? ShoulderLeft : ShoulderRight].position;
  const Vector3d way = (at - shoulder).normalized();
  const std::array chain{left ? ElbowLeft : ElbowRight, left ? WristLeft : WristRight,
                         left ? HandLeft : HandRight};
  Vector3d before = shoulder;
  Vector3d placed = shoulder;
  for (const JointId id : chain) {
    const double length = (body[id].position - before).norm();
    before = body[id].position;
    placed += length * way;
    body[id].position = placed;
  }
}

ergonomics::DoubtfulScore scored(const ergonomics::Method& method, Skeleton<WorldSpace> body,
                                 const ergonomics::Asked& asked) {
  for (Joint& joint : body.joints)
    joint.covariance = Covariance(Eigen::Matrix3d(1e-4 * Eigen::Matrix3d::Identity()));
  ergonomics::Observer observer;
  ergonomics::Observation seen;
  for (int i = 0; i < 45; ++i) seen = observer.observe({kStart + i * kFrameInterval, body});
  return score_of(method, seen, asked);
}

TEST(Antenna, IsReachedLeaningFromTheSideOfTheCarOnly) {
  const workplace::Scene scene = scene_of("antenna.json");
  const auto reach = [&](double x, std::size_t point) {
    return reach_of({chorus::testing::standing_person({x, 0, -1.2}, kAtTheCar), false, nullptr},
                    scene.points[point].at, scene);
  };
  const auto near = reach(1.05, 0);
  ASSERT_TRUE(near.known);
  EXPECT_GT(near.arm.missing, 0.0) << "upright it is too far";
  EXPECT_LT(near.leaning.missing, 0.0) << "leaning over the roof it is not";
  EXPECT_GT(reach(1.7, 0).leaning.missing, 0.0) << "from a step away it is";
  EXPECT_GT(reach(1.05, 1).leaning.missing, 0.0) << "and the far side always";
}

TEST(Screwing, IsAQuestionOfPosture) {
  const workplace::Scene scene = scene_of("screwing.json");
  const ergonomics::Asked asked = task_of("screwing.task.json");
  const auto upright = chorus::testing::standing_person({1.5, 0, 0.4}, kAtTheCar);
  auto working = bent(upright, deg(75));
  point_arm(working, false, scene.points[0].at);
  const auto standing = scored(ergonomics::kReba, upright, asked);
  const auto screwing = scored(ergonomics::kReba, working, asked);
  ASSERT_TRUE(standing.known() && screwing.known());
  EXPECT_GE(screwing.score.low, standing.score.high + 3);
  EXPECT_GE(screwing.score.low, 4) << "medium at least: action necessary";
  workplace::HeldProp driver(scene.props.front());
  const auto tip = driver.follow(kStart, working);
  ASSERT_TRUE(tip);
  const Vector3d hand = working[HandRight].position;
  const Vector3d way = (scene.points[0].at - working[ShoulderRight].position).normalized();
  EXPECT_LT((tip->world_from_prop.translation() - hand - 0.2 * way).norm(), 1e-6);
}

TEST(Battery, IsAQuestionOfStress) {
  const workplace::Scene scene = scene_of("battery.json");
  ergonomics::Asked asked = task_of("battery.task.json");
  auto body = bent(chorus::testing::standing_person({0.3, 0, 2.7}, std::numbers::pi), deg(30));
  for (const bool left : {true, false})
    point_arm(body, left, scene.points[1].at + Vector3d(left ? -0.14 : 0.14, 0, 0));
  const auto loaded = scored(ergonomics::kReba, body, asked);
  asked.load_kg = 0.0;
  const auto empty = scored(ergonomics::kReba, body, asked);
  ASSERT_TRUE(loaded.known() && empty.known());
  EXPECT_GT(loaded.score.high, empty.score.high);
  workplace::HeldProp battery(scene.props.front());
  const auto held = battery.follow(kStart, body);
  ASSERT_TRUE(held);
  EXPECT_NEAR(held->world_from_prop.linear()(1, 1), 1.0, 1e-9) << "it is carried level";
  const auto reach = reach_of({body, false, nullptr}, scene.points[1].at, scene);
  EXPECT_LT(reach.leaning.missing, 0.0);
  EXPECT_EQ(reach.blocked_by, "");
  const auto behind = reach_of({body, false, nullptr}, {0.3, 0.5, -1.0}, scene);
  EXPECT_EQ(behind.blocked_by, "cabin") << "the car is in the way";
}

TEST(AWorkplace, AndASizeUseOnlyDeclaredTerms) {
  resource::BodyResource body;
  body.id = 3;
  body.captured = kStart;
  body.stature = 1.75;
  body.stature_sigma = 0.05;
  const auto person = chorus::testing::standing_person({1.05, 0, -1.2}, kAtTheCar);
  for (std::size_t j = 0; j < kJointCount; ++j) {
    static_cast<Joint&>(body.joints[j]) = person.joints[j];
    body.joints[j].bone_length = 0.3;
    body.joints[j].bone_sigma = 0.01;
  }
  const auto view = workplace_node(body, scene_of("antenna.json"));
  EXPECT_EQ(resource::undeclared_terms(view), std::vector<std::string>{});
  const auto size = size_node(body, 82.0);
  EXPECT_EQ(resource::undeclared_terms(size), std::vector<std::string>{});
  const std::string text = resource::write(size, resource::Format::Json);
  EXPECT_THAT(text, ::testing::HasSubstr("leftUpperArm"));
  EXPECT_THAT(text, ::testing::HasSubstr("\"weightKg\": 82"));
  const std::string seen = resource::write(view, resource::Format::Json);
  EXPECT_THAT(seen, ::testing::HasSubstr("leaningProbability"));
  EXPECT_THAT(seen, ::testing::HasSubstr("instructions"));
}

}  // namespace
}  // namespace chorus::ergonomics_service
