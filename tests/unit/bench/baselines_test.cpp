#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "common/base/units.h"
#include "fusion-server/fusion/point_filter.h"
#include "tests/bench/methods/averaging.h"
#include "tests/bench/methods/kalman.h"
#include "tests/bench/methods/nearest_neighbour.h"
#include "tests/unit/judge/person_builder.h"

namespace chorus::bench::baselines {
namespace {

using enum JointId;
using fusion::PointFilter;

Person person_of(std::vector<SensorView> views) { return {PersonId{1}, std::move(views)}; }

double x_of(const Body& body, JointId joint) { return body[joint].position.x(); }

TEST(TrackedMean, LeavesGuessesOutWhereSomebodyTracks) {
  auto one = view_of(1, 25, 0, {1, 0, 0});
  auto two = view_of(2, 25, 0, {2, 0, 0});
  auto three = view_of(3, 25, 0, {6, 0, 0});
  three.skeleton[WristLeft] = inferred({6, 0, 0});
  for (auto* view : {&one, &two, &three}) view->skeleton[FootLeft].state = JointState::Inferred;
  const Body body = tracked_mean()(person_of({one, two, three}), at_frame(0));
  EXPECT_NEAR(x_of(body, Neck), 3.0, 1e-12);
  EXPECT_NEAR(x_of(body, WristLeft), 1.5, 1e-12);
  EXPECT_NEAR(x_of(body, FootLeft), 3.0, 1e-12);
}

TEST(Clusters, AreLinkedByStepsAndTheLargestComesFirst) {
  const std::vector<Eigen::Vector3d> points{
      {0, 0, 0}, {1, 0, 0}, {1.09, 0, 0}, {1.18, 0, 0}, {0.05, 0, 0}};
  const auto clusters = clusters_of(points, 0.1);
  ASSERT_EQ(clusters.size(), 2u);
  EXPECT_EQ(clusters[0].size(), 3u);  // a chain: its ends are 0.18 apart
  EXPECT_EQ(clusters[1].size(), 2u);
  EXPECT_TRUE(clusters_of({}, 0.1).empty());
}

TEST(Clusters, OfEqualSizeTheDenserComesFirst) {
  const auto clusters = clusters_of({{0, 0, 0}, {0.09, 0, 0}, {1, 0, 0}, {1.01, 0, 0}}, 0.1);
  ASSERT_EQ(clusters.size(), 2u);
  EXPECT_GE(clusters[0].front(), 2u);
}

TEST(LargestCluster, IsTheMeanOfThoseWhoAgree) {
  const auto person = person_of({view_of(1, 25, 0, {0, 0, 0}), view_of(2, 25, 0, {0.06, 0, 0}),
                                 view_of(3, 25, 0, {0.5, 0, 0})});
  EXPECT_NEAR(x_of(largest_cluster()(person, at_frame(0)), Neck), 0.03, 1e-12);
}

TEST(PointFilter, FirstUpdateIsTheMeasurementAndEqualOnesMeetInTheMiddle) {
  PointFilter filter(3.0);
  EXPECT_FALSE(filter.at(at_frame(0)));
  filter.update(at_frame(0), {1, 0, 0}, 0.01);
  EXPECT_EQ(filter.at(at_frame(0))->x(), 1);
  filter.update(at_frame(0), {3, 0, 0}, 0.01);
  EXPECT_NEAR(filter.at(at_frame(0))->x(), 2, 1e-12);
  EXPECT_NEAR(filter.position_variance(), 0.005, 1e-12);
}

TEST(PointFilter, LearnsAVelocityAndForgetsAfterALongGap) {
  PointFilter filter(3.0);
  for (int i = 0; i < 100; ++i) filter.update(at_frame(i), {0.04 * i, 0, 0}, 1e-4);  // 1 m/s
  EXPECT_NEAR(filter.at(at_frame(99))->x(), 3.96, 1e-3);
  EXPECT_NEAR(filter.at(at_frame(104))->x(), 4.16, 5e-3);
  // Asked for an earlier time, the filter answers with its newest state.
  EXPECT_NEAR(filter.at(at_frame(50))->x(), filter.at(at_frame(99))->x(), 1e-12);
  filter.update(at_frame(200), {9, 0, 0}, 1e-4);
  EXPECT_EQ(filter.at(at_frame(200))->x(), 9);
}

TEST(OttoKalman, IsThePapersWhichPredictsThroughLoss) {
  const auto row = std::ranges::find(all(), "otto-kalman", &Baseline::name);
  ASSERT_NE(row, all().end());
  Method method = row->begin();
  (void)method(person_of({view_of(1, 25, 0)}), at_frame(0));
  EXPECT_TRUE(method(person_of({view_of(1, 3, 0)}), at_frame(1))[WristLeft].seen());
}

SensorFrame frame_of(int number, Duration late, const Eigen::Vector3d& place) {
  SensorFrame frame;
  frame.captured = at_frame(number);
  frame.received = frame.captured + late;
  BodyFrame body{BodyId{7}, frame.captured, {}};
  for (Joint& joint : body.skeleton.joints) joint = tracked(place);
  frame.bodies.push_back(body);
  return frame;
}

TEST(ArrivalKalman, StatesTheTimeOfArrivalSoAWalkerIsWhereHeWas) {
  registration::WalkTrack track{sensor(1), {}};
  const Duration late = std::chrono::milliseconds(100);
  for (int i = 0; i < 200; ++i) track.frames.push_back(frame_of(i, late, {0.04 * i, 0, 2}));
  Registration registration;
  registration.sensors[sensor(1)] = {};
  const auto stated = arrival_kalman({track}, registration);
  ASSERT_GT(stated.size(), 100u);
  const Stated& last = stated.back();
  EXPECT_EQ(last.instant, at_frame(199) + late);
  // The body is reported for an instant 0.1 s after the capture, so it is 100 mm behind the walker.
  EXPECT_NEAR(x_of(last.body, Neck), 0.04 * 199, 0.01);
}

TEST(ArrivalKalman, LeavesOutSensorsWithoutAPlace) {
  const registration::WalkTrack track{sensor(1), {frame_of(0, Duration{0}, {0, 0, 2})}};
  EXPECT_TRUE(arrival_kalman({track}, Registration{}).empty());
}

/// A view of a body whose core stands at (x, z).
SensorView at_place(int number, double x, double z) {
  SensorView view = view_of(number, 25, 0, {x, 1, z});
  view.body = BodyId{static_cast<std::uint64_t>(number)};
  return view;
}

TEST(NearestNeighbour, TakesBodiesOfSeveralSensorsTogetherAndConfirmsAfterThreeInstants) {
  NearestNeighbour neighbour;
  const std::vector<SensorView> views{at_place(1, 0, 0), at_place(2, 0.3, 0), at_place(1, 2, 0)};
  EXPECT_TRUE(neighbour.group(views, at_frame(0)).empty());
  EXPECT_TRUE(neighbour.group(views, at_frame(1)).empty());
  const auto people = neighbour.group(views, at_frame(2));
  ASSERT_EQ(people.size(), 2u);
  EXPECT_EQ(people[0].views.size(), 2u);
  EXPECT_EQ(people[1].views.size(), 1u);
}

TEST(NearestNeighbour, DoesNotPredictSoWhoPassesCloserIsTakenForTheOther) {
  NearestNeighbour neighbour;
  for (int i = 0; i < 3; ++i)
    (void)neighbour.group({at_place(1, 0, 0), at_place(1, 1, 0)}, at_frame(i));
  // One sensor sees one body, which stands just beyond the midpoint between the two people.
  const auto people = neighbour.group({at_place(1, 0.55, 0)}, at_frame(3));
  ASSERT_EQ(people.size(), 1u);
  EXPECT_EQ(people[0].id, PersonId{2});
}

TEST(NearestNeighbour, ForgetsAfterASecondAndNeverGivesAnIdTwice) {
  NearestNeighbour neighbour;
  for (int i = 0; i < 3; ++i) (void)neighbour.group({at_place(1, 0, 0)}, at_frame(i));
  for (int i = 40; i < 42; ++i)
    EXPECT_TRUE(neighbour.group({at_place(1, 0, 0)}, at_frame(i)).empty());
  EXPECT_EQ(neighbour.group({at_place(1, 0, 0)}, at_frame(42)).at(0).id, PersonId{2});
}

TEST(Baselines, HaveDistinctNamesAndAllAnswerForASinglePerfectView) {
  const auto person = person_of({view_of(1, 25, 0, {1, 2, 3})});
  std::vector<std::string_view> names;
  for (const Baseline& baseline : all()) {
    EXPECT_EQ(std::count(names.begin(), names.end(), baseline.name), 0) << baseline.name;
    names.push_back(baseline.name);
    const Body body = baseline.begin()(person, at_frame(0));
    EXPECT_LT((body[Neck].position - Eigen::Vector3d(1, 2, 3)).norm(), 1e-9) << baseline.name;
  }
  EXPECT_EQ(names.size(), 9u);
}

}  // namespace
}  // namespace chorus::bench::baselines
