#include "services/sensor/device/replay/replay.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/record/cell_writer.h"
#include "tests/support/builders.h"
#include "tests/support/temporary_folder.h"

namespace chorus::sensor_service {
namespace {

using chorus::testing::kFrameInterval;
using chorus::testing::kStart;
using chorus::testing::sensor_id;
using std::chrono::milliseconds;

const Timestamp kRecorded = from_unix_ns(1'600'000'000'000'000'000);

record::FrameRecording recording(int frames) {
  record::FrameRecording out;
  out.sensor = sensor_id("cam01");
  out.device = "Kinect v2";
  out.floor = FloorPlane{Eigen::Vector3d::UnitY(), 1.2};
  const auto pose = chorus::testing::ring_sensor(0, 1);
  for (int i = 0; i < frames; ++i) {
    const Timestamp t = kRecorded + kFrameInterval * i;
    out.frames.push_back(chorus::testing::sensor_frame(
        "cam01", t,
        {chorus::testing::body_seen_from(pose, chorus::testing::standing_person(), t, 7)}));
  }
  return out;
}

/// Plays recordings by a clock that jumps to every instant that is waited for, so that no test
/// sleeps.
struct Played {
  std::shared_ptr<FakeClock> clock = std::make_shared<FakeClock>(kStart);
  std::vector<Capture> captures;
  Result<void> result;
  synthetic::HostClock host = {};

  void play(const record::FrameRecording& from, const ReplayOptions& options, std::size_t at_most) {
    play(tape_of(from).value(), options, at_most);
  }

