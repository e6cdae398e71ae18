// Undo: what a session, a move or another master put into use is taken back a step at a time.
#include <gtest/gtest.h>

#include "fusion-server/core/registrar.h"
#include "tests/support/builders.h"
#include "tests/unit/core/sessions.h"

namespace chorus::core {
namespace {

using testing::sensor_id;

TEST_F(Sessions, AnUndoGoesBackOneStepAndAgainForward) {
  begin_with(ring());
  EXPECT_EQ(registrar().undo().error().code, ErrorCode::NotFound);
  ASSERT_TRUE(registrar().move_origin({1.0, 0.0, 0.0}));
  const auto place = [&] {
    return registrar().registration().sensors.at(sensor_id("s2")).world_from_sensor;
  };
  const Eigen::Isometry3d moved = place();
  ASSERT_TRUE(registrar().earlier());
  ASSERT_TRUE(registrar().undo());
  EXPECT_TRUE(place().isApprox(ring().sensors.at(sensor_id("s2")).world_from_sensor));
  EXPECT_EQ(registrar().registration().version, 6u) << "versions rise";
  ASSERT_TRUE(registrar().undo());
  EXPECT_TRUE(place().isApprox(moved));
  registrar().forget();
  EXPECT_TRUE(registrar().registration().sensors.empty());
  ASSERT_TRUE(registrar().undo());
  EXPECT_TRUE(place().isApprox(moved)) << "a forgotten one comes back, too";
}

TEST_F(Sessions, AMoveThatWasNoneIsUndoneAlsoAfterTheSensorWasPlacedAnew) {
  begin_with(ring());
  const SensorId moved = sensor_id("s3");
  ASSERT_TRUE(registrar().displace(moved, "sensor s3 was moved"));
  walk(std::chrono::seconds(1));
  Registration anew = ring();
  anew.sensors.at(moved).world_from_sensor.translation().x() += 0.2;
  EXPECT_EQ(registrar().solved({newest().id, SolveKind::Final, anew}, now_), Outcome::Adopted);
  ASSERT_TRUE(registrar().registration().sensors.contains(moved));
  ASSERT_TRUE(registrar().undo());
  EXPECT_TRUE(registrar().registration().sensors.at(moved).world_from_sensor.isApprox(
      ring().sensors.at(moved).world_from_sensor));
}

TEST_F(Sessions, AnUndoAfterTheMasterIsGoneStandsOnAnotherSensor) {
  begin_with(ring());
  ASSERT_TRUE(registrar().move_origin({1.0, 0.0, 0.0}));
  RegistrarConfig fewer = registrar_config();
  fewer.sensors.erase(registrar().registration().master);
  registrar().reconfigure(fewer);
  ASSERT_TRUE(registrar().undo());
  const Registration& back = registrar().registration();
  EXPECT_EQ(back.sensors.size(), 2u);
  EXPECT_TRUE(back.sensors.contains(back.master)) << "else it could not be stored";
  fewer.sensors = {sensor_id("another")};
  registrar().reconfigure(fewer);
  EXPECT_EQ(registrar().undo().error().code, ErrorCode::NotFound);
  EXPECT_FALSE(registrar().registration().sensors.empty());
}

TEST_F(Sessions, AnUndoAfterAWalkGoesBackToBeforeItsProvisionalOnes) {
  begin_with(ring(kSensors, Verdict::Provisional));
  ASSERT_TRUE(registrar().start(std::chrono::seconds(8), now_));
  auto job = walk(std::chrono::seconds(20));
  ASSERT_TRUE(job);
  ASSERT_EQ(answer(*job, ring()), Outcome::Adopted);
  EXPECT_FALSE(registrar().earlier());
  job = walk(std::chrono::seconds(20));
  ASSERT_EQ(job->kind, SolveKind::Final);
  ASSERT_EQ(answer(*job, ring()), Outcome::Adopted);
  ASSERT_TRUE(registrar().undo());
  EXPECT_EQ(registrar().registration().verdict, Verdict::Provisional);
}

}  // namespace
}  // namespace chorus::core
