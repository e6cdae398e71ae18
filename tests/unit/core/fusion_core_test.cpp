// Drives all of the pipeline thread's state by hand: frames in, snapshots and jobs out.
#include "fusion-server/core/fusion_core.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <gtest/gtest.h>

#include "tests/support/builders.h"
#include "tests/unit/core/ring_of_three.h"

namespace chorus::core {
namespace {

using std::chrono::milliseconds;
using testing::kFrameInterval;
using testing::kStart;
using testing::sensor_id;

CoreConfig config() { return of_three<CoreConfig>(); }

bool collecting(const FusionCore& core) {
  const auto sessions = core.progress(kStart).sessions;
  return !sessions.empty() && sessions.front().state == SessionState::Collecting;
}

struct Answers : std::vector<Snapshot> {
  Duration worst{0};  ///< Longest time from an instant to its snapshot.
};

/// Runs the core from `from` for `length` as the server would: each sensor has its own phase; time
/// steps by one millisecond.  `dead` is a sensor that delivers nothing.
Answers run(FusionCore& core, Duration from, Duration length, int dead = -1) {
  Answers out;
  for (Duration t = from; t < from + length; t += milliseconds(1)) {
    for (int i = 0; i < kSensors; ++i) {
      const Duration phase = milliseconds(7 * i);
      if (i != dead && t >= phase && (t - phase) % milliseconds(33) < milliseconds(1)) {
        core.take(sight(i, t));
      }
    }
    while (auto snapshot = core.tick(kStart + t)) {
      out.worst = std::max(out.worst, kStart + t - snapshot->instant);
      out.push_back(std::move(*snapshot));
    }
  }
  return out;
}

void expect_gapless(const std::vector<Snapshot>& snapshots) {
  for (std::size_t i = 1; i < snapshots.size(); ++i) {
    EXPECT_EQ(snapshots[i].sequence, snapshots[i - 1].sequence + 1);
    EXPECT_NEAR(chorus::seconds(snapshots[i].instant - snapshots[i - 1].instant), 1.0 / 30, 1e-8);
  }
}

TEST(FusionCore, FusesEveryInstantOnceAndKnowsWhoContributed) {
  FusionCore core(config(), ring());
  const auto snapshots = run(core, Duration{0}, std::chrono::seconds(3));
  ASSERT_GT(snapshots.size(), 80u);
  expect_gapless(snapshots);
  const Snapshot& last = snapshots.back();
  ASSERT_EQ(last.bodies.size(), 1u);
  EXPECT_EQ(last.bodies[0].contributors[index_of(JointId::Neck)], 0b111u);
  EXPECT_EQ(core.reports().size(), 3u);
}

TEST(FusionCore, AnswersWithoutWaitingForTheDelayWhenAllSensorsHavePassed) {
  FusionCore core(config(), ring());
  (void)run(core, Duration{0}, std::chrono::seconds(1));
  // The longest delay is one frame interval plus the sensors' phases, not the alignment delay of
  // 200 ms.
  EXPECT_LT(run(core, std::chrono::seconds(1), std::chrono::seconds(1)).worst, milliseconds(50));
}

TEST(FusionCore, ADeadSensorDelaysOnlyUntilItIsLaterThanItEverWas) {
  FusionCore core(config(), ring());
  (void)run(core, Duration{0}, std::chrono::seconds(1));
  const auto waiting = run(core, std::chrono::seconds(1), milliseconds(200), 1);
  EXPECT_GT(waiting.worst, milliseconds(35));  // later than any frame so far
  EXPECT_LT(waiting.worst, milliseconds(70));
  const auto during = run(core, milliseconds(1200), milliseconds(2800), 1);
  expect_gapless(during);
  EXPECT_LT(during.worst, milliseconds(50));
  ASSERT_EQ(during.back().bodies.size(), 1u);
  EXPECT_EQ(during.back().bodies[0].contributors[index_of(JointId::Neck)], 0b101u);
  const auto after = run(core, std::chrono::seconds(4), std::chrono::seconds(1));
  expect_gapless(after);
  EXPECT_EQ(after.back().bodies[0].contributors[index_of(JointId::Neck)], 0b111u);
  EXPECT_EQ(after.back().bodies[0].id, during.front().bodies[0].id);
}

TEST(FusionCore, AllSensorsDeadStillTicksWithoutBodies) {
  FusionCore core(config(), ring());
  (void)run(core, Duration{0}, std::chrono::seconds(1));
  std::size_t ticks = 0;
  for (Duration t = std::chrono::seconds(1); t < std::chrono::seconds(5); t += milliseconds(1)) {
    if (core.tick(kStart + t)) ++ticks;
  }
  EXPECT_NEAR(static_cast<double>(ticks), 120.0, 4.0);
}

TEST(FusionCore, StrangersAndFramesThatGoBackAreRefused) {
  FusionCore core(config(), ring());
  (void)run(core, Duration{0}, milliseconds(500));
  SensorFrame back = sight(0, milliseconds(300));
  back.sequence = ~std::uint64_t{0};  // by its number, newer than all other frames
  core.take(back);
  EXPECT_EQ(core.memory_of(sensor_id("s1")).losses.counts().backwards, 1u);
  SensorFrame stranger = sight(0, milliseconds(600));
  stranger.sensor = sensor_id("s9");
  core.take(stranger);
  (void)run(core, milliseconds(600), milliseconds(200));
  EXPECT_EQ(core.reports().size(), 3u);
}

TEST(FusionCore, StartsASessionByItselfWhenSensorsHaveNoPlace) {
  FusionCore core(config(), {});
  EXPECT_FALSE(core.due_job(kStart));
  EXPECT_FALSE(collecting(core));
  std::optional<SolveJob> job;
  Duration t{0};
  for (; !job && t < std::chrono::seconds(10); t += milliseconds(100)) {
    (void)run(core, t, milliseconds(100));
    job = core.due_job(kStart + t);
  }
  ASSERT_TRUE(job);
  EXPECT_EQ(job->kind, SolveKind::Provisional);
  EXPECT_LT(t, std::chrono::seconds(8));
  EXPECT_EQ(job->walk.size(), 3u);
  EXPECT_TRUE(collecting(core));
  // There is only one unfinished job at a time.
  (void)run(core, t, std::chrono::seconds(4));
  EXPECT_FALSE(core.due_job(kStart + t + std::chrono::seconds(4)));
  EXPECT_EQ(core.solved({job->session, job->kind, ring(3, Verdict::Provisional)}, kStart + t),
            Outcome::Adopted);
  EXPECT_EQ(core.registration().version, 1u);
  EXPECT_TRUE(core.due_job(kStart + t + std::chrono::seconds(4)));
}

TEST(FusionCore, DoesNotStartWhenAllSensorsThatSeeHaveAPlaceOrWhenToldNotTo) {
  FusionCore placed(config(), ring());
  (void)run(placed, Duration{0}, std::chrono::seconds(2));
  EXPECT_FALSE(placed.due_job(kStart + std::chrono::seconds(2)));
  EXPECT_FALSE(collecting(placed));

  CoreConfig manual = config();
  manual.session.automatic = false;
  FusionCore waiting(manual, {});
  (void)run(waiting, Duration{0}, std::chrono::seconds(2));
  EXPECT_FALSE(waiting.due_job(kStart + std::chrono::seconds(2)));
  EXPECT_FALSE(collecting(waiting));
}

TEST(FusionCore, ASensorAddedLaterStartsASessionAndKeepsTheOldPlaces) {
  FusionCore core(config(), ring(2));
  (void)run(core, Duration{0}, std::chrono::seconds(2));
  (void)core.due_job(kStart + std::chrono::seconds(2));
  EXPECT_TRUE(collecting(core));
  EXPECT_EQ(core.registration().sensors.size(), 2u);
}

TEST(FusionCore, TheMasterStaysWhileItTakesPartUnlessTheConfigNamesOne) {
  Registration placed = ring();
  placed.master = sensor_id("s2");
  FusionCore core(config(), placed);
  ASSERT_TRUE(core.start_session(std::chrono::seconds(8), kStart));
  (void)run(core, Duration{0}, std::chrono::seconds(7));
  const auto job = core.due_job(kStart + std::chrono::seconds(7));
  ASSERT_TRUE(job);
  EXPECT_EQ(job->config.master, sensor_id("s2"));

  CoreConfig chosen = config();
  chosen.registration.master = sensor_id("s3");
  FusionCore other(chosen, placed);
  ASSERT_TRUE(other.start_session(std::chrono::seconds(8), kStart));
  (void)run(other, Duration{0}, std::chrono::seconds(7));
  EXPECT_EQ(other.due_job(kStart + std::chrono::seconds(7))->config.master, sensor_id("s3"));

  FusionCore without(config(), placed);
  ASSERT_TRUE(without.start_session(std::chrono::seconds(8), kStart));
  (void)run(without, Duration{0}, std::chrono::seconds(7), 1);
  EXPECT_FALSE(without.due_job(kStart + std::chrono::seconds(7))->config.master);
}

TEST(FusionCore, ASensorTakenOutOfTheConfigNoLongerBindsTheRegistration) {
  FusionCore core(config(), ring());
  CoreConfig fewer = config();
  fewer.sensors.erase(sensor_id("s3"));
  core.reconfigure(fewer);
  ASSERT_TRUE(core.start_session(std::chrono::seconds(8), kStart));
  EXPECT_EQ(core.solved({1, SolveKind::Final, ring(2)}, kStart), Outcome::Adopted);
  EXPECT_EQ(core.registration().sensors.size(), 2u);
  EXPECT_EQ(core.registration().version, 5u);
}

TEST(FusionCore, SensorsThatNobodyPollsTakeNoPartAndAreNamedAsSuch) {
  CoreConfig fewer = config();
  fewer.sensors.erase(sensor_id("s2"));
  FusionCore core(fewer, ring());
  const auto snapshots = run(core, Duration{0}, std::chrono::seconds(1));
  ASSERT_FALSE(snapshots.empty());
  EXPECT_EQ(snapshots.back().sensors, (std::vector{sensor_id("s1"), sensor_id("s3")}));
  ASSERT_EQ(snapshots.back().bodies.size(), 1u);
  EXPECT_EQ(snapshots.back().bodies[0].contributors[0], 0b11u);
  EXPECT_EQ(core.progress(kStart).unpolled, std::vector{sensor_id("s2")});
  EXPECT_TRUE(core.registration().sensors.contains(sensor_id("s2"))) << "its place stays";
}

TEST(FusionCore, CountsBodiesOfSensorsWithoutAPlace) {
  FusionCore core(config(), ring(2));
  (void)run(core, Duration{0},
            std::chrono::seconds(4));  // shares are averaged over about one second
  const Timestamp now = kStart + std::chrono::seconds(4);
  for (int i = 0; i < kSensors; ++i) EXPECT_EQ(core.bodies(sensor_id(name(i)), now), 1u);
  EXPECT_GT(core.memory_of(sensor_id("s1")).share.in_time, 0.9);
  EXPECT_EQ(core.memory_of(sensor_id("s3")).share.in_time, 0.0);
  // A sensor that falls silent no longer has bodies.
  (void)run(core, std::chrono::seconds(4), std::chrono::seconds(3), 1);
  EXPECT_EQ(core.bodies(sensor_id("s2"), kStart + std::chrono::seconds(7)), 0u);
  EXPECT_EQ(core.bodies(sensor_id("s1"), kStart + std::chrono::seconds(7)), 1u);
}

TEST(FusionCore, IdsOfPeopleGoOnWhereAnEarlierRunEnded) {
  CoreConfig later = config();
  later.first_person = 4711;
  FusionCore core(later, ring());
  const auto snapshots = run(core, Duration{0}, std::chrono::seconds(2));
  ASSERT_FALSE(snapshots.back().bodies.empty());
  EXPECT_EQ(snapshots.back().bodies[0].id.value, 4711u);
  EXPECT_EQ(core.next_person(), 4712u);
}

TEST(FusionCore, TheRateMayChangeWhileRunning) {
  FusionCore core(config(), ring());
  const auto before = run(core, Duration{0}, std::chrono::seconds(1));
  CoreConfig faster = config();
  faster.output.rate_hz = 60;
  core.reconfigure(faster);
  const auto after = run(core, std::chrono::seconds(1), std::chrono::seconds(1));
  EXPECT_NEAR(static_cast<double>(after.size()), 60.0, 5.0);
  EXPECT_GT(after.front().sequence, before.back().sequence);
  EXPECT_GT(after.front().instant, before.back().instant);
}

/// Result of run_delayed(), which runs as run() does, except that frame i of the last sensor comes
/// `lateness(i)` late.
struct Delayed {
  Answers live;
  std::vector<Snapshot> amended;
  std::vector<double> ages;  ///< [s]
};

template <class Lateness>
Delayed run_delayed(FusionCore& core, Duration length, const Lateness& lateness) {
  Delayed out;
  std::vector<std::pair<Duration, SensorFrame>> on_the_way;
  for (Duration t{0}; t < length; t += milliseconds(1)) {
    for (int i = 0; i < kSensors; ++i) {
      if ((t - milliseconds(7 * i)) % milliseconds(33) != Duration{0}) continue;
      SensorFrame frame = sight(i, t);
      frame.sequence = static_cast<std::uint64_t>(t / milliseconds(33));
      const Duration late = i == kSensors - 1 ? lateness(frame.sequence) : milliseconds(2);
      // Frames of one connection never overtake each other.
      Duration comes = t + late;
      for (const auto& [when, other] : on_the_way)
        if (other.sensor == frame.sensor) comes = std::max(comes, when);
      frame.received = kStart + comes;
      on_the_way.emplace_back(comes, frame);
    }
    for (auto it = on_the_way.begin(); it != on_the_way.end();) {
      if (it->first > t) {
        ++it;
        continue;
      }
      core.take(it->second);
      it = on_the_way.erase(it);
    }
    while (auto snapshot = core.tick(kStart + t)) {
      out.ages.push_back(chorus::seconds(kStart + t - snapshot->instant));
      out.live.push_back(std::move(*snapshot));
      if (auto better = core.amended(kStart + t)) out.amended.push_back(std::move(*better));
    }
  }
  std::sort(out.ages.begin(), out.ages.end());
  return out;
}

double p90(const std::vector<double>& sorted) { return sorted.at(sorted.size() * 9 / 10); }

TEST(FusionCore, OneBadLinkCostsTheOthersAtMostThirtyMillisecondsAndIsUsedAfterwards) {
  const auto steady = [](std::uint64_t) { return milliseconds(2); };
  const auto bad = [](std::uint64_t i) { return milliseconds(i * 7919 % 401); };
  FusionCore good(config(), ring());
  const double before = p90(run_delayed(good, std::chrono::seconds(10), steady).ages);
  FusionCore core(config(), ring());
  const Delayed with = run_delayed(core, std::chrono::seconds(10), bad);
  EXPECT_LT(p90(with.ages), before + 0.030);
  // After the first second, almost all instants include the late sensor once they are amended,
  // under the ids already published.
  std::map<std::uint64_t, const Snapshot*> afterwards;
  for (const Snapshot& snapshot : with.live) afterwards[snapshot.sequence] = &snapshot;
  for (const Snapshot& snapshot : with.amended) {
    if (snapshot.instant < kStart + std::chrono::seconds(1)) continue;
    ASSERT_EQ(snapshot.bodies.size(), 1u);
    EXPECT_EQ(snapshot.bodies[0].id, with.live.back().bodies[0].id);
    afterwards[snapshot.sequence] = &snapshot;
  }
  int all = 0;
  int used = 0;
  for (const auto& [sequence, snapshot] : afterwards) {
    if (snapshot->instant < kStart + std::chrono::seconds(1) ||
        snapshot->instant > kStart + std::chrono::seconds(9))
      continue;
    ++all;
    used += snapshot->bodies.at(0).contributors[index_of(JointId::Neck)] == 0b111U ? 1 : 0;
  }
  EXPECT_GE(used, 0.95 * all);
  const Share share = core.memory_of(sensor_id("s3")).share;
  EXPECT_LT(share.in_time, 0.5);
  EXPECT_GT(share.afterwards, 0.9);
  EXPECT_GT(core.memory_of(sensor_id("s1")).share.in_time, 0.9);
}

TEST(FusionCore, SaysWhoIsWaitedFor) {
  FusionCore core(config(), ring());
  (void)run_delayed(core, std::chrono::seconds(5),
                    [](std::uint64_t i) { return milliseconds(i * 7919 % 91); });
  EXPECT_GT(core.memory_of(sensor_id("s3")).share.awaited, 0.5);
  EXPECT_LT(core.memory_of(sensor_id("s1")).share.awaited, 0.5);
}

TEST(FusionCore, WithoutLateFramesNothingIsAmended) {
  FusionCore core(config(), ring());
  EXPECT_TRUE(run_delayed(core, std::chrono::seconds(5), [](std::uint64_t) {
                return milliseconds(2);
              }).amended.empty());
}

TEST(FusionCore, SaysForAWhileThatFramesAreRefused) {
  FusionCore core(config(), ring());
  (void)run(core, Duration{0}, milliseconds(500));
  EXPECT_EQ(core.memory_of(sensor_id("s1")).losses.complaint(kStart + milliseconds(500)), "");
  SensorFrame back = sight(0, milliseconds(300));
  back.sequence = ~std::uint64_t{0};  // by its number, newer than all other frames
  core.take(back);
  EXPECT_NE(core.memory_of(sensor_id("s1")).losses.complaint(kStart + milliseconds(500)), "");
  EXPECT_EQ(core.memory_of(sensor_id("s1")).losses.complaint(kStart + std::chrono::seconds(4)), "");
}

TEST(FusionCore, ASensorThatWasTakenOutComesBackWithoutItsPast) {
  FusionCore core(config(), ring());
  (void)run(core, Duration{0}, milliseconds(500));
  SensorFrame back = sight(0, milliseconds(300));
  back.sequence = ~std::uint64_t{0};
  core.take(back);
  ASSERT_NE(core.memory_of(sensor_id("s1")).losses.complaint(kStart + milliseconds(500)), "");
  ASSERT_GT(core.memory_of(sensor_id("s1")).share.in_time, 0.0);
  CoreConfig fewer = config();
  fewer.sensors.erase(sensor_id("s1"));
  core.reconfigure(fewer);
  core.reconfigure(config());
  EXPECT_EQ(core.memory_of(sensor_id("s1")).losses.complaint(kStart + milliseconds(500)), "");
  EXPECT_EQ(core.memory_of(sensor_id("s1")).share.in_time, 0.0);
}

TEST(FusionCore, BodiesThatNobodyHasAreLeftOutByName) {
  FusionCore core(config(), ring());
  for (int i = 0; i < 60; ++i) {
    const Duration t = milliseconds(33 * i);
    for (int sensor = 0; sensor < kSensors; ++sensor) {
      SensorFrame frame = sight(sensor, t);
      if (sensor == 0) {
        BodyFrame far = frame.bodies[0];
        far.id = BodyId{99};
        for (Joint& joint : far.skeleton.joints) joint.position.z() += 9999.9;
        frame.bodies.push_back(far);
      }
      core.take(frame);
    }
    while (const auto snapshot = core.tick(kStart + t)) EXPECT_LE(snapshot->bodies.size(), 1u);
  }
  EXPECT_NE(core.memory_of(sensor_id("s1"))
                .losses.complaint(kStart + std::chrono::seconds(2))
                .find("max_range_m"),
            std::string::npos);
  EXPECT_EQ(core.memory_of(sensor_id("s2")).losses.complaint(kStart + std::chrono::seconds(2)), "");
}

}  // namespace
}  // namespace chorus::core
