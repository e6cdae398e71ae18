// Scenes, reach and view.
#include <gtest/gtest.h>

#include "common/base/units.h"
#include "common/geometry/rotation.h"
#include "common/workplace/reach.h"
#include "common/workplace/view.h"
#include "tests/support/builders.h"

namespace chorus::workplace {
namespace {

using chorus::testing::standing_person;
using Eigen::Vector3d;
using ::testing::HasSubstr;
using enum JointId;

constexpr auto kGarage = R"({
  "title": "Garage",
  "points": [{"name": "bolt", "at_m": [0, 1.2, 0.5]}],
  "boxes": [{"name": "car", "centre_m": [0, 0.7, 2], "size_m": [4, 1.4, 1.6], "obstacle": true},
            {"name": "panel", "centre_m": [0, 1.5, 4], "size_m": [0.4, 0.3, 0.1]}],
  "props": [{"name": "driver"}],
  "held": [{"prop": "driver", "from_s": 2, "to_s": 5, "person": 3}],
  "view_deg": 25
})";

Scene garage() { return read_scene(kGarage, "garage.json").value(); }

std::string trouble(const std::string& text) {
  const auto scene = read_scene(text, "s");
  return scene ? "" : to_string(scene.error());
}

TEST(AScene, IsReadAndItsMistakesAreTold) {
  const Scene scene = garage();
  EXPECT_EQ(scene.points.front().name, "bolt");
  EXPECT_TRUE(scene.boxes[0].obstacle);
  EXPECT_EQ(scene.held[0].person, 3u);
  EXPECT_NEAR(scene.view, deg(25), 1e-9);
  EXPECT_THAT(trouble(R"({"points": [{"at_m": [0, 1]}]})"), HasSubstr("three numbers"));
  EXPECT_THAT(trouble(R"({"boxes": [{"name": "a", "centre_m": [0,0,0], "size_m": [1,0,1]}]})"),
              HasSubstr("above zero"));
  EXPECT_THAT(trouble(R"({"held": [{"prop": "saw", "from_s": 0, "to_s": 1}]})"),
              HasSubstr("none of the props"));
  EXPECT_THAT(
      trouble(R"({"props": [{"name": "a"}], "held": [{"prop": "a", "from_s": 2, "to_s": 1}]})"),
      HasSubstr("later"));
  EXPECT_THAT(trouble(R"({"point": []})"), HasSubstr("points"));
}

TEST(ABox, IsEnteredWhereALineMeetsIt) {
  const SceneBox box{"b", {0, 1, 2}, {2, 2, 1}, 0.0, true};
  EXPECT_NEAR(*entered(box, {0, 1, 0}, {0, 1, 3}), 0.5, 1e-9);
  EXPECT_FALSE(entered(box, {0, 1, 0}, {0, 1, 1.4}));
  EXPECT_FALSE(entered(box, {1.1, 1, 0}, {1.1, 1, 3}));
  EXPECT_EQ(*entered(box, {0, 1, 2}, {0, 1, 9}), 0.0);
  const SceneBox turned{"b", {0, 1, 2}, {2, 2, 1}, deg(90), true};
  EXPECT_NEAR(*entered(turned, {0, 1, 0}, {0, 1, 4}), 0.25, 1e-9);
}

TEST(AnObstacle, HidesWhatIsBehindItButNotWhatIsOnIt) {
  const Scene scene = garage();
  EXPECT_EQ(obstacle_between(scene, {0, 1.2, 0}, {0, 1.2, 3.5}), "car");
  EXPECT_EQ(obstacle_between(scene, {0, 1.2, 0}, {0, 1.2, 1.2}), "");  // on its side
  EXPECT_EQ(obstacle_between(scene, {0, 1.6, 0}, {0, 1.6, 9}), "");    // over it, through the panel
}

