// Capture times, the playback rate of files, and pauses between attempts.
#include <vector>

#include <gtest/gtest.h>

#include "services/sensor/device/camera/capture_clock.h"
#include "services/sensor/device/camera/file_pace.h"
#include "services/sensor/device/camera/restart_pause.h"

namespace chorus::camera {
namespace {

using namespace std::chrono_literals;

const Timestamp kTimesNoon = from_unix_ns(1'795'246'200'000'000'000);

TEST(CapturedByDriver, TheDriversStampCountsUnlessItCannotBeTrue) {
  EXPECT_EQ(captured_by_driver(kTimesNoon, 25ms, 60ms), kTimesNoon - 25ms);
  EXPECT_EQ(captured_by_driver(kTimesNoon, std::nullopt, 60ms), kTimesNoon - 60ms);
  EXPECT_EQ(captured_by_driver(kTimesNoon, -1ms, 60ms), kTimesNoon - 60ms);
  EXPECT_EQ(captured_by_driver(kTimesNoon, 3s, 60ms), kTimesNoon - 60ms);
}

TEST(StreamClock, StepsAreTheStreamsAndTheFastestPictureSetsTheRest) {
  StreamClock clock(50ms);
  // Pictures every 40 ms that arrive with a delay of 100 ms and up to 30 ms of jitter.
  const Duration jitter[] = {20ms, 0ms, 30ms, 10ms, 25ms};
  std::vector<Timestamp> captured;
  for (int i = 0; i < 5; ++i) {
    const Duration position = i * 40ms;
    captured.push_back(clock.captured(kTimesNoon + 100ms + position + jitter[i], position));
  }
  for (int i = 2; i < 5; ++i) EXPECT_NEAR(seconds(captured[i] - captured[i - 1]), 0.040, 1e-4);
  EXPECT_NEAR(seconds(captured[4] - (kTimesNoon + 100ms + 160ms - 50ms)), 0.0, 1e-4);
}

TEST(StreamClock, FollowsAStreamWhoseClockIsSlower) {
  StreamClock clock(0ms);
  Timestamp last{};
  for (int i = 0; i < 3000; ++i) {  // 2 minutes with a clock that is 100 ppm slow
    const Duration position = i * 40ms;
    last = clock.captured(kTimesNoon + i * (40ms + 4us), position);
  }
  EXPECT_LT(seconds(kTimesNoon + 2999 * (40ms + 4us) - last), 0.001);
}

TEST(StreamClock, BeginsAnewWhenTheStreamDoes) {
  StreamClock clock(0ms);
  (void)clock.captured(kTimesNoon, 100s);
  (void)clock.captured(kTimesNoon + 1s, 101s);
  EXPECT_EQ(clock.captured(kTimesNoon + 10s, 0s), kTimesNoon + 10s);
  EXPECT_EQ(clock.captured(kTimesNoon + 11s, 1s), kTimesNoon + 11s);
  EXPECT_EQ(clock.captured(kTimesNoon + 60s, 2s), kTimesNoon + 60s);
}

TEST(StreamClock, WithoutPositionsArrivalCounts) {
  StreamClock clock(60ms);
  EXPECT_EQ(clock.captured(kTimesNoon, std::nullopt), kTimesNoon - 60ms);
  (void)clock.captured(kTimesNoon + 1s, 0s);
  EXPECT_EQ(clock.captured(kTimesNoon + 2s, 0s), kTimesNoon + 2s - 60ms);
}

TEST(FilePace, OneRoundBeginsNow) {
  FilePace pace(false);
  EXPECT_EQ(pace.begin({40ms, 10s}, kTimesNoon), 0s);
  EXPECT_EQ(pace.due(0s), kTimesNoon);
  EXPECT_EQ(pace.due(40ms), kTimesNoon + 40ms);
  EXPECT_EQ(pace.due(0s), kTimesNoon + 80ms) << "a picture without a time follows the one before";
  EXPECT_EQ(pace.due(std::nullopt), kTimesNoon + 120ms);
}

TEST(FilePace, RoundsOfFilesOfOneLengthAreInStepWhoeverBeginsWhen) {
  const FileTiming timing{40ms, 7s};
  FilePace one(true);
  FilePace other(true);
  const Duration over = one.begin(timing, kTimesNoon);
  EXPECT_LT(over, 7s);
  EXPECT_EQ(one.due(0s), kTimesNoon - over);
  EXPECT_EQ(other.begin(timing, kTimesNoon + 1s), (over + 1s) % 7s);
  EXPECT_EQ((one.due(3s) - other.due(3s)) % 7s, 0s);
  EXPECT_EQ(one.begin(timing, one.due(6960ms)), 0s);
  EXPECT_EQ(one.due(0s), kTimesNoon - over + 7s) << "the next round follows the one before";
}

TEST(FilePace, ARoundThatEndsEarlyOrLateStillFollows) {
  FilePace pace(true);
  const FileTiming timing{40ms, 7s};
  const Timestamp began = kTimesNoon - pace.begin(timing, kTimesNoon);
  EXPECT_EQ(pace.begin(timing, began + 6500ms), 0s);
  EXPECT_EQ(pace.due(0s), began + 7s);
  EXPECT_EQ(pace.begin(timing, began + 14s + 400ms), 0s);
  EXPECT_EQ(pace.due(0s), began + 14s);
  EXPECT_EQ(pace.begin(timing, began + 100s), Duration(100s) % Duration(7s))
      << "after a long pause the step is found anew";
}

TEST(FilePace, WithoutALengthRoundsFollowEachOther) {
  FilePace pace(true);
  EXPECT_EQ(pace.begin({40ms, std::nullopt}, kTimesNoon), 0s);
  (void)pace.due(0s);
  (void)pace.due(40ms);
  EXPECT_EQ(pace.begin({40ms, std::nullopt}, kTimesNoon + 50ms), 0s);
  EXPECT_EQ(pace.due(0s), kTimesNoon + 80ms);
}

TEST(FilePace, WhoFallsBehindGoesOnFromThere) {
  FilePace pace(false);
  (void)pace.begin({40ms, 10s}, kTimesNoon);
  (void)pace.due(0s);
  pace.fall_behind(2s);
  EXPECT_EQ(pace.due(40ms), kTimesNoon + 2040ms);
}

TEST(RestartPause, DoublesAndForgetsAfterGoodTimes) {
  RestartPause pause(500ms, 3s);
  EXPECT_EQ(pause.after(0s), 500ms);
  EXPECT_EQ(pause.after(1s), 1s);
  EXPECT_EQ(pause.after(1s), 2s);
  EXPECT_EQ(pause.after(1s), 3s);
  EXPECT_EQ(pause.after(1s), 3s);
  EXPECT_EQ(pause.after(10s), 500ms);
  EXPECT_EQ(pause.after(0s), 1s);
}

}  // namespace
}  // namespace chorus::camera
