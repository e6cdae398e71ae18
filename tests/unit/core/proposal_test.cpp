// A result that has to be accepted first: what stays, what is shown, and how long it waits.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/core/sessions.h"

namespace chorus::core {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using testing::sensor_id;

/// As ring(), with s2 a decimetre higher.
Registration raised_ring() {
  Registration r = ring();
  r.sensors.at(sensor_id("s2")).world_from_sensor.translation().y() += 0.1;
  return r;
}

double height_of_s2(const Registration& registration) {
  return registration.sensors.at(sensor_id("s2")).world_from_sensor.translation().y();
}

class Proposals : public Sessions {
 protected:
  /// A client's session to the end of its walk, with `result` as its last solution.
  Outcome propose(Registration result) {
    const auto id = registrar().start(std::chrono::seconds(8), now_, Adoption::WhenAccepted);
    if (!id) return Outcome::Withdrawn;
    return registrar().solved({*id, SolveKind::Final, std::move(result)}, now_);
  }
};

TEST_F(Proposals, NothingChangesUntilOneIsAccepted) {
  begin_with(ring());
  const double before = height_of_s2(ring());
  ASSERT_TRUE(registrar().start(std::chrono::seconds(8), now_, Adoption::WhenAccepted));
  auto job = walk(std::chrono::seconds(20));
  ASSERT_EQ(job->kind, SolveKind::Provisional);
  EXPECT_EQ(answer(*job, raised_ring()), Outcome::Nothing);
  EXPECT_EQ(registrar().accept().error().code, ErrorCode::Conflict);
  job = walk(std::chrono::seconds(20));
  ASSERT_EQ(job->kind, SolveKind::Final);
  EXPECT_EQ(answer(*job, raised_ring()), Outcome::Nothing);
  EXPECT_FALSE(newest().adopted);
  EXPECT_EQ(registrar().registration().version, 4u);
  ASSERT_TRUE(registrar().proposal());
  EXPECT_EQ(registrar().proposal()->session, newest().id);
  ASSERT_EQ(registrar().proposal()->changes.size(), 3u);
  EXPECT_NEAR(*registrar().proposal()->changes[1].shift, 0.1, 0.03);
  EXPECT_THAT(registrar().awaits(now_), Contains(HasSubstr("--accept")));
  ASSERT_TRUE(registrar().accept());
  EXPECT_NEAR(height_of_s2(registrar().registration()), before + 0.1, 0.03);
  EXPECT_TRUE(newest().adopted);
  EXPECT_FALSE(registrar().proposal());
  ASSERT_TRUE(registrar().undo());
  EXPECT_DOUBLE_EQ(height_of_s2(registrar().registration()), before);
}

TEST_F(Proposals, DeclinedTheOldOneStaysAndTheSessionSaysSo) {
  begin_with(ring());
  EXPECT_EQ(registrar().decline().error().code, ErrorCode::NotFound);
  EXPECT_EQ(propose(raised_ring()), Outcome::Nothing);
  ASSERT_TRUE(registrar().decline());
  EXPECT_EQ(registrar().accept().error().code, ErrorCode::NotFound);
  EXPECT_EQ(registrar().registration().version, 4u);
  EXPECT_THAT(newest().reasons, Contains(HasSubstr("declined")));
}

TEST_F(Proposals, WithoutARegistrationInUseThereIsNothingToKeep) {
  begin_with({});
  EXPECT_EQ(propose(ring()), Outcome::Adopted);
  EXPECT_FALSE(registrar().proposal());
}

/// As ring(), but these sensors were placed by directions alone.
Registration ring_with_rays(std::initializer_list<int> numbers) {
  Registration r = ring();
  for (const int number : numbers)
    r.verdicts[sensor_id(name(number))] = {Verdict::Provisional, {"check it"}, true};
  r.verdict = Verdict::Provisional;
  return r;
}

TEST_F(Proposals, PlacesOfDirectionsAloneAreNeverUsedUnasked) {
  begin_with({});
  ASSERT_TRUE(registrar().start(std::chrono::seconds(8), now_, Adoption::AtOnce));
  auto job = walk(std::chrono::seconds(20));
  ASSERT_EQ(job->kind, SolveKind::Provisional);
  EXPECT_EQ(answer(*job, ring_with_rays({0, 1, 2})), Outcome::Nothing);
  job = walk(std::chrono::seconds(20));
  EXPECT_EQ(answer(*job, ring_with_rays({0, 1, 2})), Outcome::Nothing);
  EXPECT_TRUE(registrar().registration().sensors.empty());
  EXPECT_FALSE(newest().adopted);
  ASSERT_TRUE(registrar().proposal());
  EXPECT_EQ(registrar().proposal()->registration.sensors.size(), 3u);
  ASSERT_TRUE(registrar().accept());
  EXPECT_EQ(registrar().registration().sensors.size(), 3u);
  EXPECT_FALSE(registrar().registration().verdicts.at(sensor_id("s2")).unconfirmed);
}

TEST_F(Proposals, PlacesBesideThoseOfDirectionsAloneAreUsedAtOnce) {
  begin_with({});
  const auto id = registrar().start(std::chrono::seconds(8), now_);
  EXPECT_EQ(registrar().solved({*id, SolveKind::Final, ring_with_rays({2})}, now_),
            Outcome::Adopted);
  EXPECT_EQ(registrar().registration().sensors.size(), 2u);
  EXPECT_EQ(registrar().registration().verdict, Verdict::Good);
  ASSERT_TRUE(registrar().proposal());
  ASSERT_TRUE(registrar().accept());
  EXPECT_EQ(registrar().registration().sensors.size(), 3u);
  EXPECT_EQ(registrar().registration().verdict, Verdict::Provisional);
}

TEST_F(Proposals, ARefusedSolutionIsNoProposal) {
  begin_with(ring());
  EXPECT_EQ(propose(refused()), Outcome::Nothing);
  EXPECT_FALSE(registrar().proposal());
}

TEST_F(Proposals, ALaterSessionReplacesOneAndACancelledOneDoesNot) {
  begin_with(ring());
  ASSERT_EQ(propose(raised_ring()), Outcome::Nothing);
  const auto cancelled = registrar().start(std::chrono::seconds(8), now_);
  ASSERT_TRUE(registrar().cancel(*cancelled, now_));
  EXPECT_TRUE(registrar().proposal());
  const std::uint64_t first = registrar().proposal()->session;
  ASSERT_EQ(propose(raised_ring()), Outcome::Nothing);
  EXPECT_GT(registrar().proposal()->session, first);
  const auto at_once = registrar().start(std::chrono::seconds(8), now_);
  EXPECT_EQ(registrar().solved({*at_once, SolveKind::Final, ring()}, now_), Outcome::Adopted);
  EXPECT_FALSE(registrar().proposal());
}

TEST_F(Proposals, ChangesOfTheRegistrationInUseGiveOneUpButAMovedOriginMovesIt) {
  begin_with(ring());
  ASSERT_EQ(propose(raised_ring()), Outcome::Nothing);
  const auto x = [&] {
    return registrar()
        .proposal()
        ->registration.sensors.at(sensor_id("s2"))
        .world_from_sensor.translation()
        .x();
  };
  const double before = x();
  ASSERT_TRUE(registrar().move_origin({1.0, 0.0, 0.0}));
  EXPECT_NEAR(x(), before - 1.0, 1e-9);
  ASSERT_TRUE(registrar().displace(sensor_id("s3"), "sensor s3 was moved"));
  EXPECT_FALSE(registrar().proposal());
  EXPECT_THAT(newest().reasons, Contains("given up: sensor s3 was moved"));
}

TEST_F(Proposals, NoSessionStartsByItselfMeanwhile) {
  begin_with(ring(2));
  ASSERT_EQ(propose(ring()), Outcome::Nothing);
  now_ += std::chrono::minutes(5);
  walk(std::chrono::seconds(2));
  EXPECT_EQ(newest().id, registrar().proposal()->session);
  ASSERT_TRUE(registrar().decline());
  walk(std::chrono::seconds(2));
  EXPECT_TRUE(newest().automatic);
}

TEST_F(Proposals, SensorsThatAreNoLongerConfiguredAreLeftOut) {
  begin_with(ring());
  ASSERT_EQ(propose(raised_ring()), Outcome::Nothing);
  RegistrarConfig fewer = registrar_config();
  fewer.sensors.erase(sensor_id("s3"));
  registrar().reconfigure(fewer);
  ASSERT_TRUE(registrar().accept());
  EXPECT_FALSE(registrar().registration().sensors.contains(sensor_id("s3")));
}

}  // namespace
}  // namespace chorus::core
