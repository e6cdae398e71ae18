#include "fusion-server/pipeline/offline.h"

#include <algorithm>
#include <cstring>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/registration/walk_builder.h"

namespace chorus::pipeline {
namespace {

using registration::ring_place;
using registration::sensor;
using registration::WalkSpec;
using registration::WalkTrack;
using registration::watch;
using ::testing::HasSubstr;

constexpr int kSensors = 4;

Eigen::Isometry3d true_place(int number) { return ring_place(deg(90) * number); }

std::vector<WalkTrack> walk(const WalkSpec& spec) {
  std::vector<WalkTrack> tracks;
  for (int i = 0; i < kSensors; ++i) tracks.push_back(watch(i, true_place(i), spec));
  return tracks;
}

/// Mean joint error against the walk; `truth_from_world` moves the result into the true world.
double mean_error(const std::vector<Snapshot>& snapshots,
                  const Eigen::Isometry3d& truth_from_world) {
  double sum = 0.0;
  std::size_t count = 0;
  for (const Snapshot& snapshot : snapshots) {
    const double t = seconds(snapshot.instant - registration::kWalkStart);
    const auto truth = registration::person_at(registration::wander(t), 0.5 * t, t);
    for (const FusedBody& body : snapshot.bodies) {
      for (std::size_t i = 0; i < kJointCount; ++i) {
        const Eigen::Vector3d found = truth_from_world * body.skeleton.joints[i].position;
        sum += (found - truth.joints[i].position).norm();
        ++count;
      }
    }
  }
  return count > 0 ? sum / static_cast<double>(count) : 1e9;
}

Registration published() {
  Registration registration;
  for (int i = 0; i < kSensors; ++i) {
    registration.sensors[sensor(i)].world_from_sensor = true_place(i);
  }
  return registration;
}

TEST(FuseOffline, SeatsPeopleAsTheServerDoes) {
  const auto fused = fuse_offline(walk({.noise = 0.02}), published(), {});
  ASSERT_TRUE(fused) << fused.error().message;
  for (const Snapshot& snapshot : fused->snapshots) {
    for (const FusedBody& body : snapshot.bodies) EXPECT_EQ(body.slot, 0u);
  }
}

TEST(FuseOffline, RegistersTheWalkAndBeatsASingleSensor) {
  const auto tracks = walk({.noise = 0.02});
  const auto fused = fuse_offline(tracks, std::nullopt, {});
  ASSERT_TRUE(fused) << fused.error().message;
  const Registration& found = fused->registration;
  const int master = std::stoi(found.master.str().substr(1));
  const Eigen::Isometry3d truth_from_world =
      true_place(master) * found.sensors.at(found.master).world_from_sensor.inverse();
  const double error = mean_error(fused->snapshots, truth_from_world);
  const auto alone = fuse_offline({tracks[0]}, published(), {});
  ASSERT_TRUE(alone);
  EXPECT_LT(error, 0.75 * mean_error(alone->snapshots, Eigen::Isometry3d::Identity()));
}

TEST(FuseOffline, EveryInstantOnceAtTheGrid) {
  const auto fused = fuse_offline(walk({.length = 10}), published(), {});
  ASSERT_TRUE(fused);
  EXPECT_NEAR(static_cast<double>(fused->snapshots.size()), 300.0, 2.0);
  for (std::size_t i = 0; i < fused->snapshots.size(); ++i) {
    const Snapshot& snapshot = fused->snapshots[i];
    EXPECT_EQ(snapshot.sequence, i + 1);
    EXPECT_LE((to_unix_ns(snapshot.instant) * 3 + 2) % 100'000'000, 4);  // k/30 s, rounded
  }
}

TEST(FuseOffline, SensorsWithoutARecordingTakeNoPart) {
  auto two = walk({.noise = 0.02});
  two.resize(2);
  const auto fused = fuse_offline(two, published(), {});
  ASSERT_TRUE(fused) << fused.error().message;
  for (const Snapshot& snapshot : fused->snapshots)
    ASSERT_EQ(snapshot.sensors, (std::vector{sensor(0), sensor(1)}));
}

TEST(FuseOffline, GivenExtrinsicsAreUsedAsTheyAre) {
  const auto fused = fuse_offline(walk({.length = 5, .noise = 0.0}), published(), {});
  ASSERT_TRUE(fused);
  EXPECT_LT(mean_error(fused->snapshots, Eigen::Isometry3d::Identity()), mm(2));
}

TEST(FuseOffline, StatesWhatTheGivenExtrinsicsLeaveOpen) {
  const auto tracks = walk({.length = 2, .noise = 0.02});
  Registration loose = published();
  for (auto& [sensor, place] : loose.sensors) place.covariance(4, 4) = 0.05 * 0.05;
  const auto exact = fuse_offline(tracks, published(), {});
  const auto open = fuse_offline(tracks, loose, {});
  ASSERT_TRUE(exact && open && !exact->snapshots.empty());
  ASSERT_EQ(open->snapshots.size(), exact->snapshots.size());
  const auto upward = [](const Snapshot& snapshot) {
    const Joint& neck = snapshot.bodies.at(0).skeleton[JointId::Neck];
    return neck.covariance.matrix()(1, 1);
  };
  EXPECT_GT(upward(open->snapshots.back()) - upward(exact->snapshots.back()), 0.15 * 0.05 * 0.05);
}

TEST(FuseOffline, SameInputsSameBytes) {
  const auto tracks = walk({.length = 5});
  const auto first = fuse_offline(tracks, std::nullopt, {});
  const auto second = fuse_offline(tracks, std::nullopt, {});
  ASSERT_TRUE(first && second);
  ASSERT_EQ(first->snapshots.size(), second->snapshots.size());
  for (std::size_t i = 0; i < first->snapshots.size(); ++i) {
    ASSERT_EQ(first->snapshots[i].bodies.size(), second->snapshots[i].bodies.size());
    for (std::size_t b = 0; b < first->snapshots[i].bodies.size(); ++b) {
      const auto& one = first->snapshots[i].bodies[b];
      const auto& two = second->snapshots[i].bodies[b];
      for (std::size_t j = 0; j < kJointCount; ++j) {
        EXPECT_EQ(one.skeleton.joints[j].position, two.skeleton.joints[j].position);
      }
      EXPECT_EQ(one.variance, two.variance);
    }
  }
}

/// Recordings from hosts without a common clock are synchronised by the walk and then fused.
TEST(FuseOffline, WithoutACommonClockTheWalkTellsTheClocks) {
  const auto in_step = walk({.noise = 0.005});
  auto tracks = in_step;
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    for (SensorFrame& frame : tracks[i].frames) {
      move_in_time(frame, std::chrono::milliseconds(150 * static_cast<int>(i)));
      frame.clock_sigma = 0.5;
    }
  }
  const auto fused = fuse_offline(tracks, std::nullopt, {});
  ASSERT_TRUE(fused) << fused.error().message;
  const auto right = fuse_offline(in_step, std::nullopt, {});
  ASSERT_TRUE(right);
  const auto error = [](const OfflineResult& result) {
    const int master = std::stoi(result.registration.master.str().substr(1));
    const auto& place = result.registration.sensors.at(result.registration.master);
    return mean_error(result.snapshots, true_place(master) * place.world_from_sensor.inverse());
  };
  EXPECT_EQ(fused->registration.clocks.size(), 4u);
  EXPECT_LT(error(*fused), error(*right) + mm(10));
}

TEST(FuseOffline, LatenciesThatTheWalkToldAreTakenOff) {
  OfflineConfig config;
  config.pipeline.fusion.method = fusion::Method::Mean;  // a robust one leaves a late sensor out
  auto tracks = walk({.noise = 0.005});
  const auto right = fuse_offline(tracks, std::nullopt, config);
  for (SensorFrame& frame : tracks[1].frames) move_in_time(frame, std::chrono::milliseconds(60));
  OfflineConfig off = config;
  off.registration.latency_sigma = Duration{0};
  const auto late = fuse_offline(tracks, std::nullopt, off);
  const auto fused = fuse_offline(tracks, std::nullopt, config);
  ASSERT_TRUE(right && late && fused);
  const auto error = [](const OfflineResult& result) {
    const int master = std::stoi(result.registration.master.str().substr(1));
    const auto& place = result.registration.sensors.at(result.registration.master);
    return mean_error(result.snapshots, true_place(master) * place.world_from_sensor.inverse());
  };
  EXPECT_TRUE(fused->registration.latencies.at(tracks[1].sensor).applied);
  EXPECT_LT(error(*fused), error(*right) + mm(2));
  EXPECT_GT(error(*late), error(*right) + mm(4)) << "else there was nothing to take off";
}

/// Frames without bodies need memory, too, so a recording whose capture times stand still is given
/// up.
TEST(FuseOffline, ARecordingOfEmptyFramesThatStandsStillIsRefused) {
  OfflineInput input;
  SensorFrame empty;
  empty.sensor = sensor(0);
  empty.captured = from_unix_ns(1'790'000'000'000'000'000);
  input.lanes.push_back(
      {"still", [empty]() -> Result<std::optional<SensorFrame>> { return std::optional(empty); }});
  input.sensors = {empty.sensor};
  const auto done = fuse_recordings(std::move(input), published(), {},
                                    [](const Snapshot&) -> Result<void> { return {}; });
  ASSERT_FALSE(done);
  EXPECT_EQ(done.error().code, ErrorCode::TooLarge);
}

TEST(FuseOffline, AGapOfAYearIsSkippedNotCounted) {
  auto tracks = walk({.length = 4});
  for (WalkTrack& track : tracks) {
    for (std::size_t i = track.frames.size() / 2; i < track.frames.size(); ++i) {
      track.frames[i].captured += std::chrono::hours(24 * 365);
    }
  }
  const auto fused = fuse_offline(tracks, published(), {});
  ASSERT_TRUE(fused);
  EXPECT_NEAR(static_cast<double>(fused->snapshots.size()), 120.0, 6.0);
}

TEST(FuseOffline, TimeGoingBackwardsInARecordingIsSurvived) {
  auto tracks = walk({.length = 4});
  std::swap(tracks[0].frames[30], tracks[0].frames[60]);
  std::reverse(tracks[1].frames.begin(), tracks[1].frames.end());
  const auto fused = fuse_offline(tracks, published(), {});
  ASSERT_TRUE(fused);
  EXPECT_GT(fused->snapshots.size(), 100u);
}

TEST(FuseOffline, RefusesWhatCannotWork) {
  const auto tracks = walk({.length = 1});
  EXPECT_FALSE(fuse_offline({}, published(), {}));
  EXPECT_FALSE(fuse_offline({{sensor(1), {}}}, published(), {}));
  EXPECT_FALSE(fuse_offline({tracks[0], tracks[0]}, published(), {}));
  for (const double rate : {0.0, -30.0, std::nan(""), 1e9, 1e-4, 1e-300}) {
    OfflineConfig config;
    config.rate_hz = rate;
    EXPECT_FALSE(fuse_offline(tracks, published(), config)) << rate;
  }
}

TEST(FuseOffline, SaysWhyTheWalkCouldNotBeRegistered) {
  auto tracks = walk({.length = 4});
  tracks.resize(2);
  for (SensorFrame& frame : tracks[1].frames) frame.captured += std::chrono::hours(1);
  const auto fused = fuse_offline(tracks, std::nullopt, {});
  ASSERT_FALSE(fused);
  EXPECT_THAT(fused.error().message, HasSubstr("sensors s0 and s1 never saw the person together"));
}

/// All tracks as one recording: in the order of capture, regardless of the sensor.
std::vector<SensorFrame> as_recorded(const std::vector<WalkTrack>& tracks) {
  std::vector<SensorFrame> frames;
  for (const WalkTrack& track : tracks)
    frames.insert(frames.end(), track.frames.begin(), track.frames.end());
  std::ranges::stable_sort(frames, {}, &SensorFrame::captured);
  return frames;
}

FrameLane lane_of(const std::vector<SensorFrame>& frames, std::size_t& taken) {
  return {"cell", [&frames, &taken]() -> Result<std::optional<SensorFrame>> {
            if (taken == frames.size()) return std::nullopt;
            return frames[taken++];
          }};
}

TEST(FuseRecordings, OneLaneOfAllSensorsGivesWhatTracksInMemoryGive) {
  auto tracks = walk({.length = 6});
  // s1 is silent for a while, then all are.
  std::erase_if(tracks[1].frames, [](const SensorFrame& frame) {
    return frame.captured > registration::kWalkStart + std::chrono::seconds(2) &&
           frame.captured < registration::kWalkStart + std::chrono::seconds(4);
  });
  for (WalkTrack& track : tracks) {
    for (SensorFrame& frame : track.frames) {
      if (frame.captured > registration::kWalkStart + std::chrono::seconds(5))
        frame.captured += std::chrono::hours(3);
    }
  }
  const auto whole = fuse_offline(tracks, published(), {});
  ASSERT_TRUE(whole);
  const auto frames = as_recorded(tracks);
  std::size_t taken = 0;
  std::vector<Snapshot> snapshots;
  const OfflineConfig config;
  const auto registration = published();
  const auto done = fuse_recordings({{lane_of(frames, taken)}, {}}, registration, config,
                                    [&](Snapshot snapshot) -> Result<void> {
                                      EXPECT_LE(taken, 4 * 30 * (snapshots.size() / 30 + 8))
                                          << "it reads a few seconds ahead, not all";
                                      snapshots.push_back(std::move(snapshot));
                                      return {};
                                    });
  ASSERT_TRUE(done) << to_string(done.error());
  ASSERT_EQ(snapshots.size(), whole->snapshots.size());
  for (std::size_t i = 0; i < snapshots.size(); ++i) {
    EXPECT_EQ(snapshots[i].instant, whole->snapshots[i].instant);
    ASSERT_EQ(snapshots[i].bodies.size(), whole->snapshots[i].bodies.size());
    for (std::size_t b = 0; b < snapshots[i].bodies.size(); ++b)
      EXPECT_EQ(snapshots[i].bodies[b].skeleton[JointId::Head].position,
                whole->snapshots[i].bodies[b].skeleton[JointId::Head].position);
  }
}

TEST(FuseRecordings, RefusesASensorThatTwoRecordingsHold) {
  const auto frames = as_recorded(walk({.length = 1}));
  std::size_t first = 0;
  std::size_t second = 0;
  const OfflineConfig config;
  const auto registration = published();
  const auto done =
      fuse_recordings({{lane_of(frames, first), lane_of(frames, second)}, {}}, registration, config,
                      [](const Snapshot&) { return Result<void>(); });
  ASSERT_FALSE(done);
  EXPECT_EQ(done.error().code, ErrorCode::Conflict);
}

TEST(RegisterRecordings, TakesTheFirstMinutesAndReadsNoFurther) {
  const auto tracks = walk({.length = 150});
  const auto frames = as_recorded(tracks);
  std::size_t taken = 0;
  const auto found = register_recordings({{lane_of(frames, taken)}, {}}, {});
  ASSERT_TRUE(found) << to_string(found.error());
  EXPECT_EQ(found->verdict, Verdict::Good);
  EXPECT_EQ(found->sensors.size(), 4u);
  EXPECT_LT(taken, frames.size() * 130 / 150);
}

TEST(RegisterRecordings, ReadsOnWhileSensorsAreMissing) {
  auto tracks = walk({.length = 200});
  std::erase_if(tracks[3].frames, [](const SensorFrame& frame) {
    return frame.captured < registration::kWalkStart + std::chrono::seconds(150);
  });
  const auto frames = as_recorded(tracks);
  std::size_t taken = 0;
  const auto found = register_recordings({{lane_of(frames, taken)}, {sensor(3)}}, {});
  ASSERT_TRUE(found) << to_string(found.error());
  EXPECT_EQ(found->sensors.size(), 4u) << "s3 came late";
}

}  // namespace
}  // namespace chorus::pipeline
