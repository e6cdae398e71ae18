#include "common/record/frame_recording.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/builders.h"
#include "tests/support/temporary_folder.h"

namespace chorus::record {
namespace {

using chorus::testing::kFrameInterval;
using chorus::testing::kStart;
using chorus::testing::TemporaryFolder;
using ::testing::HasSubstr;

FrameRecording walk(int frames) {
  FrameRecording out;
  out.sensor = chorus::testing::sensor_id("cam01");
  out.device = "Kinect v2";
  out.intrinsics = Intrinsics{1920, 1080, 1081.37, 1081.4, 959.5, 539.5, {0.1, -0.02, 1e-5, 0, 0}};
  const auto pose = chorus::testing::ring_sensor(1, 4);
  out.floor = chorus::testing::floor_seen_from(pose);
  out.notes = {{"origin", "a test"}, {"set_period_ns", "5000000000"}};
  for (int i = 0; i < frames; ++i) {
    const Timestamp t = kStart + kFrameInterval * i;
    const auto person = chorus::testing::standing_person({0.01 * i, 0, 0}, 0.1 * i);
    SensorFrame frame = chorus::testing::sensor_frame(
        "cam01", t, {chorus::testing::body_seen_from(pose, person, t, 3)});
    chorus::testing::hide(frame.bodies[0].skeleton[JointId::FootLeft]);
    frame.bodies[0].skeleton[JointId::HandLeft].state = JointState::Inferred;
    out.frames.push_back(std::move(frame));
  }
  return out;
}

TEST(FrameRecording, KeepsWhichModelALensHas) {
  const TemporaryFolder folder;
  FrameRecording written = walk(2);
  written.intrinsics->model = LensModel::Fisheye;
  ASSERT_TRUE(write_frame_recording(folder / "a.mcap", written));
  const auto read = read_frame_recording(folder / "a.mcap");
  ASSERT_TRUE(read) << to_string(read.error());
  EXPECT_EQ(read->intrinsics, written.intrinsics);
}

TEST(FrameRecording, ReadsBackWhatWasWritten) {
  const TemporaryFolder folder;
  const FrameRecording written = walk(100);
  const auto ok = write_frame_recording(folder / "a.mcap", written);
  ASSERT_TRUE(ok) << to_string(ok.error());
  const auto read = read_frame_recording(folder / "a.mcap");
  ASSERT_TRUE(read) << to_string(read.error());
  EXPECT_EQ(read->sensor, written.sensor);
  EXPECT_EQ(read->device, written.device);
  EXPECT_EQ(read->intrinsics, written.intrinsics) << "to the last digit";
  EXPECT_EQ(read->notes, written.notes);
  ASSERT_TRUE(read->floor);
  EXPECT_LT((read->floor->normal - written.floor->normal).norm(), 1e-12);
  EXPECT_NEAR(read->floor->offset, written.floor->offset, 1e-12);
  ASSERT_EQ(read->frames.size(), written.frames.size());
  for (std::size_t i = 0; i < read->frames.size(); ++i) {
    const SensorFrame& a = read->frames[i];
    const SensorFrame& b = written.frames[i];
    EXPECT_EQ(a.captured, b.captured) << "to the nanosecond";
    EXPECT_EQ(a.sequence, b.sequence);
    EXPECT_EQ(a.sensor, b.sensor);
    EXPECT_TRUE(a.floor);
    ASSERT_EQ(a.bodies.size(), 1u);
    EXPECT_EQ(a.bodies[0].id, b.bodies[0].id);
    for (std::size_t j = 0; j < kJointCount; ++j) {
      const Joint& x = a.bodies[0].skeleton.joints[j];
      const Joint& y = b.bodies[0].skeleton.joints[j];
      EXPECT_EQ(x.state, y.state);
      if (y.state == JointState::NotTracked) continue;
      EXPECT_LT((x.position - y.position).norm(), 1e-4) << "four decimals";
      EXPECT_LT((x.orientation.coeffs() - y.orientation.coeffs()).norm(), 2e-5) << "five decimals";
    }
  }
}

TEST(FrameRecording, AFloorPlaneThatChangesOnTheWayIsKept) {
  const TemporaryFolder folder;
  FrameRecording written = walk(30);
  for (int i = 10; i < 20; ++i) written.frames[i].floor = FloorPlane{Eigen::Vector3d::UnitY(), 2.5};
  ASSERT_TRUE(write_frame_recording(folder / "a.mcap", written));
  const auto read = read_frame_recording(folder / "a.mcap");
  ASSERT_TRUE(read);
  EXPECT_NEAR(read->frames[9].floor->offset, written.floor->offset, 1e-12);
  EXPECT_EQ(read->frames[10].floor->offset, 2.5);
  EXPECT_EQ(read->frames[29].floor->offset, 2.5) << "a floor does not go away";
}

TEST(FrameRecording, ReplacesAnEarlierFileOnlyWhenItIsWhole) {
  const TemporaryFolder folder;
  ASSERT_TRUE(write_frame_recording(folder / "a.mcap", walk(5)));
  ASSERT_TRUE(write_frame_recording(folder / "a.mcap", walk(7)));
  EXPECT_EQ(read_frame_recording(folder / "a.mcap")->frames.size(), 7u);
  FrameRecording wrong = walk(9);
  std::swap(wrong.frames[2], wrong.frames[3]);
  EXPECT_FALSE(write_frame_recording(folder / "a.mcap", wrong));
  EXPECT_EQ(read_frame_recording(folder / "a.mcap")->frames.size(), 7u);
  EXPECT_FALSE(std::filesystem::exists(folder / "a.mcap.partial"));
}

TEST(FrameRecording, TimeThatRepeatsOrGoesBackIsRefusedWithItsPlace) {
  const TemporaryFolder folder;
  FrameRecording wrong = walk(5);
  wrong.frames[3].captured = wrong.frames[2].captured;
  const auto repeats = write_frame_recording(folder / "a.mcap", wrong);
  ASSERT_FALSE(repeats);
  EXPECT_THAT(repeats.error().message, HasSubstr("frame 3 of 5 repeats"));
  wrong.frames[3].captured = wrong.frames[0].captured;
  EXPECT_THAT(write_frame_recording(folder / "a.mcap", wrong).error().message,
              HasSubstr("frame 3 of 5 goes back in time"));
}

/// A file whose message times advance while the captures inside do not.
TEST(FrameRecording, AFileWhoseCapturesGoBackIsRefused) {
  const TemporaryFolder folder;
  ASSERT_TRUE(write_frame_recording(folder / "good.mcap", walk(3)));
  auto recording = read_recording(folder / "good.mcap");
  ASSERT_TRUE(recording);
  auto writer = RecordingWriter::create(folder / "bad.mcap");
  const auto channel = writer->add_channel({"/frame", "", "", {}});
  for (std::size_t i = 0; i < 3; ++i) {
    Message message = recording->messages[2 - i];
    message.log_time = kStart + kFrameInterval * static_cast<int>(i);
    ASSERT_TRUE(writer->write(*channel, message));
  }
  ASSERT_TRUE(writer->close());
  const auto read = read_frame_recording(folder / "bad.mcap");
  ASSERT_FALSE(read);
  EXPECT_THAT(read.error().message, HasSubstr("goes back in time"));
  EXPECT_THAT(read.error().context, HasSubstr("bad.mcap"));
}

TEST(FrameRecording, AMessageThatIsNoFrameIsNamed) {
  const TemporaryFolder folder;
  for (const char* text : {"", "{", "[]", "{\"sequence\":1}"}) {
    std::filesystem::remove(folder / "a.mcap");
    auto writer = RecordingWriter::create(folder / "a.mcap");
    const auto channel = writer->add_channel({"/frame", "", "", {}});
    ASSERT_TRUE(writer->write(*channel, {"", 0, kStart, kStart, text}));
    ASSERT_TRUE(writer->close());
    const auto read = read_frame_recording(folder / "a.mcap");
    ASSERT_FALSE(read) << text;
    EXPECT_THAT(read.error().message, HasSubstr("frame 0")) << text;
  }
}

TEST(FrameRecording, ATruncatedOneSaysSoInItsNotes) {
  const TemporaryFolder folder;
  ASSERT_TRUE(write_frame_recording(folder / "a.mcap", walk(100)));
  const auto size = std::filesystem::file_size(folder / "a.mcap");
  std::filesystem::resize_file(folder / "a.mcap", size / 2);
  const auto read = read_frame_recording(folder / "a.mcap");
  ASSERT_TRUE(read);
  EXPECT_GT(read->frames.size(), 10u);
  EXPECT_LT(read->frames.size(), 100u);
  EXPECT_THAT(read->notes.at("damage.1"), HasSubstr("the end is missing"));
  EXPECT_EQ(read->device, "Kinect v2");
}

TEST(FrameRecording, ForeignMetadataIsHarmless) {
  const TemporaryFolder folder;
  auto writer = RecordingWriter::create(folder / "a.mcap");
  ASSERT_TRUE(writer->write_metadata("chorus", {{"sensor", "not/an id"},
                                                {"width", "1e99"},
                                                {"height", "nan"},
                                                {"fx", "x"},
                                                {"floor_normal_x", "0"},
                                                {"floor_normal_y", "0"},
                                                {"floor_normal_z", "0"},
                                                {"floor_offset", "1"}}));
  ASSERT_TRUE(writer->close());
  const auto read = read_frame_recording(folder / "a.mcap");
  ASSERT_TRUE(read);
  EXPECT_EQ(read->sensor.str(), "");
  EXPECT_FALSE(read->intrinsics);
  EXPECT_FALSE(read->floor);
}

}  // namespace
}  // namespace chorus::record
