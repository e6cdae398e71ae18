#include "common/record/recorder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <condition_variable>
#include <csignal>
#include <future>
#include <limits>
#include <map>
#include <mutex>
#include <random>

#include "common/record/cell_reader.h"
#include "tests/support/builders.h"
#include "tests/support/temporary_folder.h"

namespace chorus::record {
namespace {

using chorus::testing::TemporaryFolder;
/// The files that this process has asked the disk to sync.
class Disk {
 public:
  static Disk& of_test() {
    static Disk disk;
    return disk;
  }

  void note(int file) {
    std::error_code error;
    const auto link = "/proc/self/fd/" + std::to_string(file);
    const std::string path = std::filesystem::read_symlink(link, error).string();
    const std::scoped_lock lock(mutex_);
    ++syncs_[path];
    noted_.notify_all();
  }

  std::size_t syncs_of(const std::filesystem::path& path) {
    const std::scoped_lock lock(mutex_);
    return syncs_[path.string()];
  }

  bool waits_for_sync_of(const std::string& path) {
    std::unique_lock lock(mutex_);
    return noted_.wait_for(lock, std::chrono::seconds(20), [&] { return syncs_[path] > 0; });
  }

 private:
  std::mutex mutex_;
  std::condition_variable noted_;
  std::map<std::string, std::size_t> syncs_;
};

}  // namespace
}  // namespace chorus::record

// Replaces the C library's function: records the file, then makes the system call.
extern "C" int fdatasync(int file) {
  chorus::record::Disk::of_test().note(file);
  return static_cast<int>(::syscall(SYS_fdatasync, file));
}
extern "C" int fsync(int file) {
  chorus::record::Disk::of_test().note(file);
  return static_cast<int>(::syscall(SYS_fsync, file));
}

