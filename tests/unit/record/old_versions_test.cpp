// Recordings that earlier versions wrote (tests/data/recordings) hold what they held then: the
// first 24 rows of tests/data/kinect2_labanotation, as the recording of one sensor and as that of a
// cell of two.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/record/cell_reader.h"
#include "tests/support/builders.h"

namespace chorus::record {
namespace {

using chorus::testing::sensor_id;
using std::chrono::milliseconds;
using ::testing::IsEmpty;
using ::testing::SizeIs;

constexpr std::size_t kRows = 24;

// Of the csv's rows 0 and 23: base of the spine [m] and the time between them.
const Eigen::Vector3d kFirstPelvis(-0.0491691, -0.34826, 2.72472);
const Eigen::Vector3d kLastPelvis(-0.0552186, -0.347276, 2.72192);
constexpr milliseconds kBetween(833);

class OldRecording : public ::testing::TestWithParam<const char*> {
 protected:
  static CellRecording read(const char* file) {
    const auto path = std::filesystem::path("tests/data/recordings") / GetParam() / file;
    CellQuery query;
    query.fused = true;
    query.strict = true;
    auto cell = read_cell(path, query);
    EXPECT_TRUE(cell) << to_string(cell.error());
    return cell ? *std::move(cell) : CellRecording{};
  }

  static void expect_the_take(const FrameRecording& recording) {
    ASSERT_THAT(recording.frames, SizeIs(kRows));
    const SensorFrame& first = recording.frames.front();
    const SensorFrame& last = recording.frames.back();
    ASSERT_THAT(first.bodies, SizeIs(1));
    ASSERT_THAT(last.bodies, SizeIs(1));
    const Joint& pelvis = first.bodies[0].skeleton[JointId::SpineBase];
    EXPECT_EQ(pelvis.state, JointState::Tracked);
    EXPECT_LT((pelvis.position - kFirstPelvis).norm(), 1e-4);
    EXPECT_LT((last.bodies[0].skeleton[JointId::SpineBase].position - kLastPelvis).norm(), 1e-4);
    EXPECT_EQ(std::chrono::round<milliseconds>(last.captured - first.captured), kBetween);
  }
};

TEST_P(OldRecording, OfASensorIsRead) {
  const CellRecording read_back = read("sensor.mcap");
  EXPECT_THAT(read_back.damage, IsEmpty());
  ASSERT_THAT(read_back.sensors, SizeIs(1));
  expect_the_take(read_back.sensors[0]);
}

TEST_P(OldRecording, OfACellIsReadWithItsClocksFloorsAndFusedFrames) {
  const CellRecording read_back = read("cell.mcap");
  EXPECT_THAT(read_back.damage, IsEmpty());
  ASSERT_THAT(read_back.sensors, SizeIs(2));
  for (const FrameRecording& sensor : read_back.sensors) {
    expect_the_take(sensor);
    ASSERT_TRUE(sensor.frames.front().floor);
    EXPECT_EQ(sensor.frames.front().floor->offset, 1.25);
    // s2's clock was 400 ms behind and then 410 ms: the recorded clock models bring both together.
    EXPECT_EQ(sensor.frames.front().captured, read_back.sensors[0].frames.front().captured);
  }
  ASSERT_THAT(read_back.fused, SizeIs(kRows));
  const auto& joint = read_back.fused.back().bodies.at(0).joints[index_of(JointId::SpineBase)];
  EXPECT_EQ(joint.contributors, 3U);
  EXPECT_NEAR(joint.variance.value_or(0.0), 1e-4, 1e-9);
}

INSTANTIATE_TEST_SUITE_P(Versions, OldRecording, ::testing::Values("0.2", "0.3", "0.4"),
                         [](const auto& version) {
                           std::string name = version.param;
                           name[1] = '_';
                           return "V" + name;
                         });

}  // namespace
}  // namespace chorus::record
