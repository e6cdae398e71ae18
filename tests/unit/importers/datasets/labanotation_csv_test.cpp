#include "common/importers/datasets/labanotation_csv.h"

#include "tests/support/matchers.h"
#include "tests/unit/importers/import_files.h"

namespace chorus::importers {
namespace {

using testing::FailsWith;
using ::testing::HasSubstr;
using testing::IsOk;

/// A row whose joint j lies at (x, j, 2 + j) in the given state.
std::string row(std::int64_t ticks, double x = 0.5, int state = 2) {
  std::string text = std::to_string(ticks);
  for (std::size_t j = 0; j < kJointCount; ++j)
    text += "," + std::to_string(x) + "," + std::to_string(j) + "," + std::to_string(2 + j) + "," +
            std::to_string(state);
  return text;
}

constexpr std::int64_t kBoot = 95'833'559'566;
constexpr std::int64_t kStep = 330'000;  // 33 ms

TEST(LabanotationCsv, ReadsTheShippedRecordingWithItsDrops) {
  const auto recording =
      read_labanotation_csv(kShippedRecordings / "kinect2_labanotation/Ges04_comehere.csv");
  ASSERT_THAT(recording, IsOk());
  EXPECT_EQ(recording->sensor.str(), "Ges04_comehere");
  ASSERT_EQ(recording->frames.size(), 45u);
  EXPECT_EQ(recording->frames.front().captured, kDefaultStart);
  EXPECT_THAT(recording->notes.at("time"), HasSubstr("not UTC"));
  std::size_t drops = 0;
  for (std::size_t i = 1; i < recording->frames.size(); ++i) {
    const Duration step = recording->frames[i].captured - recording->frames[i - 1].captured;
    EXPECT_GT(step, std::chrono::milliseconds(30));
    drops += step > std::chrono::milliseconds(60) ? 1 : 0;
  }
  EXPECT_EQ(drops, 3u);
  const auto& body = recording->frames.front().bodies.at(0).skeleton;
  EXPECT_THAT(body[JointId::SpineBase].position,
              testing::VectorNear(Eigen::Vector3d(-0.0491691, -0.34826, 2.72472), 1e-9));
  EXPECT_GT(body[JointId::Head].position.y(), body[JointId::Neck].position.y());
}

TEST(LabanotationCsv, KeepsPlausibleUtcOfEveryTickEpoch) {
  const TemporaryFolder folder;
  const Timestamp instant = from_unix_ns(1'600'000'000'123'456'700);
  const std::int64_t unix_ticks = to_unix_ns(instant) / 100;
  for (const std::int64_t epoch : {0L, 116'444'736'000'000'000L, 621'355'968'000'000'000L}) {
    const auto recording =
        read_labanotation_csv(folder.write("a.csv", row(unix_ticks + epoch) + "\r\n"));
    ASSERT_THAT(recording, IsOk());
    EXPECT_EQ(recording->frames.at(0).captured, instant);
    EXPECT_THAT(recording->notes.at("time"), HasSubstr("UTC as recorded"));
  }
}

TEST(LabanotationCsv, RebasesToTheGivenStartAndCarriesTheFloor) {
  const TemporaryFolder folder;
  ImportOptions options;
  options.start = from_unix_ns(1'700'000'000'000'000'000);
  options.floor = parse_floor("0,1,0,1.2").value();
  const auto recording = read_labanotation_csv(
      folder.write("a.csv", row(kBoot) + "\n" + row(kBoot + kStep) + "\n"), options);
  ASSERT_THAT(recording, IsOk());
  EXPECT_EQ(recording->frames[0].captured, options.start);
  EXPECT_EQ(recording->frames[1].captured, options.start + std::chrono::milliseconds(33));
  ASSERT_TRUE(recording->frames[1].floor.has_value());
  EXPECT_DOUBLE_EQ(recording->frames[1].floor->offset, 1.2);
}

TEST(LabanotationCsv, DropsRowsThatRepeatACaptureTime) {
  const TemporaryFolder folder;
  const auto recording = read_labanotation_csv(
      folder.write("a.csv", row(kBoot) + "\n" + row(kBoot, 0.7) + "\n" + row(kBoot + kStep)));
  ASSERT_THAT(recording, IsOk());
  EXPECT_EQ(recording->frames.size(), 2u);
  EXPECT_DOUBLE_EQ(recording->frames[0].bodies[0].skeleton.joints[0].position.x(), 0.5);
  EXPECT_THAT(recording->notes.at("repeated"), HasSubstr("1 rows"));
}

struct BadFile {
  const char* name;
  std::string text;
  const char* says;
};

TEST(LabanotationCsv, RefusesBadRowsNamingTheLine) {
  const TemporaryFolder folder;
  const std::string good = row(kBoot) + "\n";
  std::string not_finite = row(kBoot + kStep);
  not_finite.replace(not_finite.find("0.500000"), 8, "nan");
  const BadFile bad[] = {
      {"truncated", good + row(kBoot + kStep).substr(0, 200) + "\n", ":2: holds "},
      {"too many", good + row(kBoot + kStep) + ",1", "more than the 101"},
      {"nan", good + not_finite, ":2: value 2 (\"nan\") is not finite"},
      {"millimetres", good + row(kBoot + kStep, 812.0), "are these metres"},
      {"state", good + row(kBoot + kStep, 0.5, 3), "tracking state 3"},
      {"time back", good + row(kBoot - 1), "goes back"},
      {"time jumps", good + row(kBoot * 1000), "jumps by more than a week"},
      {"ticks overflow", "9" + row(9'000'000'000'000'000'000), "value 1 "},
      {"words", "time,x,y,z\n", ":1: holds 4 values"},
      {"empty", "\n\n", "holds no row"},
  };
  for (const BadFile& each : bad) {
    const auto recording = read_labanotation_csv(folder.write("bad.csv", each.text));
    ASSERT_THAT(recording, FailsWith(ErrorCode::Malformed)) << each.name;
    EXPECT_THAT(to_string(recording.error()), HasSubstr(each.says)) << each.name;
  }
}

TEST(LabanotationCsv, BoundsItsMemory) {
  const TemporaryFolder folder;
  const auto file = folder.write("a.csv", row(kBoot) + "\n" + row(kBoot + kStep));
  ImportOptions small;
  small.limits.max_text_bytes = 100;
  EXPECT_THAT(read_labanotation_csv(file, small), FailsWith(ErrorCode::TooLarge));
  ImportOptions few;
  few.limits.max_frames = 1;
  EXPECT_THAT(read_labanotation_csv(file, few), FailsWith(ErrorCode::Malformed));
  EXPECT_THAT(read_labanotation_csv(folder.path() / "none.csv"), FailsWith(ErrorCode::NotFound));
  EXPECT_THAT(read_labanotation_csv(folder.path()), FailsWith(ErrorCode::InvalidArgument));
  const std::string commas(1u << 20, ',');
  EXPECT_THAT(read_labanotation_csv(folder.write("commas.csv", commas)),
              FailsWith(ErrorCode::Malformed));
}

TEST(FloorOption, ReadsNormalisesAndTurnsUp) {
  const auto floor = parse_floor("0,-2,0,-2.4");
  ASSERT_THAT(floor, IsOk());
  EXPECT_DOUBLE_EQ(floor->normal.y(), 1.0);
  EXPECT_DOUBLE_EQ(floor->offset, 1.2);
  const auto ceiling = parse_floor("0,-0.03,-1,3.4");  // the camera looks beyond straight down
  ASSERT_THAT(ceiling, IsOk());
  EXPECT_LT(ceiling->normal.z(), 0.0);
  EXPECT_GT(ceiling->offset, 3.0);
  for (const char* wrong : {"", "1,2,3", "1,2,3,4,5", "a,b,c,d", "0,0,0,1", "nan,1,0,1"})
    EXPECT_FALSE(parse_floor(wrong).has_value()) << wrong;
}

}  // namespace
}  // namespace chorus::importers
