// What another tracker saw of a marker, aligned with what we saw of the person.
#include "common/alignment/trajectory_alignment.h"

#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/alignment/clock_search.h"
#include "common/base/units.h"
#include "common/geometry/rotation.h"

namespace chorus::alignment {
namespace {

using ::testing::HasSubstr;

/// How the other tracker stands to ours.
struct Truth {
  double yaw = deg(40);
  Eigen::Vector3d place{1.5, 0.02, -0.8};
  double clock = 0.237;  ///< Added to its stamps [s].
  Eigen::Vector3d marker = Eigen::Vector3d::Zero();
  double noise = 0.01;
  double length = 40.0;
};

Eigen::Vector3d walked(double t) {
  return {1.2 * std::sin(0.53 * t) + 0.3 * std::sin(1.7 * t), 1.65 + 0.02 * std::sin(9.0 * t),
          1.1 * std::sin(0.71 * t + 1.0) + 0.2 * std::cos(2.1 * t)};
}

/// The person looks where they go.
Eigen::Quaterniond turned(double t) {
  const Eigen::Vector3d ahead = walked(t + 0.05) - walked(t - 0.05);
  return about_y(std::atan2(ahead.x(), ahead.z()));
}

struct Traces {
  Trace ours;
  Trace reference;
};

/// The reference at 100 Hz, its marker on the person; ours at 30 Hz, 10 s later begun.
Traces traces_of(const Truth& truth, bool poses, bool body_axes) {
  std::mt19937_64 engine(7);
  std::normal_distribution<double> gauss(0.0, truth.noise);
  Eigen::Isometry3d ours_from_reference = Eigen::Isometry3d::Identity();
  ours_from_reference.linear() = about_y(truth.yaw).toRotationMatrix();
  ours_from_reference.translation() = truth.place;
  const Eigen::Isometry3d reference_from_ours = ours_from_reference.inverse();
  Traces out;
  for (double t = 0.0; t < truth.length + 20.0; t += 0.01) {
    const Eigen::Vector3d marker = walked(t) - turned(t) * truth.marker;
    TracePoint point{t - truth.clock, reference_from_ours * marker, {}};
    if (poses) point.axes = Eigen::Quaterniond(reference_from_ours.linear()) * turned(t);
    out.reference.push_back(point);
  }
  for (double t = 10.0; t < 10.0 + truth.length; t += 1.0 / 30.0) {
    const Eigen::Vector3d noise(gauss(engine), gauss(engine), gauss(engine));
    TracePoint point{t, walked(t) + noise, {}};
    if (body_axes) point.axes = turned(t);
    out.ours.push_back(point);
  }
  return out;
}

void expect_found(const Alignment& found, const Truth& truth) {
  EXPECT_NEAR(to_deg(yaw_of(found.ours_from_reference.linear())), to_deg(truth.yaw), 0.15);
  EXPECT_LT((found.ours_from_reference.translation() - truth.place).norm(), 0.006);
  EXPECT_NEAR(found.clock_offset, truth.clock, 0.003);
}

TEST(Alignment, FindsWorldAndClock) {
  const Truth truth;
  const auto [ours, reference] = traces_of(truth, false, false);
  const auto found = align_traces(ours, reference);
  ASSERT_TRUE(found) << to_string(found.error());
  expect_found(*found, truth);
  EXPECT_FALSE(found->marker_offset);
  EXPECT_LT(found->yaw_sigma, deg(0.1));
  EXPECT_GT(found->yaw_sigma, deg(0.005));
}

TEST(Alignment, FindsAnyClockWithoutUtc) {
  Truth truth;
  truth.clock = 1234.5;
  const auto [ours, reference] = traces_of(truth, false, false);
  AlignmentConfig config;
  EXPECT_EQ(align_traces(ours, reference, config).error().code, ErrorCode::NotFound);
  config.clock_range.reset();
  const auto found = align_traces(ours, reference, config);
  ASSERT_TRUE(found) << to_string(found.error());
  expect_found(*found, truth);
}

TEST(Alignment, OutliersDoNotPull) {
  const Truth truth;
  auto [ours, reference] = traces_of(truth, false, false);
  for (std::size_t i = 0; i < ours.size(); ++i) {
    if (i / 60 % 5 == 0) ours[i].place += Eigen::Vector3d(0.4, 0.0, 0.3);
  }
  const auto found = align_traces(ours, reference);
  ASSERT_TRUE(found) << to_string(found.error());
  expect_found(*found, truth);
}

TEST(Alignment, FindsWhereTheMarkerSits) {
  Truth truth;
  truth.marker = {0.03, 0.0, -0.12};
  for (const bool poses : {true, false}) {
    const auto [ours, reference] = traces_of(truth, poses, true);
    AlignmentConfig config;
    config.marker_offset = true;
    const auto found = align_traces(ours, reference, config);
    ASSERT_TRUE(found) << to_string(found.error());
    expect_found(*found, truth);
    ASSERT_TRUE(found->marker_offset);
    EXPECT_NEAR(found->marker_offset->x(), truth.marker.x(), 0.005) << poses;
    EXPECT_NEAR(found->marker_offset->z(), truth.marker.z(), 0.005) << poses;
  }
}

TEST(Alignment, FindsATiltIfAllowed) {
  const Truth truth;
  auto [ours, reference] = traces_of(truth, false, false);
  const Eigen::Quaterniond tilt(Eigen::AngleAxisd(deg(3), Eigen::Vector3d::UnitX()));
  for (TracePoint& point : reference) point.place = tilt * point.place;
  AlignmentConfig config;
  config.full = true;
  const auto found = align_traces(ours, reference, config);
  ASSERT_TRUE(found) << to_string(found.error());
  const double tilted = std::acos(found->ours_from_reference.linear()(1, 1));
  EXPECT_NEAR(to_deg(tilted), 3.0, 0.3);
}

TEST(Alignment, AnotherMotionIsRefused) {
  auto [ours, reference] = traces_of({}, false, false);
  for (TracePoint& point : reference)
    point.place = {std::sin(0.9 * point.time), 1.6, std::cos(1.3 * point.time)};
  EXPECT_FALSE(align_traces(ours, reference));
}

TEST(Alignment, OtherUnitsAreNamed) {
  auto [ours, reference] = traces_of({}, false, false);
  for (TracePoint& point : reference) point.place *= 1000.0;
  const auto found = align_traces(ours, reference);
  ASSERT_FALSE(found);
  EXPECT_THAT(found.error().message, HasSubstr("moves 100"));
}

TEST(Alignment, ACircleDoesNotTellTheClocks) {
  Traces circle;
  for (double t = 0.0; t < 40.0; t += 0.02) {
    const Eigen::Vector3d place(std::sin(t), 1.6, std::cos(t));
    circle.reference.push_back({t, place, {}});
    circle.ours.push_back({t, place, {}});
  }
  const auto found = align_traces(circle.ours, circle.reference);
  ASSERT_FALSE(found);
  EXPECT_THAT(found.error().message,
              ::testing::AnyOf(HasSubstr("walk another way"), HasSubstr("not only in a circle")));
}

TEST(Alignment, WhoStandsTellsNothing) {
  Traces rest;
  for (double t = 0.0; t < 40.0; t += 0.02) {
    rest.reference.push_back({t, {0.01 * std::sin(t), 1.6, 0.01 * std::cos(3 * t)}, {}});
    rest.ours.push_back(rest.reference.back());
  }
  EXPECT_FALSE(align_traces(rest.ours, rest.reference));
}

TEST(Alignment, OfNothingIsAnError) {
  EXPECT_FALSE(align_traces({}, {}));
  const auto [ours, reference] = traces_of({}, false, false);
  EXPECT_FALSE(align_traces(ours, {}));
  EXPECT_FALSE(align_traces({}, reference));
}

}  // namespace
}  // namespace chorus::alignment