  void play(std::unique_ptr<ReplayTape> tape, const ReplayOptions& options, std::size_t at_most) {
    std::stop_source stop;
    const auto wait = [&](auto, Timestamp until) {
      clock->set(std::max(until, clock->now()));
      return !stop.stop_requested();
    };
    auto device = make_replay(std::move(tape), options, sensor_id("s1"), {clock, wait, host});
    ASSERT_TRUE(device) << to_string(device.error());
    result = (*device)->run(stop.get_token(), [&](Capture capture) {
      captures.push_back(std::move(capture));
      if (captures.size() >= at_most) stop.request_stop();
    });
  }
};

TEST(Replay, StampsFramesAnewAndKeepsTheirSteps) {
  Played played;
  played.play(recording(5), {}, 5);
  ASSERT_TRUE(played.result);
  ASSERT_EQ(played.captures.size(), 5u);
  for (std::size_t i = 0; i < 5; ++i) {
    const SensorFrame& frame = played.captures[i].frame;
    EXPECT_EQ(frame.sensor.str(), "s1");
    EXPECT_EQ(frame.sequence, i + 1);
    EXPECT_EQ(frame.captured, kStart + kFrameInterval * static_cast<int>(i));
    ASSERT_EQ(frame.bodies.size(), 1u);
    EXPECT_EQ(frame.bodies[0].captured, frame.captured);
    EXPECT_EQ(frame.bodies[0].id.value, 7u);
    ASSERT_TRUE(frame.floor) << "the recording's floor plane is kept";
    EXPECT_EQ(frame.floor->offset, 1.2);
  }
}

TEST(Replay, AHostsClockStampsFramesButDoesNotMoveWhatWasSeen) {
  Played right, wrong;
  wrong.host = {.offset = 2.0, .drift = 1e-3, .step = -5.0, .origin = kStart};
  wrong.host.step_at = kStart + 10 * kFrameInterval;
  for (Played* each : {&right, &wrong}) each->play(recording(30), {.epoch_at = kStart}, 20);
  ASSERT_EQ(wrong.captures.size(), right.captures.size());
  for (std::size_t i = 0; i < right.captures.size(); ++i) {
    const SensorFrame& frame = wrong.captures[i].frame;
    EXPECT_EQ(frame.sequence, right.captures[i].frame.sequence);
    EXPECT_EQ(frame.captured, wrong.host.host_time(right.captures[i].frame.captured)) << i;
    EXPECT_EQ(frame.received, wrong.host.host_time(right.captures[i].frame.received)) << i;
    EXPECT_EQ(frame.bodies.at(0).captured, frame.captured);
  }
}

TEST(Replay, PlaysAFileAsItPlaysMemory) {
  const chorus::testing::TemporaryFolder folder;
  const auto source = recording(100);
  ASSERT_TRUE(record::write_frame_recording(folder / "cam01.mcap", source));
  auto tape = open_tape(folder / "cam01.mcap", sensor_id("s1"));
  ASSERT_TRUE(tape) << to_string(tape.error());
  EXPECT_EQ((*tape)->span().frames, 100u);
  EXPECT_EQ((*tape)->span().last, source.frames.back().captured);
  Played from_file, from_memory;
  from_file.play(std::move(*tape), {}, 250);
  from_memory.play(source, {}, 250);
  ASSERT_EQ(from_file.captures.size(), 250u);
  for (std::size_t i = 0; i < 250; ++i) {
    const SensorFrame& frame = from_file.captures[i].frame;
    EXPECT_EQ(frame.sequence, from_memory.captures[i].frame.sequence);
    EXPECT_EQ(frame.captured, from_memory.captures[i].frame.captured);
    EXPECT_EQ(frame.floor->offset, 1.2);
  }
  EXPECT_FALSE(open_tape(folder / "none.mcap", sensor_id("s1")));
}

TEST(Replay, LeavesOutWhatADeadSensorHadLeftOver) {
  const chorus::testing::TemporaryFolder folder;
  auto writer = record::CellWriter::create(folder / "cell.mcap", {});
  ASSERT_TRUE(writer);
  for (const int i : {-9000, 0, 1, 2, 3, 4}) {
    auto frame = std::make_shared<resource::FrameResource>();
    frame->sequence = static_cast<std::uint64_t>(i + 9001);
    frame->captured = kStart + kFrameInterval * i;
    frame->source = "s1";
    const Timestamp received = kStart + kFrameInterval * std::max(i, 0);
    ASSERT_TRUE(writer->write(record::RawFrame{sensor_id("s1"), frame, received, {}, {}}));
  }
  ASSERT_TRUE(writer->close());
  auto tape = open_tape(folder / "cell.mcap", sensor_id("s1"));
  ASSERT_TRUE(tape) << to_string(tape.error());
  EXPECT_EQ((*tape)->span().first, kStart);
  EXPECT_EQ((*tape)->span().frames, 5u);
  Played played;
  played.play(std::move(*tape), {}, 12);
  ASSERT_EQ(played.captures.size(), 12u) << "in later rounds, too";
  for (std::size_t i = 1; i < played.captures.size(); ++i)
    EXPECT_EQ(played.captures[i].frame.captured - played.captures[i - 1].frame.captured,
              kFrameInterval);
}

TEST(Replay, LoopsWithoutGapOrRepeatedTime) {
  Played played;
  played.play(recording(5), {}, 23);
  ASSERT_EQ(played.captures.size(), 23u);
  for (std::size_t i = 1; i < played.captures.size(); ++i) {
    EXPECT_EQ(played.captures[i].frame.captured - played.captures[i - 1].frame.captured,
              kFrameInterval);
    EXPECT_EQ(played.captures[i].frame.sequence, i + 1);
  }
}

TEST(Replay, EndsWithoutLoop) {
  Played played;
  played.play(recording(5), {.loop = false}, 100);
  EXPECT_TRUE(played.result);
  EXPECT_EQ(played.captures.size(), 5u);
}

TEST(Replay, AsRecordedKeepsTheTimes) {
  Played played;
  played.play(recording(5), {.loop = false, .epoch = ReplayEpoch::AsRecorded}, 100);
  ASSERT_EQ(played.captures.size(), 5u);
  EXPECT_EQ(played.captures[4].frame.captured, kRecorded + 4 * kFrameInterval);
  EXPECT_EQ(played.captures[4].frame.received, kStart + 4 * kFrameInterval) << "in real time";
}

TEST(Replay, ProcessesWithOneEpochStayInStep) {
  auto first = recording(30);
  auto second = recording(30);
  second.frames.erase(second.frames.begin(), second.frames.begin() + 10);
  for (auto* one : {&first, &second}) {
    one->notes["set_origin"] = to_iso8601(kRecorded);
    one->notes["set_period_ns"] = std::to_string(std::chrono::seconds(2) / Duration(1));
  }
  Played early, late;
  early.play(first, {.epoch_at = kStart - std::chrono::seconds(1)}, 100);
  late.clock->advance(milliseconds(1234));
  late.play(second, {.epoch_at = kStart - std::chrono::seconds(1)}, 60);
  const auto time_of = [](const Capture& c) {
    return (c.frame.captured - kStart + std::chrono::seconds(1)) % std::chrono::seconds(2);
  };
  for (const Capture& capture : early.captures) EXPECT_LT(time_of(capture), kFrameInterval * 30);
  for (const Capture& capture : late.captures) {
    EXPECT_GE(time_of(capture), kFrameInterval * 10) << "frame 10 is its first in every round";
    const auto twin =
        std::find_if(early.captures.begin(), early.captures.end(),
                     [&](const Capture& c) { return c.frame.captured == capture.frame.captured; });
    if (capture.frame.captured <= early.captures.back().frame.captured) {
      EXPECT_NE(twin, early.captures.end()) << "both saw this instant";
    }
  }
}

TEST(Replay, AfterASleepItSkipsInsteadOfPouringOutThePast) {
  const auto clock = std::make_shared<FakeClock>(kStart);
  std::stop_source stop;
  auto device = make_replay(tape_of(recording(30)).value(), {}, sensor_id("s1"),
                            {clock, [&](auto, Timestamp until) {
                               clock->set(std::max(until, clock->now()));
                               return !stop.stop_requested();
                             }});
  ASSERT_TRUE(device);
  std::vector<std::uint64_t> sequences;
  (void)(*device)->run(stop.get_token(), [&](const Capture& capture) {
    EXPECT_LT(clock->now() - capture.frame.captured, std::chrono::seconds(1));
    sequences.push_back(capture.frame.sequence);
    if (sequences.size() == 3) clock->advance(std::chrono::seconds(10));
    if (sequences.size() == 6) stop.request_stop();
  });
  EXPECT_THAT(sequences, ::testing::ElementsAre(1, 2, 3, 304, 305, 306)) << "301 frames in 10 s";
}

TEST(Replay, DescribesItself) {
  auto source = recording(30);
  source.intrinsics = Intrinsics{.width = 1920};
  const auto device = make_replay(tape_of(source).value(), {.recording = "/x/cam01.mcap"},
                                  sensor_id("s1"), {std::make_shared<FakeClock>(kStart), {}});
  const DeviceDescription description = (*device)->describe();
  EXPECT_EQ(description.kind, "replay");
  EXPECT_EQ(description.label, "replay of cam01.mcap (Kinect v2)");
  ASSERT_TRUE(description.depth_camera);
  EXPECT_EQ(description.depth_camera->width, 1920);
  EXPECT_NEAR(description.nominal_rate_hz, 30.0, 0.01);
}

TEST(Replay, AnEmptyRecordingIsRefused) {
  const auto tape = tape_of({});
  ASSERT_FALSE(tape);
  EXPECT_THAT(tape.error().message, ::testing::HasSubstr("no frames"));
}

TEST(ReplayOptions, AreReadWithTheirRanges) {
  auto good = ConfigReader::parse(
      R"({"recording": "a.mcap", "loop": false, "speed": 2, "epoch": "as-recorded",
          "epoch_ns": 1795246200000000000, "period_ns": 5000000000})",
      "test");
  const ReplayOptions options = read_replay_options(*good);
  ASSERT_TRUE(good->finish());
  EXPECT_EQ(options.recording, "a.mcap");
  EXPECT_FALSE(options.loop);
  EXPECT_EQ(options.speed, 2.0);
  EXPECT_EQ(options.epoch, ReplayEpoch::AsRecorded);
  EXPECT_EQ(options.epoch_at, from_unix_ns(1'795'246'200'000'000'000));
  EXPECT_EQ(options.period, Duration(std::chrono::seconds(5)));
  EXPECT_FALSE(options.origin);
  auto bad = ConfigReader::parse(R"({"speed": 0, "epoch": "yesterday", "lop": true})", "test");
  (void)read_replay_options(*bad);
  const auto problems = bad->finish();
  ASSERT_FALSE(problems);
  for (const char* key : {"speed", "epoch", "lop"}) {
    EXPECT_THAT(to_string(problems.error()), ::testing::HasSubstr(key));
  }
}

}  // namespace
}  // namespace chorus::sensor_service
