#include "common/assessment/at_workplace.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/support/builders.h"

namespace chorus::assessment {
namespace {

using chorus::testing::kFrameInterval;
using chorus::testing::kStart;
using enum JointId;

/// Walks along +x for two seconds, with the last half second unseen.
std::vector<ergonomics::BodyAt> walked() {
  std::vector<ergonomics::BodyAt> bodies;
  for (int i = 0; i < 60; ++i) {
    ergonomics::BodyAt body{kStart + i * kFrameInterval,
                            chorus::testing::standing_person({0.02 * i, 0, 0})};
    body.carried = i >= 45;
    bodies.push_back(std::move(body));
  }
  return bodies;
}

TEST(AtAWorkplace, ReachViewAndThingsInHandsAreSummedUp) {
  const auto scene = workplace::read_scene(R"({
      "points": [{"name": "near", "at_m": [0.4, 1.2, 0.3]}, {"name": "far", "at_m": [0, 1, 9]}],
      "props": [{"name": "driver"}],
      "held": [{"prop": "driver", "from_s": 0.5, "to_s": 1.0},
               {"prop": "driver", "from_s": 1.2, "to_s": 1.3, "person": 9}]})",
                                           "scene")
                         .value();
  const auto bodies = walked();
  const auto found = at_workplace({3, bodies, kStart}, scene);
  ASSERT_EQ(found.reached.size(), 4u);
  EXPECT_GT(found.reached[0].arm, 0.5);
  EXPECT_EQ(found.reached[2].leaning, 0.0);
  EXPECT_EQ(found.gaze_assumed, 1.0);
  EXPECT_GT(found.seen[1].in_view, 0.5) << "they look along +z";
  ASSERT_EQ(found.props.size(), 1u) << "the other mark is somebody else's";
  ASSERT_GE(found.props[0].places.size(), 15u);
  EXPECT_NEAR(found.props[0].places.front().seconds, 0.5, 0.04);
  EXPECT_NEAR(found.props[0].places.back().seconds, 1.0, 0.04);
  const auto json = workplace_json(found);
  EXPECT_EQ(json["props"][0]["prop"], "driver");
  EXPECT_NEAR(json["props"][0]["putDown"]["metres"][0].get<double>(),
              bodies[30].body[HandRight].position.x(), 0.03);
}

TEST(AtAWorkplace, NobodySeenReachesNothing) {
  const auto scene =
      workplace::read_scene(R"({"points": [{"name": "a", "at_m": [0, 1, 0]}]})", "scene").value();
  const std::vector<ergonomics::BodyAt> none;
  const auto found = at_workplace({3, none, kStart}, scene);
  EXPECT_FALSE(std::isfinite(found.reached[0].nearest));
  EXPECT_FALSE(workplace_json(found)["reach"][0].contains("nearestMetres"));
}

}  // namespace
}  // namespace chorus::assessment
