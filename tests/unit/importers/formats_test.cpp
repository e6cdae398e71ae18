#include "common/importers/formats.h"

#include "tests/support/matchers.h"
#include "tests/unit/importers/import_files.h"

namespace chorus::importers {
namespace {

using chorus::testing::FailsWith;
using chorus::testing::IsOk;
using std::chrono::milliseconds;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::SizeIs;

constexpr std::int64_t kBoot = 95'833'559'566;
constexpr std::int64_t kTicksPerSecond = 10'000'000;

/// LabanotationSuite rows 33 ms apart, the first some time after boot; distinguishable by x.
std::string rows(double seconds_after_boot, double x, int count = 4) {
  std::string text;
  for (int i = 0; i < count; ++i) {
    text += std::to_string(kBoot + static_cast<std::int64_t>(seconds_after_boot * kTicksPerSecond) +
                           i * 330'000);
    for (std::size_t j = 0; j < kJointCount; ++j) {
      text += "," + std::to_string(x + 0.01 * i) + "," + std::to_string(j) + "," +
              std::to_string(2 + j) + ",2";
    }
    text += "\n";
  }
  return text;
}

Result<ImportedSet> imported(const std::vector<std::filesystem::path>& files,
                             const ImportOptions& options = {}) {
  return import_files(FileFormat::Labanotation, files, options);
}

TEST(ImportFiles, CountsOfOneSensorKeepTheirDistance) {
  const TemporaryFolder folder;
  const auto set =
      imported({folder.write("b.csv", rows(12.5, 0.3)), folder.write("a.csv", rows(0, 0.1))});
  ASSERT_THAT(set, IsOk());
  ASSERT_THAT(set->recordings, SizeIs(2));
  const auto& late = set->recordings[0];
  const auto& early = set->recordings[1];
  EXPECT_EQ(early.frames.front().captured, kDefaultStart);
  EXPECT_EQ(late.frames.front().captured, kDefaultStart + milliseconds(12'500));
  EXPECT_EQ(late.frames.front().bodies.front().captured, late.frames.front().captured);
  EXPECT_THAT(late.notes.at("time"), HasSubstr("12.500 s after a"));
  EXPECT_EQ(late.notes.at("set_origin"), to_iso8601(kDefaultStart));
}

TEST(ImportFiles, CountsOfHostsStartedOnOtherDaysDoNot) {
  const TemporaryFolder folder;
  const auto set = imported(
      {folder.write("a.csv", rows(0, 0.1)), folder.write("b.csv", rows(2 * 24 * 3600.0, 0.3))});
  ASSERT_THAT(set, IsOk());
  EXPECT_EQ(set->recordings[1].frames.front().captured, kDefaultStart);
}

TEST(ImportFiles, TakesAFloorForEachOrOneForAll) {
  const TemporaryFolder folder;
  const std::vector<std::filesystem::path> files{folder.write("a.csv", rows(0, 0.1)),
                                                 folder.write("b.csv", rows(0, 0.3))};
  ImportOptions options;
  options.floors = {parse_floor("0,1,0,1.2").value(), parse_floor("0,1,0,2.1").value()};
  const auto set = imported(files, options);
  ASSERT_THAT(set, IsOk());
  EXPECT_DOUBLE_EQ(set->recordings[0].frames[0].floor->offset, 1.2);
  EXPECT_DOUBLE_EQ(set->recordings[1].frames[0].floor->offset, 2.1);
  options.floors.push_back(options.floors.front());
  EXPECT_THAT(imported(files, options), FailsWith(ErrorCode::InvalidArgument));
}

TEST(ImportFiles, AHalfWrittenLastLineIsLeftOutAndSaid) {
  const TemporaryFolder folder;
  const std::string text = rows(0, 0.1);
  const auto set = imported({folder.write("a.csv", text.substr(0, text.size() - 200))});
  ASSERT_THAT(set, IsOk());
  EXPECT_THAT(set->recordings[0].frames, SizeIs(3));
  EXPECT_THAT(set->recordings[0].notes.at("damage.1"), HasSubstr("cut off"));
  const std::string broken = text.substr(0, 100) + "\n" + text;
  EXPECT_THAT(imported({folder.write("b.csv", broken)}), FailsWith(ErrorCode::Malformed))
      << "in the middle it is a mistake";
}

TEST(ImportFiles, AnEmptyFileDoesNotStopTheOthers) {
  const TemporaryFolder folder;
  const auto empty = folder.write("empty.csv", "");
  const auto set = imported({empty, folder.write("a.csv", rows(0, 0.1))});
  ASSERT_THAT(set, IsOk());
  EXPECT_THAT(set->recordings, SizeIs(1));
  ASSERT_THAT(set->empty, SizeIs(1));
  EXPECT_THAT(to_string(set->empty[0]), HasSubstr("empty.csv"));
  EXPECT_FALSE(imported({empty})) << "nothing at all is a failure";
  EXPECT_FALSE(imported({folder / "absent.csv", folder.write("b.csv", rows(0, 0.2))}));
}

}  // namespace
}  // namespace chorus::importers
