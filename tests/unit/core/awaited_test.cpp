// The server tells a person in the room what to do next, whatever it is waiting for.
#include "fusion-server/core/awaited.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/builders.h"

namespace chorus::core {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::kStart;
using testing::sensor_id;

class Awaited : public ::testing::Test {
 protected:
  void see(const char* sensor, std::size_t bodies) {
    SensorFrame frame = testing::sensor_frame(sensor, kStart, std::vector<BodyFrame>(bodies));
    frame.received = kStart;
    last_seen_.add(frame);
  }
  void see_rays(const char* sensor) {
    BodyFrame body;
    body.skeleton[JointId::Neck] = {.position = Eigen::Vector3d::UnitZ(),
                                    .state = JointState::Tracked,
                                    .measurement = Measurement::Ray};
    SensorFrame frame = testing::sensor_frame(sensor, kStart, {body});
    frame.received = kStart;
    last_seen_.add(frame);
  }
  void place(const char* sensor) { registration_.sensors[sensor_id(sensor)] = Extrinsics{}; }
  std::vector<std::string> said() {
    Situation s{sensors_, registration_, last_seen_, nullptr, automatic_, retry_, kStart};
    if (session_) s.session = &*session_;
    return awaited(s);
  }

  std::set<SensorId> sensors_{sensor_id("s1"), sensor_id("s2"), sensor_id("s3")};
  Registration registration_;
  LastSeen last_seen_;
  std::optional<SessionStatus> session_;
  bool automatic_ = true;
  std::optional<Duration> retry_;
};

TEST_F(Awaited, NoSensorsAndDeadSensors) {
  EXPECT_THAT(said(), ElementsAre(HasSubstr("none of the sensors delivers frames")));
  sensors_.clear();
  EXPECT_THAT(said(), ElementsAre(HasSubstr("no sensors are configured")));
}

TEST_F(Awaited, CamerasWithoutDepthAreWalkedForLikeOthersUnlessThereIsOnlyOne) {
  for (const char* camera : {"s1", "s2", "s3"}) see_rays(camera);
  EXPECT_THAT(said(), ElementsAre("a session starts by itself"));
  sensors_ = {sensor_id("s1")};
  EXPECT_THAT(said(), ElementsAre(HasSubstr("one camera alone cannot place")));
  place("s1");
  EXPECT_THAT(said(), Not(Contains(HasSubstr("without depth"))));
}

TEST_F(Awaited, NobodyThenOneSensorThenAWalk) {
  see("s1", 0);
  see("s2", 0);
  EXPECT_THAT(said(), ElementsAre("sensor s3 delivers no frames: see /sensors/ for the reason",
                                  HasSubstr("nobody is in sight")));
  see("s3", 0);
  see("s1", 1);
  EXPECT_THAT(said(), ElementsAre(HasSubstr("only sensor s1 sees somebody")));
  see("s2", 1);
  EXPECT_THAT(said(), ElementsAre("a session starts by itself"));
  automatic_ = false;
  EXPECT_THAT(said(), ElementsAre(HasSubstr("run chorus register")));
}

TEST_F(Awaited, SeveralPeople) {
  for (const char* sensor : {"s1", "s2", "s3"}) see(sensor, 2);
  EXPECT_THAT(said(), ElementsAre(HasSubstr("sensors s1, s2 and s3 see more than one body")));
}

TEST_F(Awaited, ACrowdDuringAWalkIsToldToWalkAloneAndNothingElse) {
  for (const char* sensor : {"s1", "s2", "s3"}) see(sensor, 2);
  session_.emplace();
  session_->state = SessionState::Collecting;
  session_->elapsed = 14;
  session_->target = 30;
  EXPECT_THAT(said(), ElementsAre(HasSubstr("one person alone should walk")))
      << "where the sensors overlap does not matter now";
  see("s1", 1);  // so the second body of s2 and s3 may be a mirror image
  EXPECT_THAT(said(), Contains("keep walking: 16 s more"));
}

TEST_F(Awaited, AWalkWithoutASensorThatHasAPlaceIsSaidToBeInVain) {
  for (const char* sensor : {"s1", "s2"}) see(sensor, 1);
  for (const char* sensor : {"s1", "s2", "s3"}) place(sensor);
  session_.emplace();
  session_->state = SessionState::Collecting;
  session_->elapsed = 1;
  session_->target = 30;
  EXPECT_EQ(said().back(),
            "this walk will be in vain: the registration in use places sensor s3, which delivers "
            "nothing; start it, or take it out of \"sensors\" and reload");
  sensors_.insert(sensor_id("s4"));
  see("s4", 1);
  for (const std::string& line : said())
    EXPECT_THAT(line, ::testing::Not(HasSubstr("in vain"))) << "s4 gets a place";
}

TEST_F(Awaited, TheRestOfTheWalkAndItsSolution) {
  for (const char* sensor : {"s1", "s2", "s3"}) see(sensor, 1);
  session_.emplace();
  session_->state = SessionState::Collecting;
  session_->elapsed = 12.4;
  session_->target = 30;
  EXPECT_THAT(said(), ElementsAre("keep walking: 18 s more", HasSubstr("s2 and another sensor"),
                                  HasSubstr("s3 and another sensor")));
  const auto pair = [](const char* a, const char* b) {
    return PairCoverage{sensor_id(a), sensor_id(b), 300, 0.8, 0.04};
  };
  session_->pairs = {pair("s1", "s2"), pair("s2", "s3")};
  EXPECT_THAT(said(), ElementsAre("keep walking: 18 s more"));
  session_->state = SessionState::Solving;
  EXPECT_THAT(said(), ElementsAre(HasSubstr("being solved")));
}

TEST_F(Awaited, NothingWhenAllHaveAPlaceAndTheMissingOneWhenOneHasNot) {
  for (const char* sensor : {"s1", "s2", "s3"}) see(sensor, 1);
  place("s1");
  place("s2");
  retry_ = std::chrono::milliseconds(29500);
  EXPECT_THAT(said(), ElementsAre("sensor s3 has no place yet",
                                  HasSubstr("the next try by itself is in 30 s")));
  place("s3");
  EXPECT_THAT(said(), IsEmpty());
}

TEST_F(Awaited, AlwaysANextStepWhileThePlacesAreNotGood) {
  for (const char* sensor : {"s1", "s2", "s3"}) {
    see(sensor, 1);
    place(sensor);
  }
  registration_.master = sensor_id("s1");
  registration_.verdict = Verdict::Provisional;
  registration_.reasons = {"the walk lasted only 8 s; 20 s make a good registration"};
  EXPECT_THAT(said(), ElementsAre(AllOf(HasSubstr("the walk lasted only 8 s"),
                                        HasSubstr("chorus register, and walk for 30 s"))));
  for (const char* sensor : {"s1", "s2"})
    registration_.verdicts[sensor_id(sensor)] = {Verdict::Good, {}};
  registration_.verdicts[sensor_id("s3")] = {Verdict::Provisional, {}};
  EXPECT_THAT(said(), ElementsAre(HasSubstr("sensor s3 stands only provisionally")));
  registration_.verdict = Verdict::Good;
  EXPECT_THAT(said(), IsEmpty());
}

TEST_F(Awaited, PlacesOfAnotherSetup) {
  place("cam1");
  place("cam2");
  EXPECT_EQ(said().front(),
            "the stored places are of another setup: sensors cam1 and cam2 are not configured; "
            "chorus register --fresh begins anew");
  place("s1");
  for (const std::string& line : said())
    EXPECT_THAT(line, ::testing::Not(HasSubstr("another setup")));
}

TEST(LastSeen, AreOfTheNewestFrameAndGrowOld) {
  LastSeen last_seen;
  SensorFrame frame = testing::sensor_frame("s1", kStart, std::vector<BodyFrame>(2));
  frame.received = kStart;
  last_seen.add(frame);
  EXPECT_EQ(last_seen.bodies(sensor_id("s1"), kStart + std::chrono::seconds(1)), 2u);
  EXPECT_EQ(last_seen.bodies(sensor_id("s1"), kStart + std::chrono::seconds(3)), 0u);
  EXPECT_FALSE(last_seen.delivers(sensor_id("s1"), kStart + std::chrono::seconds(3)));
  EXPECT_EQ(last_seen.bodies(sensor_id("s2"), kStart), 0u);
  EXPECT_EQ(last_seen.seeing(kStart), std::set{sensor_id("s1")});
  last_seen.keep({});
  EXPECT_TRUE(last_seen.seeing(kStart).empty());
}

}  // namespace
}  // namespace chorus::core