TEST(Reach, EndsWithTheArmAndGoesFartherLeaning) {
  const Skeleton<WorldSpace> body = standing_person({0, 0, 0});
  const Vector3d shoulder = body[ShoulderRight].position;
  const double arm = (body[ElbowRight].position - shoulder).norm() +
                     (body[WristRight].position - body[ElbowRight].position).norm() +
                     kGripBeyondWrist;
  const Arm right{body, false, nullptr};
  const Reach near = reach_of(right, shoulder + Vector3d(0, 0, arm - 0.05), {});
  ASSERT_TRUE(near.known);
  EXPECT_NEAR(near.arm.missing, -0.05, 1e-9);
  EXPECT_EQ(near.arm.probability, 1.0);
  const Reach far = reach_of(right, shoulder + Vector3d(0, 0, arm + 0.2), {});
  EXPECT_NEAR(far.arm.missing, 0.2, 1e-9);
  EXPECT_EQ(far.arm.probability, 0.0);
  EXPECT_LT(far.leaning.missing, -0.05);
  EXPECT_EQ(far.leaning.probability, 1.0);
}

TEST(Reach, IsAsSureAsTheJointsAre) {
  Skeleton<WorldSpace> body = standing_person({0, 0, 0});
  for (Joint& joint : body.joints)
    joint.covariance = Covariance(Eigen::Matrix3d(9e-4 * Eigen::Matrix3d::Identity()));
  const Vector3d shoulder = body[ShoulderRight].position;
  BoneLengthOf bones;
  bones[index_of(ElbowRight)] = {0.30, 0.01};
  bones[index_of(WristRight)] = {0.25, 0.01};
  const Reach reach = reach_of({body, false, &bones}, shoulder + Vector3d(0, 0, 0.63 + 0.03), {});
  EXPECT_NEAR(reach.arm.missing, 0.03, 1e-9);
  EXPECT_NEAR(reach.arm.sigma, std::sqrt(9e-4 + 2e-4), 1e-9);
  EXPECT_NEAR(reach.arm.probability, 0.183, 0.002);  // one-sided, 0.905 standard deviations
}

TEST(Reach, IsUnknownWithoutTheArmAndSaysWhatIsInTheWay) {
  Skeleton<WorldSpace> body = standing_person({0, 0, 0});
  EXPECT_EQ(reach_of({body, false, nullptr}, {0, 1.2, 3.5}, garage()).blocked_by, "car");
  EXPECT_FALSE(reach_of({body, false, nullptr}, {0, std::nan(""), 0}, {}).known);
  body[WristRight].state = JointState::NotTracked;
  EXPECT_FALSE(reach_of({body, false, nullptr}, {0, 1.2, 0.5}, {}).known);
  EXPECT_TRUE(reach_of({body, true, nullptr}, {0, 1.2, 0.5}, {}).known);
}

TEST(View, IsTheHeadsWhereItIsKnownAndElseTheShoulders) {
  Skeleton<WorldSpace> body = standing_person({0, 0, 0});
  const Vector3d head = body[Head].position;
  const Vector3d ahead = (body[ShoulderLeft].position - body[ShoulderRight].position)
                             .normalized()
                             .cross(Vector3d::UnitY());
  const Gaze assumed = gaze_of(body);
  ASSERT_TRUE(assumed.known && assumed.assumed);
  EXPECT_GT(assumed.direction.dot(ahead), 0.99);
  body[Head].orientation = about_y(deg(40));
  const Gaze known = gaze_of(body, Covariance(Eigen::Matrix3d(0.01 * Eigen::Matrix3d::Identity())));
  ASSERT_TRUE(known.known);
  EXPECT_FALSE(known.assumed);
  EXPECT_NEAR(known.sigma, 0.1, 1e-6);
  const Vector3d looked = about_y(deg(40)) * Vector3d::UnitZ();
  EXPECT_NEAR(sight_of(known, head + 2.0 * looked, {}).angle, 0.0, 1e-6);
  EXPECT_GT(sight_of(known, head + 2.0 * looked, {}).probability, 0.99);
  EXPECT_NEAR(sight_of(known, head + about_y(deg(30)) * looked, {}).probability, 0.5, 1e-3);
  EXPECT_LT(sight_of(known, head - looked, {}).probability, 1e-3);
  body[Head].state = JointState::NotTracked;
  EXPECT_FALSE(gaze_of(body).known);
}

TEST(View, SaysWhatHidesAThing) {
  Skeleton<WorldSpace> body = standing_person({0, 0, 0});
  body[Head].orientation = Eigen::Quaterniond::Identity();
  EXPECT_EQ(sight_of(gaze_of(body), {0, 0.3, 3.5}, garage()).hidden_by, "car");
}

}  // namespace
}  // namespace chorus::workplace