namespace chorus::record {
namespace {

using chorus::testing::kFrameInterval;
using chorus::testing::kStart;
using ::testing::HasSubstr;
using ::testing::SizeIs;

constexpr auto kPatience = std::chrono::seconds(20);  // never waited for unless something is broken

RawFrame raw(int i, int bodies = 0) {
  const Timestamp t = kStart + kFrameInterval * i;
  auto frame = std::make_shared<resource::FrameResource>();
  frame->sequence = static_cast<std::uint64_t>(i) + 1;
  frame->captured = t;
  frame->source = "s1";
  static std::minstd_rand random(1);
  for (int b = 0; b < bodies; ++b) {
    auto& body = frame->bodies.emplace_back();
    body.id = static_cast<std::uint64_t>(b);
    body.captured = t;
    for (auto& joint : body.joints) {
      joint.state = JointState::Tracked;
      joint.position = {static_cast<double>(random() % 10000), 1.0, 2.0};
    }
  }
  return {chorus::testing::sensor_id("s1"), frame, t, {}, {}};
}

RecorderOptions options_in(const TemporaryFolder& folder) {
  RecorderOptions options;
  options.name = "rec";
  options.folder = folder / "recordings/rec";
  options.limits.min_free_bytes = 0;
  return options;
}

RecordingReport stopped(Recorder& recorder) {
  recorder.ask_to_stop();
  EXPECT_TRUE(recorder.wait(kPatience));
  return recorder.report();
}

TEST(Recorder, WritesWhatItIsOfferedAndAnIndex) {
  const TemporaryFolder folder;
  auto recorder = Recorder::start(options_in(folder));
  ASSERT_TRUE(recorder) << to_string(recorder.error());
  for (int i = 0; i < 100; ++i) EXPECT_TRUE((*recorder)->offer(raw(i)));
  const RecordingReport report = stopped(**recorder);
  EXPECT_EQ(report.state, RecordingState::Finished);
  EXPECT_EQ(report.frames, 100u);
  EXPECT_EQ(report.dropped, 0u);
  EXPECT_FALSE((*recorder)->offer(raw(100))) << "it is over";

  const auto cell = read_cell(folder / "recordings/rec");
  ASSERT_TRUE(cell) << to_string(cell.error());
  EXPECT_THAT(cell->sensors.at(0).frames, SizeIs(100));
  const auto index = read_index(folder / "recordings/rec");
  ASSERT_TRUE(index) << to_string(index.error());
  EXPECT_EQ(index->state, RecordingState::Finished);
  EXPECT_EQ(index->frames, 100u);
  ASSERT_THAT(index->files, SizeIs(1));
  EXPECT_EQ(index->bytes(), report.bytes());
}

TEST(Recorder, AFullQueueDropsTheNewestAndCounts) {
  const TemporaryFolder folder;
  RecorderOptions options = options_in(folder);
  options.limits.max_queue = 8;
  std::promise<void> writing;
  std::promise<void> go_on;
  auto recorder = Recorder::start(options);
  ASSERT_TRUE(recorder);
  (*recorder)->offer(FusedFrame{kStart, kStart, [&] {
                                  writing.set_value();
                                  go_on.get_future().wait();  // simulates a disk that hangs
                                  return *raw(0).frame;
                                }});
  writing.get_future().wait();
  for (int i = 0; i < 20; ++i) EXPECT_EQ((*recorder)->offer(raw(i)), i < 8);
  EXPECT_TRUE((*recorder)->offer(PlacesChanged{kStart, R"({"sensors":{}})", {}}))
      << "frames mean nothing without them";
  EXPECT_EQ((*recorder)->report().dropped, 12u);
  go_on.set_value();
  EXPECT_EQ(stopped(**recorder).frames, 9u);
  const auto cell = read_cell(folder / "recordings/rec");
  ASSERT_TRUE(cell);
  EXPECT_EQ(cell->sensors.at(0).frames.back().captured, raw(7).frame->captured);
  EXPECT_THAT(cell->registrations, SizeIs(1));
}

TEST(Recorder, BeginsANewFileWhenTheTimeIsUpAndEachStandsAlone) {
  const TemporaryFolder folder;
  const auto clock = std::make_shared<FakeClock>(kStart);
  RecorderOptions options = options_in(folder);
  options.clock = clock;
  options.limits.max_file_duration = std::chrono::seconds(10);
  auto recorder = Recorder::start(options);
  ASSERT_TRUE(recorder);
  (*recorder)->offer(PlacesChanged{kStart, R"({"sensors":{}})", {}});
  for (int part = 0; part < 3; ++part) {
    const auto written = std::make_shared<std::promise<void>>();
    (*recorder)->offer(FusedFrame{clock->now(), clock->now(), [written, part] {
                                    written->set_value();
                                    return *raw(part).frame;
                                  }});
    written->get_future().wait();
    clock->advance(std::chrono::seconds(10));
  }
  const RecordingReport report = stopped(**recorder);
  ASSERT_THAT(report.files, SizeIs(3));
  EXPECT_EQ(report.files[0].name, "rec-0001-20261121T073000Z.mcap");
  EXPECT_EQ(report.files[1].name, "rec-0002-20261121T073010Z.mcap");
  for (const RecordedFile& file : report.files) {
    const auto cell = read_cell(folder / ("recordings/rec/" + file.name));
    ASSERT_TRUE(cell);
    EXPECT_THAT(cell->registrations, SizeIs(1)) << file.name;
  }
}

TEST(Recorder, BeginsANewFileBeforeOneUnpacksToMoreThanReadersHold) {
  const TemporaryFolder folder;
  RecorderOptions options = options_in(folder);
  options.limits.max_unpacked_bytes = 20'000;
  auto recorder = Recorder::start(options);
  ASSERT_TRUE(recorder);
  for (int i = 0; i < 300; ++i) (*recorder)->offer(raw(i));
  const RecordingReport report = stopped(**recorder);
  EXPECT_GE(report.files.size(), 2u);
  const auto cell = read_cell(folder / "recordings/rec");
  ASSERT_TRUE(cell);
  EXPECT_THAT(cell->sensors.at(0).frames, SizeIs(300));
}

TEST(Recorder, TwoRunsAreNeverTakenForOne) {
  const TemporaryFolder folder;
  RecorderOptions options = options_in(folder);
  options.folder.clear();
  options.clock = std::make_shared<FakeClock>(kStart);  // both recordings begin at the same instant
  for (const char* name : {"b.mcap", "a.mcap"}) {
    options.file = folder / name;
    auto recorder = Recorder::start(options);
    ASSERT_TRUE(recorder);
    for (int i = 0; i < 5; ++i) (*recorder)->offer(raw(i + (name[0] == 'a' ? 100 : 0)));
  }
  const auto both = read_cell({folder / "a.mcap", folder / "b.mcap"});
  ASSERT_FALSE(both);
  EXPECT_EQ(both.error().code, ErrorCode::Conflict);
  EXPECT_TRUE(read_cell(folder / "a.mcap"));
}

TEST(Recorder, WaitsForTheDiskOnceASecondAndAtTheEnd) {
  const TemporaryFolder folder;
  auto recorder = Recorder::start(options_in(folder));
  ASSERT_TRUE(recorder);
  (*recorder)->offer(raw(0));
  const std::string file = (folder / "recordings/rec" / (*recorder)->report().files[0].name);
  EXPECT_TRUE(Disk::of_test().waits_for_sync_of(file)) << "while it goes on";
  (*recorder)->offer(raw(1));
  const std::size_t before = Disk::of_test().syncs_of(file);
  (void)stopped(**recorder);
  EXPECT_GT(Disk::of_test().syncs_of(file), before);
  EXPECT_GT(Disk::of_test().syncs_of(folder / "recordings/rec"), 0u) << "the file's name";
  EXPECT_GT(Disk::of_test().syncs_of(folder / "recordings"), 0u) << "the folder's";
}

TEST(Recorder, AnIndexThatCannotBeWrittenIsReported) {
  const TemporaryFolder folder;
  auto recorder = Recorder::start(options_in(folder));
  ASSERT_TRUE(recorder);
  std::filesystem::remove(folder / "recordings/rec/index.json");
  std::filesystem::create_directory(folder / "recordings/rec/index.json");
  (*recorder)->offer(raw(0));
  const RecordingReport report = stopped(**recorder);
  EXPECT_EQ(report.state, RecordingState::Finished) << "the frames are worth more";
  EXPECT_EQ(report.frames, 1u);
  EXPECT_THAT(report.reason, HasSubstr("index.json"));
}

TEST(Recorder, BeginsANewFileWhenOneIsFull) {
  const TemporaryFolder folder;
  RecorderOptions options = options_in(folder);
  options.limits.max_file_bytes = 20'000;
  auto recorder = Recorder::start(options);
  ASSERT_TRUE(recorder);
  for (int i = 0; i < 300; ++i) ASSERT_TRUE((*recorder)->offer(raw(i, 1)));  // ten seconds
  const RecordingReport report = stopped(**recorder);
  EXPECT_GT(report.files.size(), 2u);
  const auto cell = read_cell(folder / "recordings/rec");
  ASSERT_TRUE(cell);
  EXPECT_THAT(cell->sensors.at(0).frames, SizeIs(300)) << "nothing is lost between files";
}

TEST(Recorder, StopsByItselfAfterItsTime) {
  const TemporaryFolder folder;
  const auto clock = std::make_shared<FakeClock>(kStart);
  RecorderOptions options = options_in(folder);
  options.clock = clock;
  options.stop_after = std::chrono::seconds(30);
  auto recorder = Recorder::start(options);
  ASSERT_TRUE(recorder);
  clock->advance(std::chrono::seconds(31));
  EXPECT_TRUE((*recorder)->wait(kPatience));
  EXPECT_EQ((*recorder)->report().state, RecordingState::Finished);
}

TEST(Recorder, RefusesAFolderItCannotUse) {
  const TemporaryFolder folder;
  RecorderOptions options = options_in(folder);
  options.folder = "/proc/no/rec";
  auto refused = Recorder::start(options);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::Io);
  options = options_in(folder);
  options.limits.min_free_bytes = std::numeric_limits<std::uintmax_t>::max();
  refused = Recorder::start(options);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::Unavailable);
  EXPECT_THAT(refused.error().message, HasSubstr("min_free_mb"));
  EXPECT_FALSE(std::filesystem::exists(options.folder)) << "and leaves nothing behind";
  const auto first = Recorder::start(options_in(folder));
  ASSERT_TRUE(first);
  refused = Recorder::start(options_in(folder));
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::Conflict);
}

