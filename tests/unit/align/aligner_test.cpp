#include "fusion-server/align/aligner.h"

#include <array>
#include <optional>
#include <tuple>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace chorus::align {
namespace {

using std::chrono::milliseconds;

constexpr Timestamp kAlignStart = from_unix_ns(1'790'000'000'000'000'000);
const SensorId kSensor = SensorId::parse("s1").value();

BodyFrame body_at(Timestamp captured, double x, std::uint64_t id = 1) {
  BodyFrame body{BodyId{id}, captured, {}};
  Joint& neck = body.skeleton[JointId::Neck];
  neck.position = {x, 1.4, 2.5};
  neck.orientation = Eigen::Quaterniond::Identity();
  neck.state = JointState::Tracked;
  return body;
}

SensorFrame frame_at(Duration after, double x) {
  SensorFrame frame;
  frame.captured = kAlignStart + after;
  frame.bodies = {body_at(frame.captured, x)};
  return frame;
}

History two_frames(Duration gap) {
  History history;
  history.push(frame_at(milliseconds(0), 0.0));
  history.push(frame_at(gap, 0.15));
  return history;
}

AlignedSensor ask(const History& history, Duration after, Duration age = milliseconds(50)) {
  return at(kAlignStart + after, kAlignStart + after + age, kSensor, history, {});
}

double neck_x(const AlignedSensor& aligned) {
  return aligned.bodies.at(0).skeleton[JointId::Neck].position.x();
}

TEST(Align, ACaptureAtTheInstantIsExact) {
  const AlignedSensor aligned = ask(two_frames(milliseconds(30)), milliseconds(30));
  EXPECT_EQ(aligned.basis, Basis::Exact);
  EXPECT_DOUBLE_EQ(neck_x(aligned), 0.15);
}

TEST(Align, BetweenTwoCapturesPositionsAreLinear) {
  const AlignedSensor aligned = ask(two_frames(milliseconds(30)), milliseconds(10));
  EXPECT_EQ(aligned.basis, Basis::Interpolated);
  EXPECT_NEAR(neck_x(aligned), 0.05, 1e-12);
  EXPECT_EQ(aligned.bodies[0].captured, kAlignStart + milliseconds(10));
}

TEST(Align, BeyondTheNewestCaptureIsPendingThenLost) {
  const History history = two_frames(milliseconds(30));
  EXPECT_EQ(ask(history, milliseconds(40), milliseconds(50)).basis, Basis::Pending);
  EXPECT_EQ(ask(history, milliseconds(40), milliseconds(201)).basis, Basis::Lost);
}

TEST(Align, ASilentSensorIsGivenUpAsSoonAsNoBracketCouldClose) {
  EXPECT_EQ(ask(two_frames(milliseconds(30)), milliseconds(151), milliseconds(0)).basis,
            Basis::Lost);
}

/// A sensor whose frames come every 33 ms and arrive `delay` after their capture.
History habitual(Duration delay, int frames = 30) {
  History history;
  for (int i = 0; i < frames; ++i) {
    SensorFrame frame = frame_at(milliseconds(33 * i), 0.0);
    frame.received = frame.captured + delay;
    history.push(std::move(frame));
  }
  return history;
}

TEST(Align, ASensorIsWaitedForAsLongAsItsFramesUsuallyTake) {
  const Duration instant = milliseconds(33 * 29 + 10);
  // The longest wait is one period, the delay, and a short grace period.
  EXPECT_EQ(longest_wait(habitual(milliseconds(2))), milliseconds(33 + 2 + 15));
  EXPECT_EQ(ask(habitual(milliseconds(2)), instant, milliseconds(45)).basis, Basis::Pending);
  EXPECT_EQ(ask(habitual(milliseconds(2)), instant, milliseconds(55)).basis, Basis::Lost);
  EXPECT_EQ(ask(habitual(milliseconds(110)), instant, milliseconds(150)).basis, Basis::Pending);
  EXPECT_EQ(ask(habitual(milliseconds(110)), instant, milliseconds(160)).basis, Basis::Lost);
  // The wait is never longer than the patience.
  EXPECT_EQ(ask(habitual(milliseconds(400)), instant, milliseconds(201)).basis, Basis::Lost);
}

TEST(Align, AFewFramesOrUnknownArrivalsMakeNoHabit) {
  EXPECT_EQ(longest_wait(habitual(milliseconds(2), 9)), std::nullopt);
  History unknown = two_frames(milliseconds(30));
  for (int i = 2; i < 20; ++i) unknown.push(frame_at(milliseconds(30 * i), 0.0));
  EXPECT_EQ(longest_wait(unknown), std::nullopt);
}

TEST(Align, AnEmptyHistoryIsPendingThenLost) {
  EXPECT_EQ(ask(History(), milliseconds(0), milliseconds(10)).basis, Basis::Pending);
  EXPECT_EQ(ask(History(), milliseconds(0), milliseconds(500)).basis, Basis::Lost);
}

TEST(Align, BeforeTheOldestCaptureIsLost) {
  EXPECT_EQ(ask(two_frames(milliseconds(30)), milliseconds(-1)).basis, Basis::Lost);
}

TEST(Align, AWideGapIsNotBridged) {
  EXPECT_EQ(ask(two_frames(milliseconds(120)), milliseconds(60)).basis, Basis::Interpolated);
  EXPECT_EQ(ask(two_frames(milliseconds(121)), milliseconds(60)).basis, Basis::Lost);
}

/// Frames every `period`, then a gap, then one more frame.
History then_gap(Duration period, Duration gap) {
  History history;
  for (int i = 0; i < 8; ++i) history.push(frame_at(i * period, 0.0));
  history.push(frame_at(7 * period + gap, 0.3));
  return history;
}

TEST(Align, ASlowSensorsGapIsBridgedWhereOneFrameIsMissing) {
  const Duration period = milliseconds(200);
  const auto basis = [&](const History& history, const AlignConfig& config) {
    const Timestamp instant = kAlignStart + 7 * period + milliseconds(100);
    return basis_at(instant, instant + milliseconds(50), history, config);
  };
  EXPECT_EQ(basis(then_gap(period, period), {}), Basis::Interpolated);
  EXPECT_EQ(basis(then_gap(period, 2 * period), {}), Basis::Interpolated);
  EXPECT_EQ(basis(then_gap(period, 2 * period + milliseconds(1)), {}), Basis::Lost);
  AlignConfig bounded;
  bounded.slowest = milliseconds(300);
  EXPECT_EQ(basis(then_gap(period, 2 * period), bounded), Basis::Lost);
  EXPECT_EQ(basis(then_gap(period, milliseconds(300)), bounded), Basis::Interpolated);
}

TEST(Align, ABodyAtOneEndOnlyIsNotShown) {
  History history = two_frames(milliseconds(30));
  SensorFrame third = frame_at(milliseconds(60), 0.3);
  third.bodies.push_back(body_at(third.captured, 2.0, 2));
  history.push(third);
  const AlignedSensor aligned = ask(history, milliseconds(45));
  ASSERT_EQ(aligned.bodies.size(), 1u);
  EXPECT_EQ(aligned.bodies[0].id, BodyId{1});
  EXPECT_NEAR(neck_x(aligned), 0.225, 1e-12);
}

TEST(Align, IsNotInterpolatedAcrossAnIdThatWentToSomebodyElse) {
  History history;
  history.push(frame_at(milliseconds(0), 0.0));
  history.push(frame_at(milliseconds(33), 1.7));
  EXPECT_TRUE(ask(history, milliseconds(10)).bodies.empty());
  EXPECT_EQ(ask(history, milliseconds(10)).basis, Basis::Interpolated);
  EXPECT_EQ(ask(history, milliseconds(33)).bodies.size(), 1u);
}

TEST(Align, JointsThatAreNotSeenDoNotHideThatAnIdWentToSomebodyElse) {
  History history;
  history.push(frame_at(milliseconds(0), 0.0));  // of these bodies, the neck alone is seen
  history.push(frame_at(milliseconds(33), 0.8));
  EXPECT_TRUE(ask(history, milliseconds(10)).bodies.empty());
}

/// Two people 0.5 m apart who step 0.05 m to the side, numbered as stated, in frames 66 ms apart.
std::vector<double> between(std::array<std::uint64_t, 2> before, std::array<std::uint64_t, 2> after,
                            double apart = 0.5) {
  History history;
  for (const auto& [when, ids, x] :
       {std::tuple(milliseconds(0), before, 0.0), std::tuple(milliseconds(66), after, 0.05)}) {
    SensorFrame frame = frame_at(when, x);
    frame.bodies = {body_at(frame.captured, x, ids[0]), body_at(frame.captured, x + apart, ids[1])};
    history.push(std::move(frame));
  }
  std::vector<double> places;
  for (const BodyFrame& body : ask(history, milliseconds(33)).bodies)
    places.push_back(body.skeleton[JointId::Neck].position.x());
  return places;
}

TEST(Align, PeopleAreFollowedWhateverTheirNumbers) {
  const auto both =
      testing::ElementsAre(testing::DoubleNear(0.025, 1e-9), testing::DoubleNear(0.525, 1e-9));
  EXPECT_THAT(between({1, 2}, {1, 2}), both);
  EXPECT_THAT(between({1, 2}, {2, 1}), both);  // exchanged
  EXPECT_THAT(between({1, 2}, {3, 4}), both);  // numbered from scratch
  EXPECT_THAT(between({1, 2}, {2, 3}), both);
}

TEST(Align, WhoeverStandsCloselyIsToldApartByTheirNumber) {
  const auto places = between({1, 2}, {2, 1}, 0.05);
  EXPECT_THAT(places, testing::ElementsAre(testing::DoubleNear(0.05, 1e-9),
                                           testing::DoubleNear(0.05, 1e-9)));
}

TEST(Align, BasisAtAgreesWithTheFullAnswer) {
  const History history = two_frames(milliseconds(30));
  for (int ms = -10; ms < 200; ms += 5) {
    const Timestamp instant = kAlignStart + milliseconds(ms);
    EXPECT_EQ(basis_at(instant, instant + milliseconds(50), history, {}),
              ask(history, milliseconds(ms)).basis);
  }
}

}  // namespace
}  // namespace chorus::align
