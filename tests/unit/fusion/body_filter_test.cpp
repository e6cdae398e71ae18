// One body over time: what it learns, predicts and smooths.
#include "fusion-server/fusion/body_filter.h"

#include <gtest/gtest.h>

#include <cmath>

#include "common/body/bones.h"
#include "common/geometry/rotation.h"
#include "fusion-server/fusion/fuse.h"
#include "tests/unit/fusion/body_room.h"

namespace chorus::fusion {
namespace {

using body_room::kFilterSteps;
using body_room::Room;
using body_room::scaled;
using body_room::standing;
using body_room::turned;
using body_room::view_of;
using body_room::wrist_off;
using enum JointId;

TEST(BodyFilter, WhatAllViewsAgreeOnIsTheBody) {
  Room room;
  const auto exact = standing();
  const FusedBody body = room.settled(exact);
  for (std::size_t j = 0; j < kJointCount; ++j) {
    if (!exact.joints[j].seen()) continue;
    EXPECT_LT((body.skeleton.joints[j].position - exact.joints[j].position).norm(), 1e-4);
    EXPECT_EQ(body.skeleton.joints[j].state, JointState::Tracked);
    EXPECT_EQ(body.contributors[j], 0b1111U);
  }
  EXPECT_EQ(body.skeleton[HandLeft].state, JointState::NotTracked);
}

TEST(BodyFilter, AViewThatIsTooLargeAsAWholeIsShrunk) {
  const auto exact = standing();
  const auto error = [&](double scale) {
    Room room;
    room.config.body.scale = scale;
    const auto two_see = [&](int step, double by) {
      return room.at(step, {view_of(1, exact), view_of(2, scaled(exact, by))});
    };
    for (int i = 0; i < kFilterSteps; ++i) (void)two_see(i, i % 2 == 0 ? 1.06 : 0.94);
    return wrist_off(two_see(kFilterSteps, 1.08), exact);
  };
  EXPECT_LT(error(0.06), 0.5 * error(0.0));
}

/// Cameras that guess depth put everything too far away or too near along their lines of sight,
/// and state that uncertainty.
TEST(BodyFilter, AnUncertainDepthIsNotTakenForAWrongSize) {
  const auto exact = standing();
  const auto guessed = [&](int number) {
    SensorView view = view_of(number, exact);
    for (Joint& joint : view.skeleton.joints) {
      if (!joint.seen()) continue;
      const Eigen::Vector3d way = (joint.position - view.eye).normalized();
      joint.position += (number % 2 == 0 ? 0.3 : -0.2) * way;
      joint.covariance = Covariance(
          Eigen::Matrix3d(6.25e-4 * Eigen::Matrix3d::Identity() + 0.062 * way * way.transpose()));
    }
    return view;
  };
  Room room;
  FusedBody body;
  for (int i = 0; i < 30; ++i) {
    // One joint states no covariance; otherwise points-and-rays, not the body filter, would fuse
    // the person.
    std::vector<SensorView> views{guessed(1), guessed(2), guessed(3), guessed(4)};
    views[0].skeleton[SpineMid].covariance = {};
    body = room.at(i, views);
  }
  EXPECT_LT(wrist_off(body, exact), 0.02);
}

TEST(BodyFilter, AViewThatStaysWrongPullsNoMoreThanAtFirst) {
  const auto exact = standing();
  auto wrong = exact;
  wrong[WristLeft].position += Eigen::Vector3d(0.1, 0.2, 0.2);
  Room room;
  room.config.body.bone = 0.0;
  const auto step = [&](int i) {
    return wrist_off(room.at(i, {view_of(1, exact), view_of(2, exact), view_of(3, wrong)}), exact);
  };
  const double first = step(0);
  double last = 0.0;
  for (int i = 1; i < kFilterSteps; ++i) last = step(i);
  EXPECT_LT(last, 1.2 * first);
}

TEST(BodyFilter, HeldBonesMakeNoPlaceSurer) {
  const auto variance = [](double bone) {
    Room room;
    room.config.body.bone = bone;
    return room.settled(standing()).variance[index_of(WristLeft)];
  };
  EXPECT_NEAR(variance(0.003), variance(0.0), 0.1 * variance(0.0));
}

TEST(BodyFilter, AViewFromTheSideMayHaveTheBodyTurned) {
  const auto exact = standing();
  const auto error = [&](double turn) {
    Room room;
    room.config.body.turn = turn;
    room.config.body.bone = 0.0;
    room.config.body.resting = 0.0;
    const std::vector<SensorView> views{view_of(1, exact), view_of(2, turned(exact, deg(25))),
                                        view_of(3, exact)};
    return wrist_off(room.at(0, views), exact);
  };
  EXPECT_GT(error(0.0), 0.01);
  EXPECT_LT(error(deg(20)), 0.5 * error(0.0));
}

TEST(BodyFilter, ATurnedViewIsDoubtedInAllItsJoints) {
  const auto exact = standing();
  auto wrong = turned(exact, deg(25));
  wrong[Head].position.z() += 0.03;
  const auto head = [&](const Skeleton<WorldSpace>& seen, double doubt) {
    Room room;
    room.config.body.turn_doubt = doubt;
    const FusedBody body = room.at(0, {view_of(1, exact), view_of(2, seen), view_of(3, exact)});
    return (body.skeleton[Head].position - exact[Head].position).norm();
  };
  EXPECT_LT(head(wrong, 0.16), 0.7 * head(wrong, 0.0));
  auto upright = exact;
  upright[Head].position.z() += 0.03;
  EXPECT_NEAR(head(upright, 0.16), head(upright, 0.0), 1e-4);
}

TEST(BodyFilter, BonesHoldAJointAtTheLengthThatWasLearned) {
  const auto exact = standing();
  const auto length_after = [&](double bone) {
    Room room;
    room.config.body.bone = bone;
    room.config.body.resting = 0.0;
    (void)room.settled(exact);
    auto stretched = exact;
    stretched[WristLeft].position.x() += 0.1;
    const FusedBody body = room.all_see(kFilterSteps + 1, stretched);
    return (body.skeleton[WristLeft].position - body.skeleton[ElbowLeft].position).norm();
  };
  const double length = (exact[WristLeft].position - exact[ElbowLeft].position).norm();
  EXPECT_NEAR(length_after(0.003), length, 0.02);
  EXPECT_NEAR(length_after(0.0), length + 0.1, 0.005);
}

TEST(BodyFilter, StatesTheBonesThatItLearnedAndTheStature) {
  const auto exact = standing();
  Room room;
  const FusedBody body = room.settled(exact);
  ASSERT_TRUE(body.bones && body.stature);
  for (const JointId id : {ElbowLeft, KneeRight, SpineMid}) {
    const LearnedLength& bone = (*body.bones)[index_of(id)];
    const double length = (exact[id].position - exact[parent_of(id)].position).norm();
    EXPECT_NEAR(bone.length, length, 1e-3) << name_of(id);
    EXPECT_GT(bone.sigma, 0.0);
    EXPECT_LT(bone.sigma, 0.03);
  }
  EXPECT_EQ((*body.bones)[index_of(HandLeft)].sigma, 0.0) << "never seen";
  const double chain = 0.41 + 0.42 + 0.25 + 0.2;
  EXPECT_NEAR(body.stature->length, chain / kChainOfStature, 0.005);
  EXPECT_EQ(body.method, "body-filter");
}

TEST(BodyFilter, ALeapThatOneViewOfSeveralTellsIsFollowedLater) {
  const auto exact = standing();
  auto leapt = exact;
  leapt[WristLeft].position.x() += 0.3;
  // The first sensor sees the leap; so does the second, if `both`.
  const auto moved = [&](double leap, bool both, int instants) {
    Room room;
    room.config.body.leap = leap;
    room.config.body.resting = 0.0;
    room.config.body.bone = 0.0;
    auto second = both ? leapt : exact;
    if (!both) second[WristLeft] = {};
    (void)room.settled(exact);
    FusedBody body;
    for (int i = 1; i <= instants; ++i) {
      body = room.at(kFilterSteps + i, {view_of(1, leapt), view_of(2, second)});
    }
    return wrist_off(body, exact);
  };
  EXPECT_GT(moved(0.0, false, 1), 0.1);
  EXPECT_LT(moved(0.04, false, 1), 0.045);
  EXPECT_GT(moved(0.04, false, 20), 0.25);
  EXPECT_GT(moved(0.04, true, 1), 0.25);
}

TEST(BodyFilter, AJointThatNobodySeesIsCarriedForAWhileAndSaidToBe) {
  Room room;
  const auto exact = standing();
  (void)room.settled(exact);
  auto without = exact;
  without[WristLeft] = {};
  const double before = room.all_see(kFilterSteps + 1, exact).variance[index_of(WristLeft)];
  FusedBody body;
  for (int i = 2; i < 20; ++i) body = room.all_see(kFilterSteps + i, without);
  EXPECT_EQ(body.skeleton[WristLeft].state, JointState::Inferred);
  EXPECT_EQ(body.contributors[index_of(WristLeft)], 0U);
  EXPECT_LT(wrist_off(body, exact), 0.01);
  EXPECT_GT(body.variance[index_of(WristLeft)], before);
  for (int i = 20; i < 40; ++i) body = room.all_see(kFilterSteps + i, without);
  EXPECT_EQ(body.skeleton[WristLeft].state, JointState::NotTracked);
}

TEST(BodyFilter, ACarriedBodyMovesOn) {
  Room room;
  auto exact = standing();
  const auto move = [&] {
    for (Joint& joint : exact.joints) joint.position.z() += 0.02;
  };
  for (int i = 0; i < kFilterSteps; ++i, move()) (void)room.all_see(i, exact);
  for (int i = 0; i < 3; ++i, move()) (void)room.at(kFilterSteps + i, {});
  EXPECT_LT(wrist_off(room.at(kFilterSteps + 3, {}), exact), 0.02);
}

TEST(BodyFilter, RestIsSmoothAndMotionDoesNotLag) {
  const auto exact = standing();
  const auto step_of = [&](double resting) {
    Room room;
    room.config.body.resting = resting;
    (void)room.settled(exact);
    double steps = 0.0;
    Eigen::Vector3d last = exact[WristLeft].position;
    for (int i = 1; i <= 40; ++i) {
      auto noisy = exact;
      noisy[WristLeft].position.y() += i % 2 == 0 ? 0.003 : -0.003;
      const Eigen::Vector3d now =
          room.all_see(kFilterSteps + i, noisy).skeleton[WristLeft].position;
      steps += (now - last).norm() / 40.0;
      last = now;
    }
    return steps;
  };
  EXPECT_LT(step_of(FusionConfig{}.body.resting), 0.5 * step_of(0.0));
  Room room;
  (void)room.settled(exact);
  auto moving = exact;
  FusedBody body;
  for (int i = 1; i <= 15; ++i) {
    for (Joint& joint : moving.joints) joint.position.z() += 0.03;  // a sudden speed of 0.9 m/s
    body = room.all_see(kFilterSteps + i, moving);
  }
  EXPECT_LT(wrist_off(body, moving), 0.012);
}

TEST(BodyFilter, OneViewThatJumpsMovesNobodyByAJump) {
  Room room;
  const auto exact = standing();
  const FusedBody before = room.settled(exact);
  auto gone = exact;
  for (Joint& joint : gone.joints) joint.position.x() += 0.5;
  const FusedBody body = room.at(kFilterSteps + 1, {view_of(1, exact), view_of(2, exact),
                                                    view_of(3, exact), view_of(4, gone)});
  EXPECT_LT((body.skeleton[Head].position - before.skeleton[Head].position).norm(), 0.015);
}

TEST(BodyFilter, SensorsThatDifferInSizeAreSaidToErrByMoreFarFromTheTrunk) {
  const auto variance = [](double scale, double proportion) {
    Room room;
    room.config.body.proportion = proportion;
    const auto large = scaled(standing(), 1.0 + scale);
    const auto small = scaled(standing(), 1.0 - scale);
    FusedBody body;
    for (int i = 0; i < kFilterSteps; ++i) {
      body = room.at(i, {view_of(1, large), view_of(2, small), view_of(3, standing())});
    }
    return std::pair{body.variance[index_of(AnkleLeft)], body.variance[index_of(SpineMid)]};
  };
  const auto [far, near] = variance(0.06, 0.7);
  const auto [far_unasked, near_unasked] = variance(0.06, 0.0);
  EXPECT_GT(far, 1.3 * far_unasked);
  EXPECT_LT(near - near_unasked, 0.1 * (far - far_unasked));
  EXPECT_NEAR(variance(0.0, 0.7).first, variance(0.0, 0.0).first, 1e-9);
}

/// A body that another fusion server has already fused is not filtered again.
TEST(BodyFilter, ABodyThatOneSourceStatesWithItsCovariancesIsTakenAsItIs) {
  const auto stated = [](Skeleton<WorldSpace> body) {
    for (Joint& joint : body.joints) {
      if (joint.seen())
        joint.covariance = Covariance(Eigen::Matrix3d(4e-4 * Eigen::Matrix3d::Identity()));
    }
    return view_of(1, body);
  };
  auto moving = standing();
  Room room;
  for (int i = 0; i < kFilterSteps; ++i) {
    moving[WristLeft].position.x() += i % 2 == 0 ? 0.03 : -0.03;  // no bone keeps its length
    EXPECT_LT(wrist_off(room.at(i, {stated(moving)}), moving), 1e-12) << i;
  }
  // Once another sensor sees the person too, the body is fused from both, and stays with the body
  // filter when only one is left.
  for (int i = 0; i < kFilterSteps; ++i)
    (void)room.at(kFilterSteps + i, {stated(standing()), view_of(2, standing())});
  moving[WristLeft].position.x() += 0.1;
  EXPECT_GT(wrist_off(room.at(2 * kFilterSteps, {stated(moving)}), moving), 0.005);
  // A second later it is again what that source states.
  EXPECT_LT(wrist_off(room.at(2 * kFilterSteps + 40, {stated(moving)}), moving), 1e-12);
}

TEST(BodyFilter, WhatASensorErrsByIsForgottenAsThePersonTurns) {
  const auto after_a_turn = [](double bias_turn) {
    Room room;
    room.config.body.bias_turn = bias_turn;
    room.config.body.handover = Duration{0};
    room.config.body.bone = 0.0;
    room.config.body.resting = 0.0;
    auto body = standing();
    auto wrong = body;
    wrong[WristLeft].position.y() += 0.04;
    for (int i = 0; i < kFilterSteps; ++i)
      (void)room.at(i, {view_of(1, body), view_of(2, wrong), view_of(3, body)});
    for (Joint& joint : body.joints) joint.position = about_y(deg(60)) * joint.position;
    (void)room.all_see(kFilterSteps, body);
    return wrist_off(room.all_see(kFilterSteps + 1, body), body);
  };
  EXPECT_LT(after_a_turn(deg(15)), 0.3 * after_a_turn(deg(360)));
}

/// The results of a live run and of a recording that starts later differ at first, but are soon
/// close.
TEST(BodyFilter, ALateStartIsForgottenWithinSeconds) {
  const auto at = [](int i) {
    const double t = 0.033 * i;
    auto body = standing();
    for (Joint& joint : body.joints) {
      if (!joint.seen()) continue;
      joint.position = about_y(0.5 * t) * joint.position + Eigen::Vector3d(0.4 * t, 0, 0);
    }
    std::vector<SensorView> views;
    for (int v = 1; v <= 4; ++v) {
      views.push_back(view_of(v, body));
      for (std::size_t j = 0; j < kJointCount; ++j) {
        Joint& joint = views.back().skeleton.joints[j];
        const auto phase = static_cast<double>(7 * v + static_cast<int>(j));
        joint.position +=
            0.03 * Eigen::Vector3d(std::sin(2 * t + phase), std::cos(3 * t + phase), 0);
      }
    }
    return views;
  };
  Room early;
  Room late;
  for (int i = 0; i < 450; ++i) {
    const FusedBody one = early.at(i, at(i));
    if (i < 150) continue;
    const FusedBody other = late.at(i, at(i));
    const double most = i < 180 ? 0.03 : i < 300 ? 0.015 : 0.008;
    EXPECT_LT((one.skeleton[WristLeft].position - other.skeleton[WristLeft].position).norm(), most)
        << i;
  }
}

TEST(BodyFilter, ARayDrawsAJointAndAloneDoesSoOnlyForAWhile) {
  Room room;
  const Eigen::Vector3d neck(0, 1.4, 0.3);
  const auto ray = [&](int number) {
    SensorView view = view_of(number, {});
    view.skeleton[Neck].position = (neck - view.eye).normalized();
    view.skeleton[Neck].state = JointState::Tracked;
    view.skeleton[Neck].measurement = Measurement::Ray;
    return view;
  };
  EXPECT_FALSE(room.at(0, {ray(1)}).skeleton[Neck].seen());
  for (int i = 1; i < 30; ++i) (void)room.at(i, {ray(1), ray(2)});
  const FusedBody both = room.at(30, {ray(1), ray(2)});
  EXPECT_LT((both.skeleton[Neck].position - neck).norm(), 1e-3);
  EXPECT_EQ(both.contributors[index_of(Neck)], 0b11U);
  EXPECT_TRUE(room.at(31, {ray(1)}).skeleton[Neck].seen());
  FusedBody alone;
  for (int i = 32; i < 70; ++i) alone = room.at(i, {ray(1)});
  EXPECT_FALSE(alone.skeleton[Neck].seen());
}

}  // namespace
}  // namespace chorus::fusion
