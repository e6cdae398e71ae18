#include "common/importers/datasets/ntu_skeleton.h"

#include "common/body/bones.h"
#include "tests/support/matchers.h"
#include "tests/unit/importers/import_files.h"

namespace chorus::importers {
namespace {

using testing::FailsWith;
using ::testing::HasSubstr;
using testing::IsOk;

std::string joint_row(double x, const char* quaternion = "0.5 0.5 0.5 0.5", int state = 2) {
  return std::to_string(x) + " 0.2 3.5 250 200 1000 500 " + quaternion + " " +
         std::to_string(state) + "\n";
}

std::string body(const char* id, double x = 0.1) {
  std::string text = std::string(id) + " 0 1 1 1 1 0 0.02 0.05 2\n25\n";
  for (std::size_t j = 0; j < kJointCount; ++j) text += joint_row(x + 0.01 * double(j));
  return text;
}

TEST(NtuSkeleton, ReadsNoneOneAndTwoBodies) {
  const TemporaryFolder folder;
  const auto recording = read_ntu_skeleton(folder.write(
      "S001.skeleton", "3\r\n0\n1\n" + body("72057594037931101") + "2\n" +
                           body("72057594037931102", 0.5) + body("72057594037931101")));
  ASSERT_THAT(recording, IsOk());
  ASSERT_EQ(recording->frames.size(), 3u);
  EXPECT_EQ(recording->frames[0].bodies.size(), 0u);
  ASSERT_EQ(recording->frames[2].bodies.size(), 2u);
  EXPECT_EQ(recording->frames[1].bodies[0].id, BodyId{1});
  EXPECT_EQ(recording->frames[2].bodies[0].id, BodyId{2}) << "numbered in order of appearance";
  EXPECT_EQ(recording->frames[2].bodies[1].id, BodyId{1});
  EXPECT_EQ(recording->frames[2].captured - recording->frames[0].captured, Duration(66'666'667));
  const Joint& joint = recording->frames[1].bodies[0].skeleton[JointId::SpineMid];
  EXPECT_NEAR(joint.position.x(), 0.11, 1e-9);
  EXPECT_EQ(joint.state, JointState::Tracked);
  EXPECT_THAT(joint.orientation, testing::RotationNear(Eigen::Quaterniond(.5, .5, .5, .5), 1e-9));
}

TEST(NtuSkeleton, TakesZeroAndCrookedQuaternionsAsNotGiven) {
  const TemporaryFolder folder;
  std::string text = "1\n1\n7 0 1 1 1 1 0 0.02 0.05 2\n25\n";
  for (std::size_t j = 0; j < kJointCount; ++j)
    text += joint_row(0.1, j == 3 ? "0 0 0 0" : "0.9 0.9 0 0", 1);
  const auto recording = read_ntu_skeleton(folder.write("a.skeleton", text));
  ASSERT_THAT(recording, IsOk());
  for (const Joint& joint : recording->frames[0].bodies[0].skeleton.joints) {
    EXPECT_EQ(joint.orientation.norm(), 0.0);
    EXPECT_EQ(joint.state, JointState::Inferred);
  }
}

TEST(NtuSkeleton, RefusesBadFilesNamingTheLine) {
  const TemporaryFolder folder;
  const std::string one = body("7");
  struct {
    const char* name;
    std::string text;
    const char* says;
  } const bad[] = {
      {"empty", "", "the number of frames"},
      {"cut at a body", "2\n1\n" + one, "ends where the number of bodies"},
      {"cut in a row", "1\n1\n" + one.substr(0, one.size() - 30), ":29: holds"},
      {"cut between rows", "1\n1\n" + one.substr(0, one.rfind("0.34")), "ends before joint 25"},
      {"too long", "1\n1\n" + one + "1\n" + one, ":30: goes on after the 1 frames"},
      {"joint count", "1\n1\n7 0 1 1 1 1 0 0.02 0.05 2\n24\n", ":4: says 24 joints"},
      {"bodies", "1\n7\n", ":2: says 7 bodies"},
      {"huge frame count", "99999999999\n", "at most"},
      {"negative", "-3\n", "whole number of 0 or more"},
      {"same id twice", "1\n2\n" + one + one, "same id"},
      {"inf", "1\n1\n7 0 1 1 1 1 0 0.02 0.05 2\n25\ninf 0 0 0 0 0 0 1 0 0 0 2\n", ":5: value 1"},
  };
  for (const auto& each : bad) {
    const auto recording = read_ntu_skeleton(folder.write("bad.skeleton", each.text));
    ASSERT_THAT(recording, FailsWith(ErrorCode::Malformed)) << each.name;
    EXPECT_THAT(to_string(recording.error()), HasSubstr(each.says)) << each.name;
  }
}

/// Checks the order of a quaternion's components: in the recordings, a joint's y axis lies along
/// the bone that ends there.
TEST(NtuSkeleton, ReadsTheSharedRecordings) {
  const auto folder = shared_recordings() / "ntu_rgbd_kinect2";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "runs where " << folder << " is there";
  std::size_t files = 0;
  double largest = 0.0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (entry.path().extension() != ".skeleton") continue;
    const auto recording = read_ntu_skeleton(entry.path());
    ASSERT_THAT(recording, IsOk()) << entry.path();
    ++files;
    const auto& body = recording->frames.front().bodies.at(0).skeleton;
    for (const Bone& bone :
         {Bone{JointId::SpineBase, JointId::SpineMid}, Bone{JointId::HipLeft, JointId::KneeLeft}}) {
      const Eigen::Vector3d along = body[bone.child].position - body[bone.parent].position;
      const Eigen::Vector3d axis = body[bone.child].orientation * Eigen::Vector3d::UnitY();
      largest = std::max(largest, std::acos(std::min(1.0, axis.dot(along.normalized()))));
    }
  }
  EXPECT_EQ(files, 10u);
  EXPECT_LT(largest, 0.02);
}

}  // namespace
}  // namespace chorus::importers
