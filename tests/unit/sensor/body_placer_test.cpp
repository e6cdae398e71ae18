// Bone lengths of each person, learned over images, and people placed with them.
#include "common/sensor/body_placer.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace chorus {
namespace {

using Body = Skeleton<SensorSpace>;
using Eigen::Vector3d;

/// A person with spread arms and legs, `size` times as large.
Body person(double size) {
  Body body;
  const auto set = [&](JointId id, double x, double y, double z) {
    body[id].position = size * Vector3d(x, y, z);
    body[id].state = JointState::Tracked;
  };
  set(JointId::SpineBase, 0, 0, 0);
  set(JointId::SpineMid, 0, 0.25, 0.03);
  set(JointId::SpineShoulder, 0, 0.5, 0);
  set(JointId::ShoulderLeft, -0.2, 0.5, 0.02);
  set(JointId::ElbowLeft, -0.45, 0.4, -0.1);
  set(JointId::ShoulderRight, 0.2, 0.5, 0);
  set(JointId::ElbowRight, 0.45, 0.45, 0.1);
  set(JointId::HipLeft, -0.1, 0, 0);
  set(JointId::KneeLeft, -0.2, -0.4, -0.1);
  set(JointId::HipRight, 0.1, 0, 0);
  set(JointId::KneeRight, 0.2, -0.4, 0);
  return body;
}

Body rays_at(const Vector3d& place) {
  Body rays = person(1.0);
  for (Joint& joint : rays.joints) {
    if (!joint.seen()) continue;
    joint.position = (joint.position + place).normalized();
    joint.measurement = Measurement::Ray;
  }
  return rays;
}

double length_of(const Body& body, JointId a, JointId b) {
  return (body[a].position - body[b].position).norm();
}

TEST(LearnedBones, LengthsAreMeansAndDirectionsThoseOfTheImage) {
  LearnedBones bones;
  std::mt19937 random(3);
  std::normal_distribution<double> error(0.0, 0.05);
  for (int i = 0; i < 200; ++i) bones.learn(person(1.0 + error(random)));
  Body crouched = person(1.2);
  crouched[JointId::KneeLeft].position =
      crouched[JointId::HipLeft].position - 0.5 * Vector3d::UnitZ();
  const Body out = bones.applied(crouched);
  EXPECT_NEAR(length_of(out, JointId::HipLeft, JointId::KneeLeft),
              length_of(person(1.0), JointId::HipLeft, JointId::KneeLeft), 0.01);
  const Vector3d thigh = out[JointId::KneeLeft].position - out[JointId::HipLeft].position;
  EXPECT_NEAR(thigh.normalized().z(), -1.0, 1e-9);
}

TEST(LearnedBones, AWrongGuessHardlyCounts) {
  LearnedBones bones;
  for (int i = 0; i < 100; ++i) bones.learn(person(1.0 + 0.02 * std::sin(i)));
  const double before = length_of(bones.applied(person(1.0)), JointId::HipLeft, JointId::KneeLeft);
  for (int i = 0; i < 5; ++i) bones.learn(person(3.0));
  const double after = length_of(bones.applied(person(1.0)), JointId::HipLeft, JointId::KneeLeft);
  EXPECT_NEAR(after, before, 0.005);
}

TEST(LearnedBones, WhatWasNeverSeenStays) {
  const Body shape = person(1.0);
  const Body out = LearnedBones().applied(shape);
  for (std::size_t i = 0; i < kJointCount; ++i)
    EXPECT_EQ(out.joints[i].position, shape.joints[i].position);
}

TEST(BodyPlacer, DistancesAreSteadierThanTheModelsGuesses) {
  BodyPlacer placer;
  std::mt19937 random(5);
  std::normal_distribution<double> error(0.0, 0.05);
  double first = 0.0;
  double second = 0.0;
  constexpr int kFrames = 200;
  for (int i = 0; i < kFrames; ++i) {
    std::vector<BodyFrame> bodies{{BodyId{4}, {}, rays_at({0, 0, 3})}};
    const std::vector<Body> shapes{person(1.0 + error(random))};
    placer.place(bodies, shapes, {});
    ASSERT_TRUE(bodies[0].skeleton[JointId::SpineBase].seen());
    const double off = bodies[0].skeleton[JointId::SpineBase].position.z() - 3.0;
    (i < kFrames / 2 ? first : second) += off * off / (kFrames / 2);
  }
  EXPECT_LT(std::sqrt(second), 0.05) << "0.15 without learning";
}

TEST(BodyPlacer, PeopleAreLearnedApart) {
  BodyPlacer placer;
  for (int i = 0; i < 50; ++i) {
    std::vector<BodyFrame> bodies{{BodyId{1}, {}, rays_at({0, 0, 3})},
                                  {BodyId{2}, {}, rays_at({0, 0, 3})}};
    const std::vector<Body> shapes{person(1.0), person(0.8)};
    placer.place(bodies, shapes, {});
    EXPECT_NEAR(bodies[0].skeleton[JointId::SpineBase].position.z(), 3.0, 0.01);
    EXPECT_NEAR(bodies[1].skeleton[JointId::SpineBase].position.z(), 2.4, 0.01);
  }
}

TEST(LearnedBones, AShapeWithoutExtentTeachesNothing) {
  LearnedBones bones;
  bones.learn(person(0.0));
  bones.learn(person(1.0));
  EXPECT_NEAR(length_of(bones.applied(person(1.0)), JointId::HipLeft, JointId::KneeLeft),
              length_of(person(1.0), JointId::HipLeft, JointId::KneeLeft), 1e-9);
}

TEST(LearnedBones, AModelThatStatedTheSameForLongCanChangeItsMind) {
  LearnedBones bones;
  for (int i = 0; i < 20'000; ++i) bones.learn(person(1.0));
  for (int i = 0; i < 3'000; ++i) bones.learn(person(1.1));
  EXPECT_NEAR(length_of(bones.applied(person(1.0)), JointId::HipLeft, JointId::KneeLeft),
              length_of(person(1.1), JointId::HipLeft, JointId::KneeLeft), 0.01);
}

TEST(BodyPlacer, LearnsNothingOfWhatTheCameraDoesNotSee) {
  BodyPlacer placer;
  Body invented = person(1.0);
  invented[JointId::KneeLeft].position *= 2.0;
  Body hidden = rays_at({0, 0, 3});
  hidden[JointId::KneeLeft] = {};
  for (int i = 0; i < 100; ++i) {
    std::vector<BodyFrame> bodies{{BodyId{1}, {}, hidden}};
    placer.place(bodies, std::vector<Body>{invented}, {});
  }
  std::vector<BodyFrame> bodies{{BodyId{1}, {}, rays_at({0, 0, 3})}};
  placer.place(bodies, std::vector<Body>{person(1.0)}, {});
  EXPECT_NEAR(bodies[0].skeleton[JointId::KneeLeft].position.z(), 3.0 - 0.1, 0.04);
}

TEST(BodyPlacer, WithoutAShapeThereAreRays) {
  BodyPlacer placer;
  std::vector<BodyFrame> bodies{{BodyId{1}, {}, rays_at({0, 0, 3})}};
  placer.place(bodies, std::vector<Body>(1), {});
  EXPECT_TRUE(bodies[0].skeleton[JointId::SpineBase].bears());
  EXPECT_EQ(placer.remembered(), 0u);
}

TEST(BodyPlacer, MemoryIsBounded) {
  BodyPlacer placer;
  for (std::uint64_t i = 0; i < 1000; ++i) {
    std::vector<BodyFrame> bodies{{BodyId{i}, {}, rays_at({0, 0, 3})}};
    placer.place(bodies, std::vector<Body>{person(1.0)}, {});
  }
  EXPECT_LE(placer.remembered(), 256u);
  for (int i = 0; i < 2000; ++i) placer.place({}, {}, {});
  EXPECT_EQ(placer.remembered(), 0u);
}

}  // namespace
}  // namespace chorus
