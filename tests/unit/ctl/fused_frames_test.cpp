#include "services/ctl/fused_frames.h"

#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "common/record/recording.h"
#include "common/resource/frame_resource.h"
#include "tests/support/builders.h"
#include "tests/support/matchers.h"

namespace chorus::ctl {
namespace {

using chorus::testing::FailsWith;
using chorus::testing::IsOk;
using chorus::testing::kFrameInterval;
using chorus::testing::kStart;
using ::testing::HasSubstr;

std::string frame_text(int i, resource::SpaceKind space = resource::SpaceKind::World) {
  resource::FrameResource frame;
  frame.sequence = static_cast<std::uint64_t>(i);
  frame.captured = kStart + i * kFrameInterval;
  frame.source = space == resource::SpaceKind::World ? "fusion" : "cam01";
  frame.space = space;
  auto& body = frame.bodies.emplace_back();
  body.id = 4;
  body.captured = frame.captured;
  const auto person = testing::standing_person({0.1 * i, 0, 0});
  for (std::size_t j = 0; j < kJointCount; ++j) {
    body.joints[j] = {person.joints[j].position, person.joints[j].orientation,
                      person.joints[j].state, 2.5e-4, 0};
  }
  std::string text = resource::write(frame, resource::Format::Json);
  while (text.ends_with('\n')) text.pop_back();
  return text;
}

Result<FusedSamples> lines(const std::string& text) {
  std::istringstream in(text);
  return read_fused_lines(in, "fused.ndjson");
}

TEST(FusedFrames, LinesBecomeSamplesWithTheirVariances) {
  const auto samples = lines(frame_text(0) + "\n\n" + frame_text(1));
  ASSERT_THAT(samples, IsOk());
  ASSERT_EQ(samples->size(), 2u);
  EXPECT_EQ((*samples)[1].person, PersonId{4});
  EXPECT_EQ((*samples)[1].instant, kStart + kFrameInterval);
  EXPECT_NEAR((*samples)[1].skeleton[JointId::SpineBase].position.x(), 0.1, 1e-3);
  EXPECT_NEAR((*samples)[0].variance[0], 2.5e-4, 1e-6);
}

TEST(FusedFrames, WrongLinesAreNamed) {
  const auto broken = lines(frame_text(0) + "\n{\n");
  ASSERT_THAT(broken, FailsWith(ErrorCode::Malformed));
  EXPECT_THAT(to_string(broken.error()), HasSubstr("fused.ndjson:2"));
  const auto raw = lines(frame_text(0, resource::SpaceKind::Sensor));
  ASSERT_THAT(raw, FailsWith(ErrorCode::Unsupported));
  EXPECT_THAT(to_string(raw.error()), HasSubstr("Fuse first: chorus fuse"));
  EXPECT_THAT(lines(std::string(20u << 20, ' ')), FailsWith(ErrorCode::TooLarge));
}

TEST(FusedFrames, RecordingsGiveTheirFusedTopicOnly) {
  const auto file = std::filesystem::path(::testing::TempDir()) / "chorus-fused.mcap";
  std::filesystem::remove(file);
  {
    auto writer = record::RecordingWriter::create(file).value();
    const auto fused = writer.add_channel({"/frame", "chorus.Frame", "{}"}).value();
    const auto raw = writer.add_channel({"/sensors/cam01/frame", "chorus.Frame", "{}"}).value();
    for (int i = 0; i < 3; ++i) {
      const auto at = kStart + i * kFrameInterval;
      ASSERT_THAT(writer.write(fused, {"", 0, at, at, frame_text(i)}), IsOk());
      ASSERT_THAT(writer.write(raw, {"", 0, at, at, frame_text(i, resource::SpaceKind::Sensor)}),
                  IsOk());
    }
    ASSERT_THAT(writer.close(), IsOk());
  }
  const auto samples = read_fused_frames(file.string(), {});
  ASSERT_THAT(samples, IsOk());
  EXPECT_EQ(samples->size(), 3u);
  std::filesystem::remove(file);
}

TEST(FusedFrames, SourcesThatAreNoneAreRefused) {
  EXPECT_THAT(read_fused_frames("no/such/file", {}), FailsWith(ErrorCode::NotFound));
  EXPECT_THAT(read_fused_frames("http://127.0.0.1:1/", std::chrono::milliseconds(50)),
              FailsWith(ErrorCode::Unavailable));
}

}  // namespace
}  // namespace chorus::ctl
