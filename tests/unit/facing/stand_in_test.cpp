#include "fusion-server/facing/stand_in.h"

#include <gtest/gtest.h>

#include "fusion-server/facing/lateral.h"

namespace chorus::facing {
namespace {

/// Rays to shoulders that are 0.4 m apart along `left`, with their middle at (0, 1.4, 0).
SensorView shoulders(const Eigen::Vector3d& eye, const Eigen::Vector3d& left) {
  SensorView view;
  view.eye = eye;
  for (const auto& [id, sign] :
       {std::pair{JointId::ShoulderLeft, 1.0}, std::pair{JointId::ShoulderRight, -1.0}}) {
    Joint& joint = view.skeleton[id];
    joint.position = (Eigen::Vector3d(0, 1.4, 0) + sign * 0.2 * left - eye).normalized();
    joint.measurement = Measurement::Ray;
    joint.state = JointState::Tracked;
  }
  return view;
}

TEST(StandIn, ShowsTheSpanAcrossTheLineOfSight) {
  Person person{PersonId{1},
                {shoulders({0, 1.4, -3}, {1, 0, 0}), shoulders({0, 1.4, -3}, {0.6, 0, 0.8})}};
  EXPECT_EQ(stand_in(person, {0, 1, 0}).size(), 2u);
  EXPECT_TRUE(spans_of(person.views[0].skeleton)[0].isApprox(Eigen::Vector3d(0.4, 0, 0)));
  const Eigen::Vector3d turned = spans_of(person.views[1].skeleton)[0];
  EXPECT_NEAR(turned.x(), 0.24, 0.01);
  EXPECT_NEAR(turned.z(), 0.0, 1e-9);
}

TEST(StandIn, AndBackGivesTheSameRays) {
  const Person before{PersonId{1}, {shoulders({1, 2, -3}, {1, 0, 0})}};
  Person person = before;
  const auto figures = stand_in(person, {0, 1, 0});
  std::swap(person.views[0].skeleton[JointId::ShoulderLeft],
            person.views[0].skeleton[JointId::ShoulderRight]);
  back_to_rays(person, figures);
  const auto& was = before.views[0].skeleton;
  const auto& is = person.views[0].skeleton;
  EXPECT_TRUE(is[JointId::ShoulderLeft].bears());
  EXPECT_LT((is[JointId::ShoulderLeft].position - was[JointId::ShoulderRight].position).norm(),
            1e-12)
      << "what was exchanged meanwhile stays exchanged";
}

TEST(StandIn, WhatIsSeenFromTheSideKeepsItsSides) {
  const Person before{PersonId{1}, {shoulders({1, 2, -3}, {0, 0, 1})}};
  Person person = before;
  const auto figures = stand_in(person, {0, 1, 0});
  std::swap(person.views[0].skeleton[JointId::ShoulderLeft],
            person.views[0].skeleton[JointId::ShoulderRight]);
  back_to_rays(person, figures);
  EXPECT_EQ(person.views[0].skeleton[JointId::ShoulderLeft].position,
            before.views[0].skeleton[JointId::ShoulderLeft].position);
}

TEST(StandIn, ViewsWithPointsAreLeftAlone) {
  Person person{PersonId{1}, {shoulders({0, 1, -3}, {1, 0, 0})}};
  Joint& head = person.views[0].skeleton[JointId::Head];
  head.position = {0, 1.7, 0};
  head.state = JointState::Tracked;
  EXPECT_TRUE(stand_in(person, {0, 1, 0}).empty());
  EXPECT_TRUE(person.views[0].skeleton[JointId::ShoulderLeft].bears());
}

TEST(StandIn, ACameraInsideThePersonOrLookingAwayGivesNothing) {
  Person person{PersonId{1},
                {shoulders({0, 1, 0.1}, {1, 0, 0}), shoulders({0, 1.4, -3}, {1, 0, 0})}};
  person.views[1].skeleton[JointId::ShoulderLeft].position = {0, 0, -1};
  const auto figures = stand_in(person, {0, 1, 0});
  ASSERT_EQ(figures.size(), 1u);
  EXPECT_EQ(figures[0].view, 1u);
  EXPECT_TRUE(person.views[1].skeleton[JointId::ShoulderLeft].bears());
  EXPECT_TRUE(person.views[1].skeleton[JointId::ShoulderRight].seen());
}

}  // namespace
}  // namespace chorus::facing