TEST(Recorder, AFullDiskEndsTheRecordingAndNothingElse) {
  const TemporaryFolder folder;
  std::signal(SIGXFSZ, SIG_IGN);
  auto recorder = Recorder::start(options_in(folder));
  ASSERT_TRUE(recorder);
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  rlimit small = before;
  small.rlim_cur = 40'000;
  setrlimit(RLIMIT_FSIZE, &small);
  for (int i = 0; i < 300; ++i) (*recorder)->offer(raw(i, 1));
  (*recorder)->ask_to_stop();
  EXPECT_TRUE((*recorder)->wait(kPatience));
  setrlimit(RLIMIT_FSIZE, &before);
  const RecordingReport report = (*recorder)->report();
  EXPECT_EQ(report.state, RecordingState::Failed);
  EXPECT_THAT(report.reason, HasSubstr("cannot write"));
  const auto cell = read_cell(folder / "recordings/rec");
  ASSERT_TRUE(cell) << to_string(cell.error());
  EXPECT_GT(cell->sensors.at(0).frames.size(), 0u) << "what was written stays readable";
}

TEST(Recorder, WritesOneFileWhereItIsTold) {
  const TemporaryFolder folder;
  RecorderOptions options = options_in(folder);
  options.folder.clear();
  options.file = folder / "mine.mcap";
  options.limits.max_file_bytes = 1;
  {
    auto recorder = Recorder::start(options);
    ASSERT_TRUE(recorder);
    for (int i = 0; i < 100; ++i) (*recorder)->offer(raw(i));
  }  // closing writes the rest
  const auto cell = read_cell(folder / "mine.mcap");
  ASSERT_TRUE(cell);
  EXPECT_THAT(cell->sensors.at(0).frames, SizeIs(100));
  EXPECT_FALSE(std::filesystem::exists(folder / "index.json"));
}

