// Sessions by number: who starts them, what they put into use, what they withdraw.
#include "fusion-server/core/registrar.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fusion-server/core/adoption.h"
#include "tests/support/builders.h"
#include "tests/unit/core/sessions.h"

namespace chorus::core {
namespace {

using std::chrono::milliseconds;
using ::testing::Contains;
using ::testing::HasSubstr;
using testing::kStart;
using testing::sensor_id;

/// A registration as with a sensor that sees only a coat stand: all sensors are placed well except
/// the last, which cannot be placed.
Registration all_but_the_last() {
  Registration r = ring(kSensors - 1);
  const std::string reason = "sensor s3 saw nobody walk";
  r.verdicts[sensor_id("s3")] = {Verdict::Refused, {reason}};
  r.reasons = {reason};
  return r;
}

TEST_F(Sessions, HaveANumberFromTheStartAndStayReadable) {
  begin_with(ring());
  const auto id = registrar().start(std::chrono::seconds(8), now_);
  ASSERT_TRUE(id);
  EXPECT_EQ(*id, 7u);
  EXPECT_EQ(newest().state, SessionState::Collecting);
  auto job = walk(std::chrono::seconds(20));
  ASSERT_TRUE(job);
  EXPECT_EQ(job->kind, SolveKind::Provisional);
  EXPECT_EQ(answer(*job, ring()), Outcome::Nothing);  // half a walk replaces no good registration
  job = walk(std::chrono::seconds(20));
  ASSERT_EQ(job->kind, SolveKind::Final);
  EXPECT_EQ(newest().state, SessionState::Solving);
  EXPECT_EQ(answer(*job, ring()), Outcome::Adopted);
  EXPECT_EQ(newest().state, SessionState::Done);
  EXPECT_EQ(newest().verdict, Verdict::Good);
  EXPECT_TRUE(newest().adopted);
  EXPECT_NEAR(newest().elapsed, 8.0, 0.1);
  for (int i = 0; i < 20; ++i) {
    EXPECT_EQ(*registrar().start(std::chrono::seconds(8), now_), 8u + static_cast<unsigned>(i));
    ASSERT_TRUE(registrar().cancel(newest().id, now_));
  }
  EXPECT_EQ(registrar().sessions().size(), 8u);
  EXPECT_EQ(newest().state, SessionState::Cancelled);
  EXPECT_EQ(registrar().cancel(newest().id, now_).error().code, ErrorCode::NotFound);
}

TEST_F(Sessions, OneThatStartedByItselfBecomesTheClientsOwnAndAnotherClientsIsRefused) {
  begin_with({});
  ASSERT_FALSE(walk(std::chrono::seconds(3)));
  ASSERT_TRUE(newest().automatic);
  EXPECT_EQ(*registrar().start(std::chrono::seconds(60), now_), newest().id);
  EXPECT_FALSE(newest().automatic);
  EXPECT_EQ(newest().target, 60.0);
  EXPECT_GT(newest().elapsed, 2.5) << "what was collected stays";
  EXPECT_EQ(registrar().start(std::chrono::seconds(8), now_).error().code, ErrorCode::Conflict);
}

TEST_F(Sessions, OneEndsByItselfOnceAllSensorsArePlacedWellEnough) {
  RegistrarConfig ambitious = registrar_config();
  ambitious.session.target_radius = 0.03;
  registrar_.emplace(ambitious, Registration{}, 7);
  ASSERT_TRUE(registrar().start(std::chrono::seconds(60), now_));
  const auto placed_to = [](double sigma) {
    Registration r = ring();
    for (auto& [sensor, place] : r.sensors)
      place.covariance = sigma * sigma * Eigen::Matrix<double, 6, 6>::Identity();
    return r;
  };
  auto job = walk(std::chrono::seconds(20));
  ASSERT_TRUE(job);
  (void)answer(*job, placed_to(0.02));
  EXPECT_FALSE(newest().reached);
  ASSERT_EQ(newest().accuracy.size(), 3U);
  EXPECT_NEAR(*newest().accuracy[1].radius, 2.45 * 0.02, 1e-3);
  job = walk(std::chrono::seconds(20));
  ASSERT_EQ(job->kind, SolveKind::Provisional);
  Registration short_walk = placed_to(0.01);
  short_walk.verdict = Verdict::Provisional;
  (void)answer(*job, short_walk);
  EXPECT_FALSE(newest().reached) << "a walk that is too short stays provisional";
  (void)answer(*walk(std::chrono::seconds(20)), placed_to(0.01));
  EXPECT_TRUE(newest().reached);
  job = walk(std::chrono::seconds(1));
  EXPECT_EQ(job->kind, SolveKind::Final);
  EXPECT_LT(newest().elapsed, 20.0);
  EXPECT_EQ(newest().target, 60.0);
}

TEST_F(Sessions, AFailingOneLeavesTheRegistrationAndSaysWhy) {
  begin_with(ring());
  ASSERT_TRUE(registrar().start(std::chrono::seconds(8), now_));
  EXPECT_EQ(registrar().solved({7, SolveKind::Final, refused()}, now_), Outcome::Nothing);
  EXPECT_EQ(registrar().registration().verdict, Verdict::Good);
  EXPECT_EQ(registrar().registration().version, 4u);
  EXPECT_FALSE(newest().adopted);
  EXPECT_EQ(newest().verdict, Verdict::Refused);
  EXPECT_THAT(newest().reasons, Contains("sensors s1 and s2 disagree"));
}

/// As ring(), with s3 on the other side of the room: nothing fits where s1 and s2 stood.
Registration rearranged() {
  Registration r = ring(kSensors, Verdict::Provisional);
  std::swap(r.sensors.at(sensor_id("s1")), r.sensors.at(sensor_id("s2")));
  r.sensors.at(sensor_id("s3")).world_from_sensor.translation().y() += 2.0;
  r.verdicts.at(sensor_id("s3")).verdict = Verdict::Good;
  return r;
}

TEST_F(Sessions, PlacesThatTheLastWalkContradictedAreToldUntilAnotherSettlesIt) {
  begin_with(ring(2));
  const auto reasons = [&] { return registrar().registration().reasons; };
  const auto walked = [&](Registration result) {
    const auto id = registrar().start(std::chrono::seconds(8), now_);
    return registrar().solved({*id, SolveKind::Final, std::move(result)}, now_);
  };
  ASSERT_EQ(walked(rearranged()), Outcome::Nothing);
  EXPECT_THAT(newest().reasons, Contains(kContradicted));
  EXPECT_THAT(reasons(), Contains(kContradicted));
  ASSERT_EQ(walked(rearranged()), Outcome::Nothing);
  EXPECT_THAT(reasons(), ::testing::ElementsAre(kContradicted)) << "once";
  ASSERT_TRUE(registrar().move_origin({1.0, 0.0, 0.0}));
  ASSERT_EQ(walked(refused()), Outcome::Nothing);
  EXPECT_THAT(reasons(), Contains(kContradicted)) << "such a walk settles nothing";
  EXPECT_EQ(walked(ring()), Outcome::Adopted);
  EXPECT_THAT(reasons(), ::testing::IsEmpty());
}

TEST_F(Sessions, AWalkThatMissesASensorSaysWhatToDo) {
  begin_with(ring());
  ASSERT_TRUE(registrar().start(std::chrono::seconds(8), now_));
  EXPECT_EQ(registrar().solved({7, SolveKind::Final, ring(2)}, now_), Outcome::Nothing);
  EXPECT_THAT(newest().reasons,
              Contains(HasSubstr("sensor s3, this walk does not; take s3 out of \"sensors\"")));
}

TEST_F(Sessions, AWalkThatMissesSeveralSensorsSaysSoOnce) {
  begin_with(ring());
  ASSERT_TRUE(registrar().start(std::chrono::seconds(8), now_));
  EXPECT_EQ(registrar().solved({7, SolveKind::Final, ring(1)}, now_), Outcome::Nothing);
  EXPECT_THAT(newest().reasons,
              Contains(HasSubstr("sensors s2, s3, this walk does not; take them")));
}

TEST_F(Sessions, ARefusedEndTakesTheSessionsOwnProvisionalBackAndSaysSo) {
  begin_with({});
  ASSERT_TRUE(registrar().start(std::chrono::seconds(8), now_));
  EXPECT_EQ(registrar().solved({7, SolveKind::Provisional, ring(3, Verdict::Provisional)}, now_),
            Outcome::Adopted);
  EXPECT_TRUE(newest().adopted);
  EXPECT_TRUE(registrar().own_provisional()) << "a restart would not find it";
  const std::uint64_t version = registrar().registration().version;
  EXPECT_EQ(registrar().solved({7, SolveKind::Final, refused()}, now_), Outcome::Withdrawn);
  EXPECT_TRUE(registrar().registration().sensors.empty());
  EXPECT_FALSE(registrar().own_provisional());
  EXPECT_GT(registrar().registration().version, version) << "readers see that it changed";
  EXPECT_THAT(registrar().registration().reasons, Contains("sensors s1 and s2 disagree"));
  EXPECT_FALSE(newest().adopted);
  EXPECT_THAT(newest().reasons, Contains(HasSubstr("withdrawn; there is none now")));
}

TEST_F(Sessions, TheOneFromBeforeIsInUseAgainWhenTheEndIsRefused) {
  begin_with(ring(3, Verdict::Provisional));
  ASSERT_TRUE(registrar().start(std::chrono::seconds(8), now_));
  Registration moved = ring();
  for (auto& [sensor, place] : moved.sensors) place.world_from_sensor.translation().x() += 1.0;
  EXPECT_EQ(registrar().solved({7, SolveKind::Provisional, moved}, now_), Outcome::Adopted);
  EXPECT_EQ(registrar().solved({7, SolveKind::Final, refused()}, now_), Outcome::Withdrawn);
  EXPECT_EQ(registrar().registration().verdict, Verdict::Provisional);
  EXPECT_EQ(registrar().registration().sensors.at(sensor_id("s1")).world_from_sensor.matrix(),
            testing::ring_sensor(0, kSensors).matrix());
  EXPECT_THAT(newest().reasons, Contains(HasSubstr("the one from before is in use again")));
}

TEST_F(Sessions, CancellingIsAsIfItHadNeverBeenAndNoneStartsByItselfForAWhile) {
  begin_with({});
  ASSERT_FALSE(walk(std::chrono::seconds(2)));
  ASSERT_EQ(registrar().solved({7, SolveKind::Provisional, ring(3, Verdict::Provisional)}, now_),
            Outcome::Adopted);
  ASSERT_TRUE(registrar().cancel(7, now_));
  EXPECT_TRUE(registrar().registration().sensors.empty());
  EXPECT_EQ(registrar().solved({7, SolveKind::Final, ring()}, now_), Outcome::Nothing);
  ASSERT_FALSE(walk(std::chrono::seconds(5)));
  EXPECT_EQ(newest().state, SessionState::Cancelled);
  EXPECT_THAT(registrar().awaits(now_), Contains(HasSubstr("the next try by itself is in")));
  ASSERT_TRUE(walk(std::chrono::seconds(70)));
  EXPECT_EQ(newest().id, 8u);
}

TEST_F(Sessions, ForgettingCancelsAndTheVersionGoesOn) {
  begin_with(ring());
  ASSERT_TRUE(registrar().start(std::chrono::seconds(8), now_));
  registrar().forget();
  EXPECT_EQ(newest().state, SessionState::Cancelled);
  EXPECT_EQ(registrar().solved({7, SolveKind::Final, ring()}, now_), Outcome::Nothing);
  EXPECT_TRUE(registrar().registration().sensors.empty());
  EXPECT_EQ(registrar().registration().version, 4u);
}

TEST_F(Sessions, NoVersionIsUsedTwiceWhenASessionsOwnResultIsForgotten) {
  begin_with(ring(3, Verdict::Provisional));
  ASSERT_TRUE(registrar().start(std::chrono::seconds(8), now_));
  ASSERT_EQ(registrar().solved({7, SolveKind::Provisional, ring()}, now_), Outcome::Adopted);
  const std::uint64_t seen = registrar().registration().version;
  registrar().forget();
  EXPECT_GT(registrar().registration().version, seen);
}

TEST_F(Sessions, ASensorAddedLaterIsPlacedAndTheOthersStayWhereTheyAre) {
  begin_with(ring(2));
  const Registration before = registrar().registration();
  bool added = false;
  for (int solves = 0; solves < 40 && !(added && newest().state == SessionState::Done); ++solves) {
    const auto job = walk(std::chrono::seconds(10));
    ASSERT_TRUE(job);
    const bool long_enough = newest().elapsed > 20.0;
    Registration candidate = ring(3, long_enough ? Verdict::Good : Verdict::Provisional);
    added = answer(*job, candidate) == Outcome::Adopted || added;
    for (const auto& [sensor, place] : before.sensors) {
      EXPECT_EQ(registrar().registration().sensors.at(sensor).world_from_sensor.matrix(),
                place.world_from_sensor.matrix());
    }
  }
  EXPECT_EQ(registrar().registration().sensors.size(), 3u);
  EXPECT_EQ(registrar().registration().verdict, Verdict::Good);
  EXPECT_TRUE(newest().adopted);
}

TEST_F(Sessions, ACoatStandNeitherKeepsTheVerdictFromGoodNorStartsSessionAfterSession) {
  begin_with({});
  int finals = 0;
  std::uint64_t version = 0;
  for (const Timestamp end = kStart + std::chrono::minutes(10); now_ < end;) {
    const auto job = walk(std::chrono::seconds(40));
    if (!job) continue;
    (void)answer(*job, all_but_the_last());
    if (job->kind != SolveKind::Final) continue;
    ++finals;
    if (finals == 1) version = registrar().registration().version;
    EXPECT_EQ(registrar().registration().verdict, Verdict::Good);
  }
  EXPECT_EQ(registrar().registration().version, version) << "and changes nothing any more";
  EXPECT_LE(finals, 5);  // after 30, 60, 120, 240 s
  EXPECT_GE(finals, 3);
  EXPECT_THAT(registrar().registration().reasons, Contains("sensor s3 saw nobody walk"));
  EXPECT_EQ(newest().verdict, Verdict::Refused);
  EXPECT_THAT(registrar().awaits(now_), Contains("sensor s3 has no place yet"));
}

TEST_F(Sessions, NobodyWaitsForAProvisionalSolveAtTheEndOfTheWalk) {
  begin_with(ring());
  ASSERT_TRUE(registrar().start(std::chrono::seconds(8), now_));
  const auto job = walk(std::chrono::seconds(10));
  ASSERT_TRUE(job);
  ASSERT_EQ(job->kind, SolveKind::Provisional);
  EXPECT_FALSE(job->stop.stop_requested());
  ASSERT_FALSE(walk(std::chrono::seconds(3)));  // the solve is still running when the walk ends
  EXPECT_TRUE(job->stop.stop_requested());
  Solution nothing{job->session, job->kind, {}};
  nothing.given_up = true;
  EXPECT_EQ(registrar().solved(std::move(nothing), now_), Outcome::Nothing);
  const auto last = walk(std::chrono::seconds(1));
  ASSERT_TRUE(last);
  EXPECT_EQ(last->kind, SolveKind::Final);
}

/// The ring as seen by a walk whose world is different: rotated, and 3 m away.
Registration placed_elsewhere(Verdict verdict = Verdict::Good) {
  const auto moved_there = with_origin(ring(kSensors, verdict), {3.0, -1.0, 1.2});
  return *moved_there;
}

double off(const Registration& registration, const char* sensor, const Registration& expected) {
  const SensorId id = sensor_id(sensor);
  return (registration.sensors.at(id).world_from_sensor.matrix() -
          expected.sensors.at(id).world_from_sensor.matrix())
      .norm();
}

TEST_F(Sessions, ANewWalkLeavesTheWorldWhereItWas) {
  begin_with(ring());
  ASSERT_TRUE(registrar().start(std::chrono::seconds(8), now_));
  EXPECT_EQ(registrar().solved({7, SolveKind::Final, placed_elsewhere()}, now_), Outcome::Adopted);
  EXPECT_LT(off(registrar().registration(), "s2", ring()), 1e-9);
}

TEST_F(Sessions, TheWorldIsRememberedWhenTheRegistrationIsForgotten) {
  begin_with(ring());
  registrar().forget();
  registrar().forget();
  ASSERT_TRUE(registrar().start(std::chrono::seconds(8), now_));
  EXPECT_EQ(
      registrar().solved({7, SolveKind::Provisional, placed_elsewhere(Verdict::Provisional)}, now_),
      Outcome::Adopted);
  EXPECT_LT(off(registrar().registration(), "s2", ring()), 1e-9);
  EXPECT_EQ(registrar().solved({7, SolveKind::Final, placed_elsewhere()}, now_), Outcome::Adopted);
  EXPECT_LT(off(registrar().registration(), "s3", ring()), 1e-9);
}

TEST_F(Sessions, TheOriginIsMovedBetweenSessionsOnly) {
  begin_with(ring());
  const Origin origin{3.0, -1.0, 1.2};
  ASSERT_TRUE(registrar().start(std::chrono::seconds(8), now_));
  EXPECT_EQ(registrar().move_origin(origin).error().code, ErrorCode::Conflict);
  ASSERT_TRUE(registrar().cancel(7, now_));
  ASSERT_TRUE(registrar().move_origin(origin));
  EXPECT_LT(off(registrar().registration(), "s1", placed_elsewhere()), 1e-9);
  EXPECT_EQ(registrar().registration().version, 5u);
  ASSERT_TRUE(registrar().start(std::chrono::seconds(8), now_));
  EXPECT_EQ(registrar().solved({8, SolveKind::Final, ring()}, now_), Outcome::Adopted);
  EXPECT_LT(off(registrar().registration(), "s3", placed_elsewhere()), 1e-9) << "it stays there";
}

TEST_F(Sessions, ASensorThatWasMovedLosesItsPlaceAndOneForItStartsAtOnce) {
  begin_with(ring());
  const SensorId moved = sensor_id("s1");  // the master
  EXPECT_FALSE(registrar().displace(sensor_id("stranger"), "unknown"));
  ASSERT_TRUE(registrar().displace(moved, "sensor s1 was moved"));
  const Registration& left = registrar().registration();
  EXPECT_FALSE(left.sensors.contains(moved));
  EXPECT_EQ(left.version, 5u);
  EXPECT_EQ(left.verdict, Verdict::Good) << "the others stand as they stood";
  EXPECT_TRUE(left.sensors.contains(left.master));
  EXPECT_EQ(left.verdicts.at(moved).verdict, Verdict::Refused);
  EXPECT_THAT(left.reasons, Contains("sensor s1 was moved"));
  EXPECT_FALSE(registrar().displace(sensor_id("s2"), "two of two")) << "nobody could tell";
  walk(std::chrono::seconds(1));
  EXPECT_EQ(newest().state, SessionState::Collecting);
  EXPECT_TRUE(newest().automatic);
  EXPECT_FALSE(registrar().displace(sensor_id("s2"), "during a session"));
  EXPECT_EQ(registrar().undo().error().code, ErrorCode::Conflict);
}

TEST_F(Sessions, SomebodyMayAskThatOneSensorIsRegisteredAnew) {
  begin_with(ring());
  EXPECT_EQ(registrar().release(sensor_id("stranger")).error().code, ErrorCode::NotFound);
  ASSERT_TRUE(registrar().release(sensor_id("s2")));
  EXPECT_FALSE(registrar().registration().sensors.contains(sensor_id("s2")));
  EXPECT_EQ(registrar().release(sensor_id("s3")).error().code, ErrorCode::Conflict)
      << "two are left, and nobody could tell which of them stands where it did";
  EXPECT_TRUE(registrar().release(sensor_id("s2"))) << "it has no place: only its pause ends";
  walk(std::chrono::seconds(1));
  EXPECT_EQ(newest().state, SessionState::Collecting);
  EXPECT_EQ(registrar().release(sensor_id("s2")).error().code, ErrorCode::Conflict);
}

}  // namespace
}  // namespace chorus::core
