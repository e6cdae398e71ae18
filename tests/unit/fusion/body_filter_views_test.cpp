// One body over time, while views come and go and frames are many or few.
#include "fusion-server/fusion/body_filter.h"

#include <gtest/gtest.h>

#include "tests/unit/fusion/body_room.h"

namespace chorus::fusion {
namespace {

using body_room::kFilterSteps;
using body_room::kSensors;
using body_room::kStart;
using body_room::Room;
using body_room::standing;
using body_room::view_of;
using enum JointId;

/// A still person's shoulders waver by a degree from frame to frame; sensor 2 is wrong about the
/// wrist and falls silent.
TEST(BodyFilterViews, NoiseTurnsNobodyHoweverManyFramesThereAre) {
  const auto left_after = [](int rate) {
    Room room;
    room.config.body.bone = 0.0;
    room.config.body.resting = 0.0;
    room.config.body.bias_memory = std::chrono::seconds(10);
    room.config.body.handover = Duration{0};
    const auto frame = [&](int i) {
      auto body = standing();
      for (const JointId id : {ShoulderLeft, ShoulderRight}) {
        body[id].position = about_y(deg(i % 2 == 0 ? 0.5 : -0.5)) * body[id].position;
      }
      auto wrong = body;
      wrong[WristLeft].position.y() += 0.04;
      std::vector<SensorView> views{view_of(1, body), view_of(3, body)};
      if (i < 2 * rate) views.push_back(view_of(2, wrong));
      return room.memory.fuse({{PersonId{1}, std::move(views)}},
                              {kStart + from_seconds(double(i) / rate), kSensors}, room.config)[0];
    };
    for (int i = 0; i < 2 * rate; ++i) (void)frame(i);
    return frame(2 * rate).skeleton[WristLeft].position.y() - standing()[WristLeft].position.y();
  };
  const double usual = left_after(30);
  EXPECT_GT(usual, 0.005);
  EXPECT_NEAR(left_after(15), usual, 0.1 * usual);
  EXPECT_NEAR(left_after(60), usual, 0.1 * usual);
}

/// Somebody stands still and faces any way; sensor 2 is wrong about the wrist and falls silent.
TEST(BodyFilterViews, WhoStandsStillIsNotTurningWhicheverWayTheyFace) {
  const auto left_after = [](double heading) {
    Room room;
    room.config.body.bone = 0.0;
    room.config.body.resting = 0.0;
    room.config.body.handover = Duration{0};
    auto exact = standing();
    for (Joint& joint : exact.joints) joint.position = about_y(heading) * joint.position;
    auto wrong = exact;
    wrong[WristLeft].position.y() += 0.04;
    for (int i = 0; i < kFilterSteps; ++i)
      (void)room.at(i, {view_of(1, exact), view_of(2, wrong), view_of(3, exact)});
    return body_room::wrist_off(room.at(kFilterSteps, {view_of(1, exact), view_of(3, exact)}),
                                exact);
  };
  const double usual = left_after(0.0);
  EXPECT_GT(usual, 0.003) << "something was learned";
  for (const double heading : {60.0, 135.0, -90.0})
    EXPECT_GT(left_after(deg(heading)), 0.8 * usual) << heading;
}

/// Each view is wrong about each joint in a way of its own.
TEST(BodyFilterViews, WhereViewsDisagreeTheBodyIsSaidToErrByMore) {
  const auto variance = [](double error) {
    Room room;
    FusedBody body;
    for (int i = 0; i < kFilterSteps; ++i) {
      std::vector<SensorView> views;
      for (int v = 1; v <= 4; ++v) {
        views.push_back(view_of(v, standing()));
        for (std::size_t j = 0; j < kJointCount; ++j) {
          const double phase = 7.0 * v + 2.0 * static_cast<double>(j) + 1.3 * i;
          views.back().skeleton.joints[j].position +=
              error *
              Eigen::Vector3d(std::sin(phase), std::cos(2.1 * phase), std::sin(3.3 * phase));
        }
      }
      body = room.at(i, views);
    }
    return body.variance[index_of(SpineMid)];
  };
  EXPECT_GT(variance(0.03), 2.5 * variance(0.0));
}

TEST(BodyFilterViews, ASensorThatFallsSilentMovesNobodyAtOnce) {
  const auto step = [](Duration handover) {
    Room room;
    room.config.body.handover = handover;
    const auto exact = standing();
    auto wrong = exact;
    for (Joint& joint : wrong.joints) joint.position.y() += 0.05;
    FusedBody before;
    for (int i = 0; i < kFilterSteps; ++i)
      before = room.at(i, {view_of(1, exact), view_of(2, wrong)});
    const FusedBody after = room.at(kFilterSteps, {view_of(1, exact)});
    return (after.skeleton[WristLeft].position - before.skeleton[WristLeft].position).norm();
  };
  EXPECT_LT(step(FusionConfig{}.body.handover), 0.5 * step(Duration{0}));
}

/// Four sensors each err about a foot in their own way, within a tenth of a second; one of them
/// falls silent.  Its step is the largest difference between the foot's way from one instant to the
/// next and the same way had the sensor gone on, within a second.
TEST(BodyFilterViews, ASensorThatFallsSilentMovesNoFootBySteps) {
  auto exact = standing();
  for (const JointId foot : {FootLeft, FootRight}) {
    exact[foot] = exact[foot == FootLeft ? AnkleLeft : AnkleRight];
    exact[foot].position += Eigen::Vector3d(0.0, -0.06, 0.13);
  }
  const auto feet = [&](double limb_end, int falls_silent) {
    Room room;
    room.config.body.limb_end = limb_end;
    std::vector<Eigen::Vector3d> places;
    for (int i = 0; i < kFilterSteps + 30; ++i) {
      std::vector<SensorView> views;
      for (int v = 1; v <= (i < falls_silent ? 4 : 3); ++v) {
        views.push_back(view_of(v, exact));
        const double phase = 7.0 * v + 0.7 * i;
        views.back().skeleton[FootLeft].position +=
            0.05 * Eigen::Vector3d(std::sin(phase), 0.5 * std::cos(2.1 * phase), std::cos(phase));
      }
      places.push_back(room.at(i, views).skeleton[FootLeft].position);
    }
    return places;
  };
  const auto step = [&](double limb_end) {
    const auto silent = feet(limb_end, kFilterSteps);
    const auto living = feet(limb_end, 2 * kFilterSteps);
    double largest = 0.0;
    for (std::size_t i = kFilterSteps; i < silent.size(); ++i) {
      const Eigen::Vector3d own = silent[i] - silent[i - 1];
      largest = std::max(largest, (own - (living[i] - living[i - 1])).norm());
    }
    return largest;
  };
  EXPECT_LT(step(FusionConfig{}.body.limb_end), 0.012);
  EXPECT_GT(step(0.0), 0.015) << "the case would not be worth testing";
}

TEST(BodyFilterViews, NobodyIsSurerOfAPersonWhomNobodySees) {
  Room room;
  double before = room.settled(standing()).variance[index_of(WristLeft)];
  for (int i = 1; i <= 20; ++i) {
    const FusedBody body = room.at(kFilterSteps + i, {});
    EXPECT_GT(body.variance[index_of(WristLeft)], before) << "after " << i << " frames";
    before = body.variance[index_of(WristLeft)];
  }
}

TEST(BodyFilterViews, ABoneAloneMakesALostJointHardlySurer) {
  Room room;
  const auto exact = standing();
  auto without = exact;
  without[WristLeft] = {};
  const double seen = room.settled(exact).variance[index_of(WristLeft)];
  const FusedBody lost = room.all_see(kFilterSteps + 1, without);
  EXPECT_GT(lost.variance[index_of(WristLeft)], 0.9 * seen) << "its bone was not seen longer";
}

/// Sensors on both sides of a person turn the arms alike, so that no comparison shows it.
TEST(BodyFilterViews, OfSomebodySeenFromTheSidesAloneArmsMayBeTurned) {
  const auto ahead_variance = [](const std::vector<int>& sensors) {
    Room room;
    FusedBody body;
    for (int i = 0; i < 10; ++i) {
      std::vector<SensorView> views;
      for (const int number : sensors) views.push_back(view_of(number, standing()));
      body = room.at(i, std::move(views));
    }
    return body.skeleton[WristLeft].covariance.matrix()(2, 2);
  };
  const double frontal = ahead_variance({1, 3});
  EXPECT_GT(ahead_variance({2, 4}), 2.0 * frontal);
  EXPECT_LT(ahead_variance({1, 2, 4}), 1.5 * frontal);
}

TEST(BodyFilterViews, SomebodyUnseenIsSaidToBeAnywhereSoon) {
  Room room;
  const double seen = room.settled(standing()).variance[index_of(SpineMid)];
  FusedBody body;
  for (int i = 1; i <= 15; ++i) body = room.at(kFilterSteps + i, {});
  EXPECT_GT(body.variance[index_of(SpineMid)], 10.0 * seen);
}

TEST(BodyFilterViews, AViewThatClaimsToBePerfectDoesNotOutvoteThreeOthers) {
  Room room;
  const Skeleton<WorldSpace> truth = standing();
  SensorView liar = view_of(4, truth);
  for (Joint& joint : liar.skeleton.joints) {
    if (!joint.seen()) continue;
    joint.position.x() += 0.25;
    joint.covariance = Covariance(Eigen::Matrix3d(1e-12 * Eigen::Matrix3d::Identity()));
  }
  FusedBody body;
  for (int step = 0; step < 30; ++step)
    body = room.at(step, {view_of(1, truth), view_of(2, truth), view_of(3, truth), liar});
  for (const JointId id : kCoreJoints)
    EXPECT_LT((body.skeleton[id].position - truth[id].position).norm(), 0.03) << name_of(id);
}

}  // namespace
}  // namespace chorus::fusion
