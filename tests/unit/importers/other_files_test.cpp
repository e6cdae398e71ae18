// Files as other programs write them (tests/data/other_files): each gives the right value.
#include <gmock/gmock.h>

#include "common/importers/doubts.h"
#include "common/importers/formats.h"
#include "tests/support/matchers.h"
#include "tests/unit/importers/import_files.h"

namespace chorus::importers {
namespace {

using chorus::testing::IsOk;
using ::testing::HasSubstr;

struct OtherFile {
  FileFormat format;
  const char* name;
  std::size_t frames;
  std::size_t joints;  ///< At least this many of our joints are seen in the first frame.
  double seconds;      ///< From the first to the last frame.
};

std::size_t joints_in(const BodyFrame& body) {
  const auto& joints = body.skeleton.joints;
  return static_cast<std::size_t>(
      std::count_if(joints.begin(), joints.end(), [](const Joint& j) { return j.given(); }));
}

class OtherFiles : public ::testing::TestWithParam<OtherFile> {};

TEST_P(OtherFiles, AreReadAsTheyAreMeant) {
  const auto& [format, name, frames, joints, length] = GetParam();
  const auto set = import_files(format, {kShippedRecordings / "other_files" / name});
  ASSERT_THAT(set, IsOk());
  const auto& recording = set->recordings.at(0);
  EXPECT_EQ(recording.frames.size(), frames);
  ASSERT_FALSE(recording.frames.front().bodies.empty());
  EXPECT_GE(joints_in(recording.frames.front().bodies[0]), joints);
  const Duration whole = recording.frames.back().captured - recording.frames.front().captured;
  EXPECT_NEAR(seconds(whole), length, 1e-3);
  EXPECT_THAT(doubts_about(set->recordings, set->spaces), ::testing::IsEmpty());
}

INSTANTIATE_TEST_SUITE_P(
    Cases, OtherFiles,
    ::testing::Values(OtherFile{FileFormat::C3d, "zero_missing.c3d", 100, 18, 0.99},
                      OtherFile{FileFormat::C3d, "ds_zero.c3d", 100, 18, 0.99},
                      OtherFile{FileFormat::C3d, "bvh_like_names.c3d", 100, 18, 0.99},
                      OtherFile{FileFormat::C3d, "lower.c3d", 100, 18, 0.99},
                      OtherFile{FileFormat::C3d, "openpose_names.c3d", 100, 18, 0.99},
                      OtherFile{FileFormat::C3d, "prefix_under.c3d", 100, 18, 0.99},
                      OtherFile{FileFormat::Bvh, "announced_more.bvh", 40, 20, 1.3},
                      OtherFile{FileFormat::Bvh, "one_more.bvh", 40, 20, 1.3},
                      OtherFile{FileFormat::Bvh, "cutlast.bvh", 39, 20, 1.2667},
                      OtherFile{FileFormat::Bvh, "char1.bvh", 40, 20, 1.3},
                      OtherFile{FileFormat::Bvh, "ipi.bvh", 40, 20, 1.3},
                      OtherFile{FileFormat::Bvh, "mixamo2.bvh", 40, 20, 1.3},
                      OtherFile{FileFormat::Bvh, "rigify.bvh", 40, 20, 1.3},
                      OtherFile{FileFormat::Bvh, "slimevr.bvh", 40, 20, 1.3},
                      OtherFile{FileFormat::Bvh, "spaces_bip.bvh", 40, 20, 1.3},
                      OtherFile{FileFormat::Bvh, "ue.bvh", 40, 20, 1.3},
                      OtherFile{FileFormat::Mvnx, "fingers.mvnx", 30, 20, 0.4833},
                      OtherFile{FileFormat::Mvnx, "gap.mvnx", 20, 20, 0.4833},
                      OtherFile{FileFormat::Csv, "m_None.csv", 30, 5, 0.9667},
                      OtherFile{FileFormat::Csv, "m_nan_ind.csv", 30, 5, 0.9667},
                      OtherFile{FileFormat::Csv, "m_na.csv", 30, 5, 0.9667}),
    [](const auto& each) {
      std::string name = each.param.name;
      for (char& c : name) {
        if (c == '.') c = '_';
      }
      return name;
    });

TEST(OtherFilesAs, ATwistedFileSaysWhatItIs) {
  const auto set =
      import_files(FileFormat::C3d, {kShippedRecordings / "other_files/zero_missing.c3d"});
  ASSERT_THAT(set, IsOk());
  std::size_t wrists = 0;
  for (const SensorFrame& frame : set->recordings[0].frames) {
    for (const BodyFrame& body : frame.bodies) {
      for (const Joint& joint : body.skeleton.joints)
        EXPECT_FALSE(joint.seen() && joint.position.norm() < 1e-6) << "nobody is at the origin";
      wrists += body.skeleton[JointId::WristLeft].seen() ? 1 : 0;
    }
  }
  EXPECT_LT(wrists, 100u);
  EXPECT_THAT(set->recordings[0].notes.at("damage.1"), HasSubstr("taken as not seen"));
}

}  // namespace
}  // namespace chorus::importers