TEST(RecordingIndex, OfAProcessThatDiedSaysInterrupted) {
  const TemporaryFolder folder;
  RecordingReport report;
  report.name = "rec";
  report.started = kStart;
  report.files = {
      {"there.mcap", kStart, 1}, {"../escape.mcap", kStart, 1}, {"gone.mcap", kStart, 1}};
  std::filesystem::create_directory(folder / "rec");
  std::ofstream(folder / "rec/there.mcap") << "12345";
  std::ofstream(folder / "escape.mcap") << "12345";
  ASSERT_TRUE(write_index(folder / "rec", report));
  const auto read = read_index(folder / "rec");
  ASSERT_TRUE(read) << to_string(read.error());
  EXPECT_EQ(read->state, RecordingState::Interrupted);
  ASSERT_THAT(read->files, SizeIs(1));
  EXPECT_EQ(read->files[0].bytes, 5u) << "as large as it is, not as it was";
}

TEST(RecordingIndex, NonsenseIsRefused) {
  const TemporaryFolder folder;
  for (const char* text : {"", "[]", "{}", R"({"started":5})", R"({"started":"yesterday"})"}) {
    std::ofstream(folder / "index.json") << text;
    EXPECT_FALSE(read_index(folder / "")) << text;
  }
}

TEST(RecordingName, IsAFolderNameAndNothingElse) {
  for (const char* good : {"a", "20261121T073000Z", "walk_1-b"})
    EXPECT_TRUE(is_recording_name(good));
  for (const char* bad : {"", ".", "..", "a/b", "a.mcap", "a b", "\xc3\xa4", "%2e"}) {
    EXPECT_FALSE(is_recording_name(bad)) << bad;
  }
  EXPECT_FALSE(is_recording_name(std::string(65, 'a')));
  EXPECT_EQ(utc_name(kStart), "20261121T073000Z");
  EXPECT_TRUE(is_recording_name(utc_name(kStart)));
}

}  // namespace
}  // namespace chorus::record
