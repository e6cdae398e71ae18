// trackd's segments as seen by another program: attached by key, and removed afterwards.
#include <sys/shm.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <optional>

#include <gtest/gtest.h>

#include "fusion-server/trackd/trackd_outlet.h"
#include "tests/support/builders.h"
#include "tests/support/matchers.h"

namespace chorus::trackd {
namespace {

using testing::FailsWith;
using testing::IsOk;

/// Settings with two keys that nobody else uses.
Settings settings_of_this_test() {
  Settings settings;
  settings.tracker_key = 0x43000000 + static_cast<int>(::getpid() & 0xFFFFF) * 2;
  settings.controller_key = settings.tracker_key + 1;
  return settings;
}

bool there(int key) { return ::shmget(key, 0, 0) >= 0 || errno != ENOENT; }

/// A reader like VR Juggler's: attaches read-write and follows the header.
class Reader {
 public:
  explicit Reader(int key) : place_(::shmat(::shmget(key, 0, 0), nullptr, 0)) {}
  ~Reader() { ::shmdt(place_); }
  template <class T>
  [[nodiscard]] T at(std::size_t offset) const {
    T value;
    std::memcpy(&value, static_cast<const char*>(place_) + offset, sizeof value);
    return value;
  }
  [[nodiscard]] bool sees_a_head() const { return at<std::int32_t>(sensor(0) + 32) == 1; }
  [[nodiscard]] std::size_t sensor(std::uint32_t i) const {
    return at<std::uint32_t>(8) + i * at<std::uint32_t>(12);
  }
  void scribble() { std::memset(place_, 0xAB, 28); }

