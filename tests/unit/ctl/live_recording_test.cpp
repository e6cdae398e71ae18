// `chorus record` with a fusion server some of whose resources fail.
#include "services/ctl/record/live_recording.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>

#include "common/http/server.h"
#include "common/record/cell_reader.h"
#include "common/resource/frame_resource.h"
#include "common/resource/orientations_resource.h"
#include "common/time/clock.h"
#include "services/ctl/line/command.h"
#include "tests/support/builders.h"
#include "tests/support/matchers.h"
#include "tests/support/temporary_folder.h"
#include "tests/unit/ctl/program_run.h"

namespace chorus::ctl {
namespace {

using chorus::testing::IsOk;
using chorus::testing::kFrameInterval;
using chorus::testing::kStart;
using ::testing::HasSubstr;

std::string frame_of(const std::string& source, int sequence) {
  resource::FrameResource frame;
  frame.sequence = static_cast<std::uint64_t>(sequence);
  frame.captured = kStart + kFrameInterval * sequence;
  frame.source = source;
  return resource::write(frame, resource::Format::Turtle);
}

/// s1 works but misses a frame, s2 is refused, s3 sends nonsense.
class BrokenCell : public ::testing::Test {
 protected:
  BrokenCell() {
    auto router = std::make_shared<http::Router>();
    const auto json = [&](const char* path, const char* text) {
      router->get(path, [text](const http::Request&, const http::PathParams&) {
        return Result<http::DocumentPtr>(http::make_document("application/json", text, {}));
      });
    };
    json("/", R"({"@type":["Tracker"],"title":"broken"})");
    json("/sensors/", R"({"sensors":{"s1":{},"s2":{},"s3":{}}})");
    json("/site/cells/", "{}");
    router->get("/sensors/{id}/frame", [this](const http::Request&, const http::PathParams& path) {
      return frame(path.at("id"));
    });
    router->get("/site/frame", [this](const http::Request&, const http::PathParams&) {
      const int n = std::min(++asked_, 5);
      return Result<http::DocumentPtr>(
          http::make_document("text/turtle", frame_of("site", n), {std::to_string(n)}));
    });
    server_ = std::make_unique<http::Server>(http::ServerConfig{}, router);
    EXPECT_THAT(server_->start(), IsOk());
  }

  virtual Result<http::DocumentPtr> frame(const std::string& sensor) {
    if (sensor == "s2") return fail(ErrorCode::Unauthorized, "frame", "who are you?");
    if (sensor == "s3")
      return http::make_document("text/turtle", "<a> <b>",
                                 {std::to_string(std::min(++nonsense_, 5))});
    const int n = std::min(++asked_, 5);
    return http::make_document("text/turtle", frame_of("s1", n < 3 ? n : n + 1),
                               {std::to_string(n)});
  }

  [[nodiscard]] std::string url() const {
    return "http://127.0.0.1:" + std::to_string(server_->port()) + "/";
  }

  /// Records the raw frames of the three sensors.
  [[nodiscard]] LiveRecordingOptions options() const {
    LiveRecordingOptions raw;
    raw.service = http::parse_url(url()).value();
    raw.file = (folder_ / "a.mcap").string();
    raw.fused = false;
    return raw;
  }

