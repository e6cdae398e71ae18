#include "common/importers/datasets/keraal_text.h"

#include <cmath>

#include "common/body/bones.h"
#include "tests/support/matchers.h"
#include "tests/unit/importers/import_files.h"

namespace chorus::importers {
namespace {

using testing::FailsWith;
using ::testing::HasSubstr;
using testing::IsOk;

std::string keraal_row(const char* joint = "0.3 -0.5 3.0 0.6 0.8 0.0 0.0 ",
                       std::size_t joints = 25) {
  std::string text;
  for (std::size_t j = 0; j < joints; ++j) text += joint;
  return text + "\n";
}

TEST(KeraalText, ReadsPositionsAndScalarFirstQuaternions) {
  const TemporaryFolder folder;
  const auto recording =
      read_keraal_text(folder.write("a.txt", keraal_row() + keraal_row() + "\n"));
  ASSERT_THAT(recording, IsOk());
  ASSERT_EQ(recording->frames.size(), 2u);
  const Joint& joint = recording->frames[1].bodies.at(0).skeleton[JointId::HandLeft];
  EXPECT_THAT(joint.position, testing::VectorNear(Eigen::Vector3d(0.3, -0.5, 3.0), 1e-9));
  EXPECT_NEAR(joint.orientation.w(), 0.6, 1e-9);
  EXPECT_NEAR(joint.orientation.x(), 0.8, 1e-9);
  EXPECT_EQ(joint.state, JointState::Tracked);
}

TEST(KeraalText, RefusesBadRowsNamingTheLine) {
  const TemporaryFolder folder;
  struct {
    const char* name;
    std::string text;
    const char* says;
  } const bad[] = {
      {"cut off", keraal_row() + keraal_row().substr(0, 333) + "\n", ":2: holds"},
      {"26 joints", keraal_row("1 1 1 0 0 0 0 ", 26), "more than the 175"},
      {"nan", keraal_row("0 nan 1 0 0 0 0 "), ":1: value 2 (\"nan\")"},
      {"no quaternion", keraal_row("0 0 1 20 0 0 0 "), "value 4"},
      {"empty", "", "no row"},
  };
  for (const auto& each : bad) {
    const auto recording = read_keraal_text(folder.write("bad.txt", each.text));
    ASSERT_THAT(recording, FailsWith(ErrorCode::Malformed)) << each.name;
    EXPECT_THAT(to_string(recording.error()), HasSubstr(each.says)) << each.name;
  }
}

TEST(KeraalText, ReadsTheSharedRecordingWithItsAxesAlongTheBones) {
  const auto file =
      shared_recordings() / "keraal_kinect2_optical/G3-Kinect-CTK-P1T1-Unknown-C-0.txt";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "runs where " << file << " is there";
  const auto recording = read_keraal_text(file);
  ASSERT_THAT(recording, IsOk());
  EXPECT_EQ(recording->frames.size(), 197u);
  for (const SensorFrame& frame : recording->frames) {
    const auto& body = frame.bodies.at(0).skeleton;
    const Eigen::Vector3d along =
        body[JointId::SpineMid].position - body[JointId::SpineBase].position;
    const Eigen::Vector3d axis = body[JointId::SpineMid].orientation * Eigen::Vector3d::UnitY();
    EXPECT_LT(std::acos(std::min(1.0, axis.dot(along.normalized()))), 0.02);
  }
}

}  // namespace
}  // namespace chorus::importers
