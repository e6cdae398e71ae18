// The worker's solver finds what registration::solve finds, and stops when told to.
#include "fusion-server/server/solver.h"

#include <gtest/gtest.h>

#include "fusion-server/registration/registration.h"
#include "tests/unit/registration/walk_builder.h"

namespace chorus::server {
namespace {

constexpr int kSensors = 4;

core::SolveJob job_of(const std::vector<registration::WalkTrack>& walk) {
  core::SolveJob job;
  job.session = 3;
  job.kind = core::SolveKind::Final;
  for (const auto& track : walk) {
    const auto middle = track.frames.begin() + static_cast<std::ptrdiff_t>(track.frames.size() / 2);
    job.walk.push_back(
        {track.sensor,
         {std::make_shared<const std::vector<SensorFrame>>(track.frames.begin(), middle),
          std::make_shared<const std::vector<SensorFrame>>(middle, track.frames.end())}});
  }
  return job;
}

std::vector<registration::WalkTrack> ring(double length) {
  std::vector<registration::WalkTrack> walk;
  for (int i = 0; i < kSensors; ++i) {
    walk.push_back(registration::watch(
        i, registration::ring_place(2 * std::numbers::pi * i / kSensors), {.length = length}));
  }
  return walk;
}

TEST(Solver, FindsToTheBitWhatOneCoreFinds) {
  const auto walk = ring(6);
  const core::Solution found = solve(job_of(walk), registration::kWalkStart);
  const Registration alone = registration::solve(walk, registration::kWalkStart, {});
  EXPECT_EQ(found.session, 3u);
  EXPECT_EQ(found.kind, core::SolveKind::Final);
  EXPECT_FALSE(found.given_up);
  EXPECT_GT(found.cost, Duration{0});
  EXPECT_EQ(found.registration.verdict, alone.verdict);
  EXPECT_EQ(found.registration.reasons, alone.reasons);
  EXPECT_EQ(found.registration.master, alone.master);
  ASSERT_EQ(found.registration.sensors.size(), alone.sensors.size());
  for (const auto& [sensor, place] : alone.sensors) {
    EXPECT_EQ(found.registration.sensors.at(sensor).world_from_sensor.matrix(),
              place.world_from_sensor.matrix());
  }
}

TEST(Solver, GivesUpWhenAsked) {
  core::SolveJob job = job_of(ring(6));
  std::stop_source stop;
  job.stop = stop.get_token();
  stop.request_stop();
  const core::Solution found = solve(job, registration::kWalkStart);
  EXPECT_TRUE(found.given_up);
  EXPECT_TRUE(found.registration.edges.empty()) << "no pair was tried any more";
}

TEST(Solver, NothingSeenIsNoVerdict) {
  EXPECT_EQ(solve({}, registration::kWalkStart).registration.verdict, Verdict::None);
}

}  // namespace
}  // namespace chorus::server
