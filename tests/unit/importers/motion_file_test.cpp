// Motion files as recordings: exported files are read back, as truth and as an ideal sensor's view.
#include "common/importers/motion_file.h"

#include <gmock/gmock.h>

#include <set>

#include "common/exporters/export_formats.h"
#include "common/exporters/skeleton_fit.h"
#include "common/importers/formats.h"
#include "common/motion/c3d.h"
#include "tests/support/matchers.h"
#include "tests/unit/exporters/poses.h"
#include "tests/unit/importers/import_files.h"
#include "tests/unit/motion/c3d_files.h"

namespace chorus::importers {
namespace {

using chorus::testing::FailsWith;
using chorus::testing::IsOk;
using chorus::testing::SkeletonNear;
using ::testing::HasSubstr;

exporters::Take two_persons() {
  auto second = exporters::walk();
  for (auto& body : second) {
    for (Joint& joint : body.joints) joint.position.x() += 1.5;
  }
  for (Joint& joint : second[3].joints) testing::hide(joint);
  return exporters::take_of({exporters::walk(), second}, 30.0);
}

TEST(MotionFile, AnExportedC3dComesBackWithBothPersons) {
  const TemporaryFolder folder;
  const auto take = two_persons();
  const auto exported = exporters::exported(take, exporters::ExportFormat::C3d);
  ASSERT_THAT(exported, IsOk());
  const auto file = folder.write("walk.c3d", exported->files[0].bytes);
  const auto set = import_files(FileFormat::C3d, {file});
  ASSERT_THAT(set, IsOk());
  const auto& recording = set->recordings.at(0);
  EXPECT_EQ(recording.sensor.str(), "walk");
  ASSERT_EQ(recording.frames.size(), take.frames);
  EXPECT_EQ(recording.frames[30].captured - recording.frames[0].captured, std::chrono::seconds(1));
  EXPECT_EQ(recording.frames[3].bodies.size(), 1u) << "the second person is hidden";
  EXPECT_TRUE(recording.frames[0].floor.has_value());
  EXPECT_TRUE(set->world_from_sensor.at(recording.sensor).isApprox(Eigen::Isometry3d::Identity()));
  ASSERT_EQ(set->truth.size(), 2 * take.frames - 1);
  for (const TruthFrame& truth : set->truth)
    ASSERT_THAT(truth.skeleton,
                SkeletonNear(take.persons[truth.person - 1].poses[truth.index].skeleton, 1e-6));
}

std::set<std::uint64_t> persons_in(const ImportedSet& set) {
  std::set<std::uint64_t> persons;
  for (const TruthFrame& truth : set.truth) persons.insert(truth.person);
  return persons;
}

TEST(MotionFile, PersonsOfOurOwnC3dKeepTheirIds) {
  const TemporaryFolder folder;
  auto take = two_persons();
  take.persons[0].person = PersonId{10};
  take.persons[1].person = PersonId{2};
  const auto bytes = exporters::exported(take, exporters::ExportFormat::C3d)->files[0].bytes;
  const auto set = import_files(FileFormat::C3d, {folder.write("walk.c3d", bytes)});
  ASSERT_THAT(set, IsOk());
  EXPECT_EQ(persons_in(*set), (std::set<std::uint64_t>{2, 10}));
  for (const TruthFrame& truth : set->truth)
    ASSERT_THAT(
        truth.skeleton,
        SkeletonNear(take.persons[truth.person == 10 ? 0 : 1].poses[truth.index].skeleton, 1e-6));
}

TEST(MotionFile, OtherSubjectsAreNumberedInTheOrderOfTheFile) {
  const TemporaryFolder folder;
  motion::C3dSpec spec;
  for (const char* subject : {"Zoe:", "Adam:"}) {
    for (const char* label : {"LHJC", "RHJC", "LKJC"})
      spec.labels.push_back(std::string(subject) + label);
  }
  const auto c3d = motion::parse_c3d(motion::C3dBuilder(spec).bytes(), "two.c3d");
  ASSERT_THAT(c3d, IsOk());
  const auto found = motion::motion_from_markers(*c3d);
  ASSERT_THAT(found, IsOk());
  ASSERT_EQ(found->subjects.size(), 2u);
  EXPECT_EQ(found->subjects[0].name, "Zoe");
  const auto read = read_motion_file(folder.write("two.c3d", motion::C3dBuilder(spec).bytes()),
                                     MotionFormat::C3d);
  ASSERT_THAT(read, IsOk());
  for (const TruthFrame& truth : read->truth) EXPECT_LE(truth.person, 2u);
}

TEST(MotionFile, AnExportedBvhComesBackInTheUnitItWasWrittenIn) {
  const TemporaryFolder folder;
  const auto take = exporters::take_of({exporters::walk()}, 30.0);
  const auto chain = exporters::fit_skeleton(take.persons[0]).value();
  for (const double units : {100.0, 1.0}) {
    const auto text = exporters::exported(take, exporters::ExportFormat::Bvh, {"walk.bvh", units})
                          ->files[0]
                          .bytes;
    ImportOptions options;
    options.metres_per_unit = 1.0 / units;
    const auto set = import_files(FileFormat::Bvh, {folder.write("walk.bvh", text)}, options);
    ASSERT_THAT(set, IsOk());
    ASSERT_EQ(set->truth.size(), take.frames);
    for (std::size_t f = 0; f < take.frames; f += 13)
      EXPECT_THAT(set->truth[f].skeleton,
                  SkeletonNear(take.persons[0].poses[f].skeleton, chain.residual.largest + 1e-4));
  }
}

TEST(MotionFile, ABvhInAnotherUnitThanStatedIsRefused) {
  const TemporaryFolder folder;
  const auto take = exporters::take_of({exporters::walk()}, 30.0);
  for (const double units : {100.0, 1.0}) {
    const auto text = exporters::exported(take, exporters::ExportFormat::Bvh, {"walk.bvh", units})
                          ->files[0]
                          .bytes;
    ImportOptions options;
    options.metres_per_unit = units == 1.0 ? 0.01 : 1.0;
    const auto set = import_files(FileFormat::Bvh, {folder.write("walk.bvh", text)}, options);
    ASSERT_THAT(set, FailsWith(ErrorCode::Malformed));
    EXPECT_THAT(to_string(set.error()), HasSubstr("--unit"));
  }
}

TEST(MotionFile, ThePoseBeforeTheMotionIsLeftOutAndNoted) {
  const TemporaryFolder folder;
  auto body = exporters::walk();
  for (Joint& joint : body.front().joints) joint.position.z() += 2.0;  // 60 m/s to the next
  const auto take = exporters::take_of({body}, 30.0);
  const auto text = exporters::exported(take, exporters::ExportFormat::Bvh)->files[0].bytes;
  const auto set = import_files(FileFormat::Bvh, {folder.write("walk.bvh", text)});
  ASSERT_THAT(set, IsOk());
  EXPECT_EQ(set->recordings[0].frames.size(), take.frames - 1);
  EXPECT_EQ(set->recordings[0].frames[0].captured, kDefaultStart);
  EXPECT_THAT(set->recordings[0].notes.at("repeated"), HasSubstr("left out"));
}

TEST(MotionFile, SaysWhatIsNoJointAndHowManyThereAre) {
  const TemporaryFolder folder;
  motion::C3dSpec spec;
  spec.labels = {"LHJC", "RHJC", "LKJC", "Wand1", "Wand2"};
  const auto read = read_motion_file(folder.write("lab.c3d", motion::C3dBuilder(spec).bytes()),
                                     MotionFormat::C3d);
  ASSERT_THAT(read, IsOk());
  EXPECT_EQ(read->recording.notes.at("labels"), "2 of 5 points are no joint: Wand1 Wand2");
  EXPECT_THAT(read->recording.notes.at("joints"), HasSubstr("4 of our 25"));
  EXPECT_THAT(read->recording.notes.at("time"), HasSubstr("50 Hz"));
}

TEST(MotionFile, WrongFilesAreNamed) {
  const TemporaryFolder folder;
  const auto nonsense = folder.write("nonsense.c3d", "not a motion at all");
  for (const auto format : {FileFormat::C3d, FileFormat::Bvh, FileFormat::Mvnx}) {
    const auto read = import_files(format, {nonsense});
    ASSERT_THAT(read, FailsWith(ErrorCode::Malformed));
    EXPECT_THAT(to_string(read.error()), HasSubstr("nonsense.c3d"));
    EXPECT_THAT(import_files(format, {folder.path() / "none"}), FailsWith(ErrorCode::NotFound));
    EXPECT_THAT(import_files(format, {nonsense, nonsense}), FailsWith(ErrorCode::InvalidArgument));
  }
}

TEST(MotionFile, NumbersThatNoMotionHasAreRefused) {
  const TemporaryFolder folder;
  const auto take = exporters::take_of({exporters::walk()}, 30.0);
  const auto sound = exporters::exported(take, exporters::ExportFormat::Bvh)->files[0].bytes;
  const std::size_t time = sound.find("Frame Time:");
  const auto slow =
      sound.substr(0, time) + "Frame Time: 1e300" + sound.substr(sound.find('\n', time));
  const auto years = import_files(FileFormat::Bvh, {folder.write("years.bvh", slow)});
  ASSERT_THAT(years, FailsWith(ErrorCode::TooLarge));
  EXPECT_THAT(to_string(years.error()), HasSubstr("more than a week"));
  for (const char* length : {"1e308", "1e7"}) {
    const std::string line = std::string("OFFSET ") + length + " 0 0\n";
    std::string far = sound;
    for (std::size_t at = far.find("JOINT"); at != std::string::npos; at = far.find("JOINT", at)) {
      at = far.find("OFFSET", at);
      far.replace(at, far.find('\n', at) + 1 - at, line);
    }
    const auto read = import_files(FileFormat::Bvh, {folder.write("far.bvh", far)});
    ASSERT_THAT(read, FailsWith(ErrorCode::Malformed)) << length;
    EXPECT_THAT(to_string(read.error()), HasSubstr("farther than 10 km"));
    EXPECT_THAT(to_string(read.error()), HasSubstr("far.bvh"));
  }
}

TEST(MotionFile, RealSuitTakeIsARecording) {
  const auto file = shared_recordings() / "xsens_mvnx_bvh/test_mocap.mvnx";
  if (!std::filesystem::exists(file))
    GTEST_SKIP() << "runs where ../shared/data stands beside the checkout";
  const auto read = read_motion_file(file, MotionFormat::Mvnx);
  ASSERT_THAT(read, IsOk());
  EXPECT_EQ(read->recording.frames.size(), 112u);
  EXPECT_THAT(read->recording.notes.at("sensors"), HasSubstr("11 inertial sensors"));
  const auto& body = read->truth[50].skeleton;
  EXPECT_GT(body[JointId::Head].position.y(), body[JointId::SpineBase].position.y() + 0.5);
}

}  // namespace
}  // namespace chorus::importers
