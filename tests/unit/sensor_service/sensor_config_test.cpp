#include "services/sensor/sensor_settings.h"

#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/base/file.h"
#include "common/service/config_source.h"
#include "common/service/waiting_keys.h"
#include "services/sensor/sensor_host.h"
#include "tests/support/builders.h"
#include "tests/support/every_key.h"

namespace chorus::sensor_service {
namespace {

using ::testing::HasSubstr;

Result<SensorSettings> read(const service::ConfigSource& source) {
  return service::read_config(source).and_then(read_sensor_settings);
}

SensorSettings settings_with(std::vector<std::string> assignments, const std::string& path = "") {
  auto settings = read({path, std::move(assignments)});
  EXPECT_TRUE(settings) << to_string(settings.error());
  return settings ? std::move(*settings) : SensorSettings{};
}

Result<SensorSettings> read_text(const std::string& text) {
  return ConfigReader::parse(text, "test").and_then(read_sensor_settings);
}

std::string refusal(std::vector<std::string> assignments) {
  const auto settings = read({"", std::move(assignments)});
  if (!settings) return to_string(settings.error());
  const auto host = SensorHost::make(*settings);
  return host ? "" : to_string(host.error());
}

TEST(SensorConfig, TheCommentedFileSaysTheDefaults) {
  auto documented = settings_with({}, "deploy/config/sensor.json");
  const auto bare = settings_with({});
  EXPECT_EQ(documented.at_start.device.kind, "simulated");
  documented.at_start.device.section = bare.at_start.device.section;
  EXPECT_EQ(documented, bare);
}

TEST(SensorConfig, EveryKeyIsRead) {
  const auto settings = settings_with(
      {"id=cam-2", "http.address=0.0.0.0", "http.port=9000", "http.bearer_token=a secret of 12",
       "http.allowed_origin=http://a", "images=true", "history_s=7", "clock.offset_ms=-250",
       "clock.drift_ppm=50", "clock.step_ms=-2000", "clock.step_after_s=30", "log.level=warn",
       "log.format=json"});
  const auto& [live, at_start] = settings;
  EXPECT_EQ(at_start.id.str(), "cam-2");
  EXPECT_EQ(at_start.http, (http::ServerConfig{"0.0.0.0", 9000, "", "http://a"}));
  EXPECT_EQ(live.tokens, (std::vector<http::Token>{{"a secret of 12", http::Role::Control}}));
  EXPECT_TRUE(live.images);
  EXPECT_EQ(at_start.history, std::chrono::seconds(7));
  EXPECT_EQ(at_start.clock, (ClockErrors{std::chrono::milliseconds(-250), 50e-6,
                                         std::chrono::seconds(-2), std::chrono::seconds(30)}));
  EXPECT_EQ(live.log, (service::LogConfig{log::Level::Warn, log::Format::Json}));
}

TEST(SensorConfig, NoTokenIsShort) {
  for (const std::string shorter :
       {"http.bearer_token=elevenchars", R"(http.tokens=[{"token":"elevenchars"}])"}) {
    EXPECT_THAT(refusal({shorter}), HasSubstr("at least 12 characters")) << shorter;
  }
  EXPECT_EQ(refusal({"http.bearer_token=twelve chars"}), "");
  EXPECT_EQ(refusal({"http.bearer_token="}), "") << "none";
}

TEST(SensorConfig, AllMistakesComeTogether) {
  const std::string text =
      refusal({"id=a b", "http.port=-1", "history_s=0", "log.level=loud", "device.kind=usb",
               "device.simulated.ring.count=0", "device.replay.speeed=1"});
  for (const char* key : {"id", "http.port", "history_s", "log.level", "device.kind",
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
  const auto settings = read({"/no/such.json", {}});
  ASSERT_FALSE(settings);
  EXPECT_THAT(to_string(settings.error()), HasSubstr("/no/such.json"));
}

/// Chooses the device to whose section the key belongs, because only then does the key count.
std::string choosing_its_device(const std::string& key, const std::string& text) {
  auto root = ConfigReader::parse(text, "test");
  for (const std::string kind :
       {"replay", "bridge", "camera", "inertial", "suit", "positioner", "glove"}) {
    const bool chosen = key.starts_with("device." + kind + ".");
    EXPECT_TRUE(!chosen || root->set("device.kind=" + kind));
  }
  // How and when a sensor slips counts only if one does.
  const bool slips = key.starts_with("device.inertial.slips_");
  EXPECT_TRUE(!slips || root->set("device.inertial.slips=ForearmLeft"));
  return root->text();
}

TEST(SensorConfig, AReloadTakesEveryKeyOverOrItWaits) {
  const std::string text = read_file("deploy/config/sensor.json", 1 << 20).value();
  const auto is_good = [](const std::string& t) { return read_text(t).has_value(); };
  const std::set<std::string> live{"log.level", "log.format", "http.bearer_token", "http.tokens",
                                   "images"};
  for (const auto& [key, changed] : chorus::testing::every_key_changed(text, is_good)) {
    if (key.ends_with(".scene.motion")) continue;  // this key needs a file
    ASSERT_NE(changed, "") << "no other value is accepted for " << key;
    const std::string before = choosing_its_device(key, text);
    const std::string after = choosing_its_device(key, changed);
    const auto running = read_text(before);
    const auto next = read_text(after);
    ASSERT_TRUE(running && next) << key;
    EXPECT_NE(*next, *running) << key << " is read, and goes nowhere";
    EXPECT_EQ(next->at_start == running->at_start, live.contains(key)) << key;
    const auto named = service::waiting_keys(
        before, after, [&](const auto& t) { return read_text(t)->at_start != running->at_start; });
    EXPECT_EQ(named,
              live.contains(key) ? std::vector<std::string>{} : std::vector<std::string>{key});
  }
}

TEST(SensorConfig, OnlyTheDeviceThatIsChosenIsMade) {
  const std::vector<std::string> broken{"device.replay.recording=/no/such.mcap"};
  EXPECT_EQ(refusal(broken), "");
  const auto host = SensorHost::make(settings_with(broken));
  ASSERT_TRUE(host);
  EXPECT_EQ(read_text(R"({"device": {"kind": "replay"}})")->at_start.device.kind, "replay");
  http::Router router;
  EXPECT_FALSE(make_device({"usb", "{}"}, {chorus::testing::sensor_id("a"), {}, router}));
}

}  // namespace
}  // namespace chorus::sensor_service
