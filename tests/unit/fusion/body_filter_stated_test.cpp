// One body over time: what is stated of its errors.
#include "fusion-server/fusion/body_filter.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/unit/fusion/body_room.h"

namespace chorus::fusion {
namespace {

using body_room::kFilterSteps;
using body_room::Room;
using body_room::standing;
using body_room::view_of;
using enum JointId;

/// A view of somebody who stands still whose joints are off by `size` [m], each otherwise; the
/// errors do not change.
SensorView wrong_view(int number, double size) {
  SensorView view = view_of(number, standing());
  for (std::size_t j = 0; j < kJointCount; ++j) {
    const auto phase = static_cast<double>(7 * number + 3 * static_cast<int>(j));
    view.skeleton.joints[j].position +=
        size * Eigen::Vector3d(std::sin(phase), std::cos(2 * phase), std::sin(3 * phase));
  }
  return view;
}

FusedBody seen_by(int sensors, double size, double disagreement) {
  Room room;
  room.config.body.disagreement = disagreement;
  FusedBody body;
  for (int i = 0; i < 3 * kFilterSteps; ++i) {
    std::vector<SensorView> views;
    for (int v = 1; v <= sensors; ++v) views.push_back(wrong_view(v, size));
    body = room.at(i, views);
  }
  return body;
}

double elbow_variance(int sensors, double size, double disagreement) {
  return seen_by(sensors, size, disagreement).variance[index_of(ElbowLeft)];
}

TEST(BodyFilterStated, ViewsThatDifferMoreAreSaidToErrByMore) {
  const double start = FusionConfig{}.body.disagreement;
  const double close = elbow_variance(4, 0.01, start);
  EXPECT_GT(elbow_variance(4, 0.04, start), 3.0 * close);
  EXPECT_LT(close, 0.5 * elbow_variance(4, 0.01, 0.0)) << "as configured";
  EXPECT_GT(elbow_variance(4, 0.0, start), 3.9e-3 * 3.9e-3) << "nobody is perfect";
}

/// What a sensor is known to be off by, beside the others, is still an error.
TEST(BodyFilterStated, WhatIsLearnedOfASensorMakesNobodySurer) {
  const auto variance = [](double rate) {
    Room room;
    room.config.body.bias_rate = rate;
    FusedBody body;
    for (int i = 0; i < 3 * kFilterSteps; ++i)
      body = room.at(i, {wrong_view(1, 0.03), wrong_view(2, 0.03), wrong_view(3, 0.03)});
    return body.variance[index_of(ElbowLeft)];
  };
  EXPECT_GT(variance(3.0), 0.9 * variance(0.0));
}

TEST(BodyFilterStated, HowFarViewsDifferMovesNoJoint) {
  const FusedBody asked = seen_by(3, 0.03, FusionConfig{}.body.disagreement);
  const FusedBody unasked = seen_by(3, 0.03, 0.0);
  for (std::size_t j = 0; j < kJointCount; ++j) {
    EXPECT_EQ(asked.skeleton.joints[j].position, unasked.skeleton.joints[j].position) << j;
  }
}

TEST(BodyFilterStated, OneViewIsSaidToErrByMoreThanTwo) {
  const double start = FusionConfig{}.body.disagreement;
  EXPECT_GT(elbow_variance(1, 0.02, start), 2.0 * elbow_variance(2, 0.02, start));
}

/// Sensors that state their covariances are believed, however they differ.
TEST(BodyFilterStated, StatedCovariancesAreNotScaled) {
  const auto variance = [](double disagreement) {
    Room room;
    room.config.body.disagreement = disagreement;
    FusedBody body;
    for (int i = 0; i < kFilterSteps; ++i) {
      std::vector<SensorView> views{wrong_view(1, 0.01), wrong_view(2, 0.01)};
      for (SensorView& view : views) {
        view.skeleton[ElbowLeft].covariance =
            Covariance(Eigen::Matrix3d(4e-4 * Eigen::Matrix3d::Identity()));
      }
      body = room.at(i, views);
    }
    return body.variance[index_of(ElbowLeft)];
  };
  EXPECT_DOUBLE_EQ(variance(0.5), variance(0.0));
}

}  // namespace
}  // namespace chorus::fusion