  chorus::testing::TemporaryFolder folder_;
  std::atomic<int> asked_ = 0;
  std::atomic<int> nonsense_ = 0;
  std::unique_ptr<http::Server> server_;
};

TEST_F(BrokenCell, CountsWhatFailedAndWhatCouldNotBeReadFromTheBeginning) {
  asio::io_context io{1};
  const auto live = LiveRecording::start(io, options());
  ASSERT_TRUE(live) << to_string(live.error());
  const auto& counts = (*live)->counts();
  ASSERT_EQ(counts.size(), 3u) << "all that was announced, before anything has come";
  const auto& s1 = counts.at("/sensors/s1/frame");
  const auto& s2 = counts.at("/sensors/s2/frame");
  const auto& s3 = counts.at("/sensors/s3/frame");
  while (s1.frames < 4 || s2.failed < 2 || s3.unreadable < 2) io.run_one();
  (void)(*live)->stop();
  EXPECT_EQ(s1.missed, 1u);
  EXPECT_EQ(s1.failed, 0u);
  EXPECT_EQ(s2.frames, 0u);
  EXPECT_THAT(s2.error, HasSubstr("401"));
  EXPECT_THAT(s2.error, HasSubstr("who are you?"));
  EXPECT_EQ(s3.frames, 0u);
  EXPECT_NE(s3.error, "");
}

TEST_F(BrokenCell, IsRecordedAsAHallWithoutItsSensors) {
  LiveRecordingOptions hall = options();
  hall.site = hall.fused = true;
  hall.raw = false;
  asio::io_context io{1};
  const auto live = LiveRecording::start(io, hall);
  ASSERT_TRUE(live) << to_string(live.error());
  const auto& counts = (*live)->counts();
  ASSERT_EQ(counts.size(), 1u) << "nothing but the hall";
  while (counts.at("/site/frame").frames < 4) io.run_one();
  const auto report = (*live)->stop();
  EXPECT_GE(report.frames, 4u);
  const auto outcome = run_chorus({"record", url(), "--site", "--raw", "--out", "b.mcap"});
  EXPECT_EQ(outcome.code, kExitUsage);
}

/// s1 is well; s2 died five minutes ago and is asked for what it saw last.
class HalfDeadCell : public BrokenCell {
 protected:
  Result<http::DocumentPtr> frame(const std::string& sensor) override {
    if (sensor == "s3") return fail(ErrorCode::Unavailable, "frame", "none yet");
    const int n = sensor == "s2" ? 1 : std::min(++asked_, 5);
    resource::FrameResource frame;
    frame.sequence = static_cast<std::uint64_t>(n);
    frame.captured = SystemClock().now() - kFrameInterval * (5 - n);
    if (sensor == "s2") ++dead_asked_, frame.captured = died_;
    frame.source = sensor;
    return http::make_document("text/turtle", resource::write(frame, resource::Format::Turtle),
                               {std::to_string(n)});
  }

  std::atomic<int> dead_asked_ = 0;
  const Timestamp died_ = SystemClock().now() - std::chrono::minutes(5);
};

TEST_F(HalfDeadCell, WhatADeadSensorSawLastIsNotRecorded) {
  asio::io_context io{1};
  const auto live = LiveRecording::start(io, options());
  ASSERT_TRUE(live) << to_string(live.error());
  const auto& counts = (*live)->counts();
  while (counts.at("/sensors/s1/frame").frames < 4 || dead_asked_ < 2) io.run_one();
  (void)(*live)->stop();
  EXPECT_EQ(counts.at("/sensors/s2/frame").frames, 0u);
  EXPECT_EQ(counts.at("/sensors/s2/frame").failed, 0u);
  const auto cell = record::read_cell(options().file);
  ASSERT_TRUE(cell) << to_string(cell.error());
  ASSERT_EQ(cell->sensors.size(), 1u);
  EXPECT_EQ(cell->sensors.front().sensor.str(), "s1");
}

TEST(StreamCount, WhatComesLateIsNotMissed) {
  client::StreamCount count;
  for (const std::uint64_t number : {5, 6, 10, 8, 7, 11}) count.take(number);
  EXPECT_EQ(count.frames, 6u);
  EXPECT_EQ(count.missed, 1u) << "9";
  EXPECT_EQ(count.last, 11u);
  for (const std::uint64_t number : {1000, 1, 2, 4}) count.take(number);
  EXPECT_EQ(count.missed, 1u + 988u + 1u) << "the device began anew with 1, and 3 is missing";
}

/// A tracker without sensors that follows a suit, and a suit by itself.
class CellWithASuit : public ::testing::Test {
 protected:
  CellWithASuit() {
    auto router = std::make_shared<http::Router>();
    const auto json = [&](const char* path, const char* text) {
      router->get(path, [text](const http::Request&, const http::PathParams&) {
        return Result<http::DocumentPtr>(http::make_document("application/json", text, {}));
      });
    };
    json("/tracker/", R"({"@type":["Tracker"]})");
    json("/tracker/sensors/", R"({"sensors":{}})");
    json(
        "/tracker/inertial/",
        R"({"inertialSources":{"suit":{"clockOffsetMilliseconds":250,"clockUncertaintyMilliseconds":1,"clockCorrected":true,"state":"live"}}})");
    json("/suit/", R"({"@type":["Sensor"],"sensorId":"suit","orientations":"orientations"})");
    for (const char* path : {"/tracker/inertial/suit/orientations", "/suit/orientations"}) {
      router->get(path, [this](const http::Request&, const http::PathParams&) { return said(); });
    }
    server_ = std::make_unique<http::Server>(http::ServerConfig{}, router);
    EXPECT_THAT(server_->start(), IsOk());
  }

