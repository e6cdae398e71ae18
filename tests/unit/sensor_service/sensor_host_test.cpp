#include "services/sensor/sensor_host.h"

#include <gmock/gmock.h>

#include <condition_variable>
#include <mutex>

#include "common/http/client.h"
#include "tests/support/builders.h"

namespace chorus::sensor_service {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

/// Throws during its first run; then delivers one frame and waits.
class FragileDevice final : public FrameSource {
 public:
  explicit FragileDevice(std::shared_ptr<std::atomic<int>> runs) : runs_(std::move(runs)) {}

  [[nodiscard]] DeviceDescription describe() const override {
    return {"fragile", "fragile", {}, 1};
  }

  [[nodiscard]] Result<void> run(std::stop_token stop, const Sink& sink) override {
    const int run = ++*runs_;
    Capture capture;
    capture.frame = chorus::testing::sensor_frame(
        "s1", chorus::testing::kStart + std::chrono::seconds(run), {});
    capture.frame.sequence = 1;
    sink(std::move(capture));
    if (run == 1) throw 7;
    std::mutex mutex;
    std::unique_lock lock(mutex);
    std::condition_variable_any().wait(lock, stop, [] { return false; });
    return {};
  }

 private:
  std::shared_ptr<std::atomic<int>> runs_;
};

TEST(SensorHost, ADeviceThatThrowsIsStartedAgainAndItsNumbersGoOn) {
  const auto runs = std::make_shared<std::atomic<int>>(0);
  sensor_service::Setup setup;
  setup.settings.at_start.id = chorus::testing::sensor_id("s1");
  setup.settings.at_start.http.port = 0;
  setup.clock = std::make_shared<SystemClock>();
  setup.device = std::make_unique<FragileDevice>(runs);
  SensorHost host(std::move(setup));
  ASSERT_TRUE(host.start());
  const auto ask = [&](const std::string& path, std::vector<http::Header> headers = {}) {
    return http::fetch({"127.0.0.1", host.port(), path}, {.headers = std::move(headers)}).value();
  };
  std::string frame;
  std::string etag;
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(30);
  while (frame.find("\"sequence\":2") == std::string::npos &&
         std::chrono::steady_clock::now() < deadline) {
    const auto answer = ask(
        "/frame", {{"Accept", "application/json"}, {"If-None-Match", etag}, {"Prefer", "wait=5"}});
    const auto found = answer.headers.find("etag");
    if (found != answer.headers.end()) etag = found->second;
    frame = answer.body;
  }
  const std::string metrics = ask("/metrics").body;
  EXPECT_THAT(metrics, HasSubstr("chorus_frames_captured_total 2"));
  EXPECT_THAT(metrics, HasSubstr("chorus_failures_total 1"));
  EXPECT_THAT(metrics, HasSubstr("chorus_captures_refused_total 0"));
  EXPECT_EQ(*runs, 2);
  host.stop();
}

TEST(SensorHost, ASocketThatCannotBeMadeIsAConcernBeforeTheStart) {
  SensorSettings settings;
  settings.at_start.id = chorus::testing::sensor_id("s1");
  settings.at_start.http.port = 0;
  const auto concerns = [&](const std::string& socket) {
    settings.at_start.device = {"bridge", "{\"socket\": \"" + socket + "\"}"};
    const auto host = SensorHost::make(settings);
    return host ? ::testing::PrintToString((*host)->concerns()) : to_string(host.error());
  };
  EXPECT_THAT(concerns("/nonexistent/x.sock"),
              AllOf(HasSubstr("device.bridge.socket"), HasSubstr("there is no folder /nonexistent"),
                    HasSubstr("/run/chorus-sensor")));
  EXPECT_THAT(concerns("/etc/passwd"), HasSubstr("there is a file that is no socket"));
  EXPECT_THAT(concerns(""), ::testing::Not(HasSubstr("socket")));
}

}  // namespace
}  // namespace chorus::sensor_service
