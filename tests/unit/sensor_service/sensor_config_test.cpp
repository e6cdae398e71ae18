#include "services/sensor/sensor_config.h"

#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/service/config_source.h"
#include "tests/support/temporary_folder.h"

namespace chorus::sensor_service {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

Result<Setup> read(const service::ConfigSource& source) {
  return service::read_config(source).and_then(
      [](const ConfigReader& root) { return read_setup(root); });
}

Setup setup_with(std::vector<std::string> assignments, const std::string& path = "") {
  auto setup = read({path, std::move(assignments)});
  EXPECT_TRUE(setup) << to_string(setup.error());
  return setup ? std::move(*setup) : Setup{};
}

std::string refusal(std::vector<std::string> assignments) {
  const auto setup = read({"", std::move(assignments)});
  return setup ? "" : to_string(setup.error());
}

TEST(SensorConfig, TheCommentedFileSaysTheDefaults) {
  const auto documented = setup_with({}, "deploy/config/sensor.json");
  EXPECT_EQ(documented.config, setup_with({}).config);
  EXPECT_EQ(documented.device->describe().kind, "simulated");
}

TEST(SensorConfig, EveryKeyIsRead) {
  const auto setup =
      setup_with({"id=cam-2", "http.address=0.0.0.0", "http.port=9000", "http.bearer_token=secret",
                  "http.allowed_origin=http://a", "images=true", "frames_kept=7",
                  "clock.offset_ms=-250", "clock.drift_ppm=50", "clock.step_ms=-2000",
                  "clock.step_after_s=30", "log.level=warn", "log.format=json"});
  const SensorConfig& config = setup.config;
  EXPECT_EQ(config.id.str(), "cam-2");
  EXPECT_EQ(config.http, (http::ServerConfig{"0.0.0.0", 9000, "secret", "http://a"}));
  EXPECT_TRUE(config.images);
  EXPECT_EQ(config.frames_kept, 7u);
  EXPECT_EQ(config.clock, (ClockErrors{std::chrono::milliseconds(-250), 50e-6,
                                       std::chrono::seconds(-2), std::chrono::seconds(30)}));
  EXPECT_EQ(config.log, (service::LogConfig{log::Level::Warn, log::Format::Json}));
  const Duration error = setup.clock->now() - SystemClock().now();
  EXPECT_NEAR(seconds(error), -0.25, 0.1);
}

TEST(SensorConfig, AllMistakesComeTogether) {
  const std::string text =
      refusal({"id=a b", "http.port=-1", "frames_kept=0", "log.level=loud", "device.kind=usb",
               "device.simulated.ring.count=0", "device.replay.speeed=1"});
  for (const char* key : {"id", "http.port", "frames_kept", "log.level", "device.kind",
                          "device.simulated.ring.count", "did you mean 'speed'"}) {
    EXPECT_THAT(text, HasSubstr(key));
  }
}

TEST(SensorConfig, AReplayNeedsARecording) {
  EXPECT_THAT(refusal({"device.kind=replay"}), HasSubstr("device.replay.recording"));
  EXPECT_THAT(refusal({"device.kind=replay", "device.replay.recording=/no/such.mcap"}),
              HasSubstr("/no/such.mcap"));
}

TEST(SensorConfig, AFileThatIsNotThereIsNamed) {
  const auto setup = read({"/no/such.json", {}});
  ASSERT_FALSE(setup);
  EXPECT_THAT(to_string(setup.error()), HasSubstr("/no/such.json"));
}

TEST(SensorConfig, ChangesThatNeedARestartAreNamed) {
  const chorus::testing::TemporaryFolder folder;
  const auto path = (folder / "sensor.json").string();
  std::ofstream(path) << R"({"device": {"simulated": {"latency_ms": 5}}})";
  const auto running = setup_with({});
  EXPECT_THAT(
      restart_keys(running, setup_with({"images=true", "log.level=debug", "http.bearer_token=x"})),
      IsEmpty());
  EXPECT_THAT(restart_keys(running, setup_with({"id=s2", "http.port=1", "clock.drift_ppm=1"})),
              ElementsAre("id", "http", "clock"));
  EXPECT_THAT(restart_keys(running, setup_with({}, path)), ElementsAre("device"));
}

}  // namespace
}  // namespace chorus::sensor_service
