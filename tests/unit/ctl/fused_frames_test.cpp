#include "services/ctl/convert/fused_samples.h"

#include <gmock/gmock.h>

#include <atomic>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "common/http/server.h"
#include "common/record/recording.h"
#include "common/resource/frame_resource.h"
#include "tests/support/builders.h"
#include "tests/support/matchers.h"
#include "tests/unit/ctl/program_run.h"

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
  for (std::size_t j = 0; j < kJointCount; ++j) body.joints[j] = {person.joints[j], 2.5e-4, 0};
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
  EXPECT_THAT(to_string(raw.error()), HasSubstr("Fuse first: chorus fuse DIR --out fused.mcap"));
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
  const auto frames = read_fused_frames(file.string(), {});
  ASSERT_THAT(frames, IsOk());
  EXPECT_EQ(frames->samples.size(), 3u);
  std::filesystem::remove(file);
}

/// A server whose /frame is given by a function.
struct FrameServer {
  explicit FrameServer(std::function<Result<http::DocumentPtr>(int request)> answer)
      : server({}, routes(std::move(answer))) {
    EXPECT_THAT(server.start(), IsOk());
  }
  std::shared_ptr<const http::Router> routes(std::function<Result<http::DocumentPtr>(int)> answer) {
    auto router = std::make_shared<http::Router>();
    router->get("/frame",
                [this, answer = std::move(answer)](const http::Request&, const http::PathParams&) {
                  return answer(++asked);
                });
    return router;
  }
  [[nodiscard]] std::string url() const {
    return "http://127.0.0.1:" + std::to_string(server.port()) + "/frame";
  }
  std::atomic<int> asked = 0;
  http::Server server;
};

constexpr std::chrono::milliseconds kListen{1500};

TEST(FusedFrames, WhatAServerSaidIsKeptWhenItFailsLaterAndGapsAreTold) {
  FrameServer cell([](int request) -> Result<http::DocumentPtr> {
    if (request == 2) return fail(ErrorCode::Internal, "frame", "an accident");
    if (request == 3) return http::make_document("application/json", "{", {"3"});
    const int frame = request == 1 ? 1 : 5;
    // A restarted server may send the same frame with another ETag.
    return http::make_document("application/json", frame_text(frame),
                               {std::to_string(std::min(request, 6))});
  });
  const auto frames = read_fused_frames(cell.url(), kListen);
  ASSERT_THAT(frames, IsOk());
  EXPECT_EQ(frames->samples.size(), 2u) << "each frame once";
  EXPECT_THAT(frames->notes, ::testing::IsSupersetOf({std::string("3 frames were missed"),
                                                      std::string("1 requests failed"),
                                                      std::string("1 answers could not be used")}));
}

TEST(FusedFrames, AServerWithoutAFrameIsAskedWithPausesOnOneConnection) {
  FrameServer cell([](int) -> Result<http::DocumentPtr> {
    return fail(ErrorCode::Unavailable, "frame", "nobody has been fused yet");
  });
  const auto frames = read_fused_frames(cell.url(), kListen);
  ASSERT_THAT(frames, FailsWith(ErrorCode::Unavailable));
  EXPECT_THAT(to_string(frames.error()), HasSubstr("nobody has been fused yet"));
  EXPECT_LT(cell.asked, 20);
  EXPECT_EQ(cell.server.counters().connections_total, 1u);
}

TEST(FusedFrames, AServerThatRefusesFromTheStartIsNotWaitedFor) {
  FrameServer cell([](int) -> Result<http::DocumentPtr> {
    return http::make_document("application/json", frame_text(1, resource::SpaceKind::Sensor), {});
  });
  EXPECT_THAT(read_fused_frames(cell.url(), std::chrono::hours(1)),
              FailsWith(ErrorCode::Unsupported));
  FrameServer none([](int) -> Result<http::DocumentPtr> {
    return fail(ErrorCode::NotFound, "frame", "no such thing");
  });
  EXPECT_THAT(read_fused_frames(none.url(), std::chrono::hours(1)), FailsWith(ErrorCode::NotFound));
}

TEST(FusedFrames, EvaluateListensToAServer) {
  FrameServer cell([](int request) -> Result<http::DocumentPtr> {
    return http::make_document("application/json", frame_text(request), {std::to_string(request)});
  });
  const auto judged = [](const std::string& url) {
    return run_chorus({"evaluate", "--tracking", url, "--inertial", "none.sto", "--seconds", "1"})
        .error;
  };
  EXPECT_THAT(judged(cell.url()), HasSubstr("none.sto")) << "the tracker was read";
  EXPECT_THAT(judged("http://127.0.0.1:1/"), HasSubstr("cannot connect"));
}

TEST(FusedFrames, SourcesThatAreNoneAreRefused) {
  EXPECT_THAT(read_fused_frames("no/such/file", {}), FailsWith(ErrorCode::NotFound));
  EXPECT_THAT(read_fused_frames("http://127.0.0.1:1/", std::chrono::milliseconds(50)),
              FailsWith(ErrorCode::Unavailable));
}

}  // namespace
}  // namespace chorus::ctl