  Result<http::DocumentPtr> said() {
    resource::OrientationsResource document;
    document.sequence = static_cast<std::uint64_t>(std::min(++asked_, 6));
    document.source = "suit";
    auto& instant = document.instants.emplace_back();
    instant.sequence = document.sequence;
    instant.captured = begun_ + std::chrono::milliseconds(20 * document.sequence);
    instant.source = chorus::testing::sensor_id("suit");
    auto& one = instant.readings.emplace_back();
    one.sensor = "pelvis";
    one.captured = document.captured = instant.captured;
    one.inertial_from_sensor = Eigen::Quaterniond::Identity();
    return http::make_document("application/json",
                               resource::write(document, resource::Format::Json),
                               {std::to_string(document.sequence)});
  }

  /// Records below `path` until four documents have come; the readings by the recorder's clock.
  std::vector<inertial::InertialFrame> recorded(const std::string& path, const std::string& topic) {
    LiveRecordingOptions options;
    options.service =
        http::parse_url("http://127.0.0.1:" + std::to_string(server_->port()) + path).value();
    options.file = (folder_ / "a.mcap").string();
    options.fused = false;
    asio::io_context io{1};
    const auto live = LiveRecording::start(io, options);
    EXPECT_TRUE(live) << to_string(live.error());
    if (!live) return {};
    EXPECT_EQ((*live)->counts().size(), 1u) << "a suit has no /frame";
    while ((*live)->counts().at(topic).frames < 4) io.run_one();
    (void)(*live)->stop();
    const auto cell = record::read_cell(options.file, {.inertial = true});
    EXPECT_THAT(cell, IsOk());
    return cell->inertial.at(chorus::testing::sensor_id("suit")).instants;
  }

  chorus::testing::TemporaryFolder folder_;
  std::atomic<int> asked_ = 0;
  const Timestamp begun_ = SystemClock().now();
  std::unique_ptr<http::Server> server_;
};

TEST_F(CellWithASuit, IsRecordedFromTheTrackerWithItsClock) {
  const auto instants = recorded("/tracker/", "/inertial/suit/orientations");
  ASSERT_GE(instants.size(), 4u);
  EXPECT_EQ(instants[0].captured - begun_, std::chrono::milliseconds(20 + 250));
  EXPECT_EQ(instants[0].readings.at(0).sensor, "pelvis");
}

TEST_F(CellWithASuit, IsRecordedAlone) {
  const auto instants = recorded("/suit/", "/orientations");
  ASSERT_GE(instants.size(), 4u);
  EXPECT_EQ(instants[3].captured - begun_, std::chrono::milliseconds(80));
}

TEST_F(BrokenCell, MakesTheCommandFailThoughSomethingCame) {
  const std::string out = (folder_ / "a.mcap").string();
  const std::string service = url();
  const std::array arguments{"chorus", "record",    service.c_str(), "--raw",
                             "--out",  out.c_str(), "--seconds",     "1"};
  ::testing::internal::CaptureStderr();
  ::testing::internal::CaptureStdout();
  const int code =
      run_command_line(all_commands(), static_cast<int>(arguments.size()), arguments.data());
  const std::string table = ::testing::internal::GetCapturedStdout();
  const std::string errors = ::testing::internal::GetCapturedStderr();
  EXPECT_EQ(code, kExitFailed);
  EXPECT_THAT(table, HasSubstr("failed"));
  EXPECT_THAT(table, HasSubstr("unreadable"));
  EXPECT_THAT(table, HasSubstr("/sensors/s2/frame"));
  EXPECT_THAT(errors, HasSubstr("delivered no frame of /sensors/s2/frame, /sensors/s3/frame"));
  EXPECT_TRUE(std::filesystem::exists(out)) << "what came is kept";
}

TEST_F(BrokenCell, TellsTheSameAsJson) {
  const std::string out = (folder_ / "a.mcap").string();
  const Outcome told =
      run_chorus({"record", url(), "--raw", "--out", out, "--seconds", "1", "--json"});
  EXPECT_EQ(told.code, kExitFailed);
  const auto json = nlohmann::json::parse(told.out);
  EXPECT_EQ(json.at("file"), out);
  EXPECT_EQ(json.at("bytes"), std::filesystem::file_size(out));
  EXPECT_GT(json.at("seconds"), 0.0);
  const auto& streams = json.at("streams");
  EXPECT_EQ(streams.size(), 3u) << "--raw: no fused frames";
  EXPECT_EQ(json.at("frames"), streams.at("/sensors/s1/frame").at("frames"));
  EXPECT_FALSE(streams.at("/sensors/s1/frame").contains("lastError"));
  EXPECT_THAT(streams.at("/sensors/s2/frame").at("lastError").get<std::string>(), HasSubstr("401"));
  EXPECT_EQ(streams.at("/sensors/s2/frame").at("frames"), 0);
}

}  // namespace
}  // namespace chorus::ctl