 private:
  void* place_;
};

outlet::TrackerFrame frame_of_somebody() {
  Snapshot snapshot;
  snapshot.sequence = 12;
  snapshot.instant = testing::kStart;
  snapshot.bodies.resize(1);
  snapshot.bodies[0].slot = 0;
  snapshot.bodies[0].skeleton = testing::standing_person({0.3, 0, 0.6});
  outlet::TrackerState state(6);
  return state.advance(snapshot);
}

TEST(TrackdSegment, AnotherProgramReadsTheHeadInFeet) {
  const Settings settings = settings_of_this_test();
  const auto outlet = open_outlet(settings, {});
  ASSERT_THAT(outlet, IsOk());
  const Reader reader(settings.tracker_key);
  EXPECT_EQ(reader.at<std::uint32_t>(0), 1u);
  EXPECT_EQ(reader.at<std::uint32_t>(4), 150u);
  EXPECT_EQ(reader.at<std::uint32_t>(16), 0u);
  (*outlet)->send(frame_of_somebody());
  EXPECT_EQ(reader.at<std::uint32_t>(16), 1'795'246'200u);
  EXPECT_NEAR(static_cast<double>(reader.at<float>(reader.sensor(0))), 0.3 / 0.3048, 1e-4);
  EXPECT_NEAR(static_cast<double>(reader.at<float>(reader.sensor(0) + 4)), 1.65 / 0.3048, 1e-4);
  EXPECT_EQ(reader.at<std::int32_t>(reader.sensor(0) + 32), 1);
  EXPECT_EQ(reader.at<std::int32_t>(reader.sensor(25) + 32), 0);
  const Reader controller(settings.controller_key);
  EXPECT_EQ(controller.at<std::uint32_t>(4), 32u);
}

TEST(TrackdSegment, AReaderThatWritesNonsenseHarmsOnlyItself) {
  const Settings settings = settings_of_this_test();
  const auto outlet = open_outlet(settings, {});
  ASSERT_THAT(outlet, IsOk());
  Reader vandal(settings.tracker_key);
  vandal.scribble();
  (*outlet)->send(frame_of_somebody());
  EXPECT_EQ(vandal.at<std::uint32_t>(16), 1'795'246'200u);
}

TEST(TrackdSegment, IsGoneAtTheEnd) {
  const Settings settings = settings_of_this_test();
  {
    const auto outlet = open_outlet(settings, {});
    ASSERT_THAT(outlet, IsOk());
    EXPECT_TRUE(there(settings.tracker_key) && there(settings.controller_key));
  }
  EXPECT_FALSE(there(settings.tracker_key) || there(settings.controller_key));
}

TEST(TrackdSegment, OneThatIsInUseIsRefusedAndLeftAlone) {
  const Settings settings = settings_of_this_test();
  const auto first = open_outlet(settings, {});
  ASSERT_THAT(first, IsOk());
  const auto second = open_outlet(settings, {});
  ASSERT_THAT(second, FailsWith(ErrorCode::Conflict));
  EXPECT_NE(second.error().message.find("still runs"), std::string::npos);
  EXPECT_TRUE(there(settings.tracker_key));
}

/// Lets another process create a segment and end without removing it.
void leave_behind(int key, std::size_t bytes) {
  const pid_t child = ::fork();
  if (child == 0) ::_exit(::shmget(key, bytes, IPC_CREAT | IPC_EXCL | 0666) < 0 ? 1 : 0);
  int status = 1;
  ::waitpid(child, &status, 0);
  ASSERT_EQ(status, 0);
}

TEST(TrackdSegment, OneOfAnotherSizeIsRefusedAndLeftAlone) {
  const Settings settings = settings_of_this_test();
  leave_behind(settings.tracker_key, 100);
  const auto outlet = open_outlet(settings, {});
  ASSERT_THAT(outlet, FailsWith(ErrorCode::Conflict));
  EXPECT_NE(outlet.error().message.find("100 bytes, not 6028"), std::string::npos)
      << outlet.error().message;
  const int id = ::shmget(settings.tracker_key, 0, 0);
  EXPECT_EQ(::shmctl(id, IPC_RMID, nullptr), 0);
}

TEST(TrackdSegment, OneThatACrashedServerLeftBehindIsUsed) {
  const Settings settings = settings_of_this_test();
  leave_behind(settings.tracker_key, 6028);
  const auto outlet = open_outlet(settings, {});
  ASSERT_THAT(outlet, IsOk());
  EXPECT_EQ(Reader(settings.tracker_key).at<std::uint32_t>(4), 150u);
}

TEST(TrackdSegment, AnAttachedReaderSeesTheEndAndTheRestart) {
  const Settings settings = settings_of_this_test();
  auto outlet = open_outlet(settings, {});
  ASSERT_THAT(outlet, IsOk());
  {
    const Reader reader(settings.tracker_key);
    (*outlet)->send(frame_of_somebody());
    EXPECT_TRUE(reader.sees_a_head());
    outlet->reset();
    EXPECT_FALSE(reader.sees_a_head()) << "nobody is tracked any more";
    EXPECT_FALSE(there(settings.controller_key)) << "nobody was attached to that one";
    outlet = open_outlet(settings, {});
    ASSERT_THAT(outlet, IsOk());
    (*outlet)->send(frame_of_somebody());
    EXPECT_TRUE(reader.sees_a_head()) << "the same segment";
  }
  outlet->reset();
  EXPECT_FALSE(there(settings.tracker_key));
}

TEST(TrackdSegment, AnAttachedReaderSeesTheRestartAfterACrash) {
  const Settings settings = settings_of_this_test();
  const pid_t child = ::fork();
  if (child == 0) {
    const auto crashed = open_outlet(settings, {});
    if (crashed) (*crashed)->send(frame_of_somebody());
    ::_exit(crashed ? 0 : 1);
  }
  int status = 1;
  ::waitpid(child, &status, 0);
  ASSERT_EQ(status, 0);
  std::optional<Reader> reader(settings.tracker_key);
  ASSERT_TRUE(reader->sees_a_head());
  const auto outlet = open_outlet(settings, {});
  ASSERT_THAT(outlet, IsOk());
  EXPECT_FALSE(reader->sees_a_head());
  (*outlet)->send(frame_of_somebody());
  EXPECT_TRUE(reader->sees_a_head());
  reader.reset();  // an attached reader would keep the segment alive
}

TEST(TrackdSegment, OneTakenOverFromADeadRunIsNotTakenFromTheNewOne) {
  const Settings settings = settings_of_this_test();
  leave_behind(settings.tracker_key, 6028);
  const auto first = open_outlet(settings, {});
  ASSERT_THAT(first, IsOk());
  EXPECT_THAT(open_outlet(settings, {}), FailsWith(ErrorCode::Conflict));
}

}  // namespace
}  // namespace chorus::trackd
