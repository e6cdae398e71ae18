// Frames whose time is not as it should be: by whose clock they are used, and what becomes of them.
#include <optional>

#include <gtest/gtest.h>

#include "fusion-server/core/fusion_core.h"
#include "tests/unit/core/ring_of_three.h"

namespace chorus::core {
namespace {

using std::chrono::milliseconds;
using testing::kStart;
using testing::sensor_id;

CoreConfig untimely_config() { return of_three<CoreConfig>(); }

/// The clock offset that a walk found is added to a sensor's frames, including those that came
/// before the solve, and is taken back when the registration is.
TEST(UntimelyFrames, AClockThatAWalkToldIsAddedAndUndoneWithIt) {
  const Duration off = milliseconds(400);
  FusionCore core(untimely_config(), ring());
  const auto feed = [&](Duration from, Duration length) {
    std::optional<Snapshot> last;
    for (Duration t = from; t < from + length; t += milliseconds(1)) {
      for (int i = 0; i < kSensors; ++i) {
        if ((t - milliseconds(7 * i)) % milliseconds(33) != Duration{0}) continue;
        SensorFrame frame = sight(i, t);
        frame.sequence = static_cast<std::uint64_t>(t / milliseconds(33));
        frame.received = kStart + t + milliseconds(2);
        if (i == 2) move_in_time(frame, -off);
        frame.clock_sigma = i == 2 ? kUnknownClock : 1e-4;
        core.take(frame);
      }
      while (auto snapshot = core.tick(kStart + t)) last = std::move(snapshot);
    }
    return last->bodies.at(0).contributors[index_of(JointId::Neck)];
  };
  EXPECT_EQ(feed(Duration{0}, std::chrono::seconds(3)), 0b011U) << "its frames are all too old";
  Registration walked = ring();
  walked.clocks[sensor_id("s3")] = {off, milliseconds(4)};
  ASSERT_TRUE(core.start_session(std::chrono::seconds(8), kStart));
  EXPECT_EQ(core.solved({1, SolveKind::Final, walked}, kStart + std::chrono::seconds(3)),
            Outcome::Adopted);
  EXPECT_EQ(feed(std::chrono::seconds(3), std::chrono::seconds(2)), 0b111U);
  EXPECT_EQ(core.memory_of(sensor_id("s3")).clock.walked()->added, off);
  EXPECT_EQ(core.memory_of(sensor_id("s3")).losses.counts(), FrameFates{})
      << "nothing is lost by the change";
  ASSERT_TRUE(core.undo());
  EXPECT_EQ(feed(std::chrono::seconds(5), std::chrono::seconds(2)), 0b011U);
  EXPECT_FALSE(core.memory_of(sensor_id("s3")).clock.walked());
  EXPECT_EQ(core.memory_of(sensor_id("s3")).losses.counts(), FrameFates{});
}

TEST(UntimelyFrames, AreCountedByWhatBecameOfThem) {
  FusionCore core(untimely_config(), ring());
  const SensorId s1 = sensor_id("s1");
  const auto send = [&](Duration captured, std::uint64_t sequence, Duration received) {
    SensorFrame frame = sight(0, captured);
    frame.sequence = sequence;
    frame.received = kStart + received;
    core.take(frame);
  };
  send(std::chrono::seconds(2), 10, std::chrono::seconds(2));
  send(std::chrono::seconds(3), 12, std::chrono::seconds(3));
  send(milliseconds(2500), 11, std::chrono::seconds(3));       // overtaken
  send(std::chrono::seconds(3), 12, std::chrono::seconds(3));  // doubled
  send(std::chrono::seconds(9), 13, std::chrono::seconds(3));  // from the future
  send(std::chrono::seconds(1), 5, std::chrono::seconds(3));   // too late to be of use
  FrameFates expected;
  expected.late = expected.doubled = expected.early = expected.stale = 1;
  EXPECT_EQ(core.memory_of(s1).losses.counts(), expected);
  EXPECT_NE(core.memory_of(s1)
                .losses.complaint(kStart + std::chrono::seconds(3))
                .find("holds frames back"),
            std::string::npos);
  for (const std::uint64_t sequence : {14U, 15U, 16U})
    send(milliseconds(2600 + 33 * static_cast<int>(sequence - 14)), sequence,
         milliseconds(3000 + 33 * static_cast<int>(sequence - 13)));
  EXPECT_EQ(core.memory_of(s1).losses.counts().restarts, 1U);
  EXPECT_EQ(core.memory_of(s1).losses.counts().backwards, 1U)
      << "the stale one was the first of three";
}

}  // namespace
}  // namespace chorus::core
