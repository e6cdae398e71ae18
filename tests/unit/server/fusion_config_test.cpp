// deploy/config/fusion.json and everything that may be wrong with one.
#include "fusion-server/server/fusion_config.h"

#include <gtest/gtest.h>

#include "tests/support/builders.h"

namespace chorus::server {
namespace {

Result<FusionConfig> read(std::string_view text, const std::vector<std::string>& overrides = {}) {
  return read_fusion_config(text, "test.json", overrides);
}

std::string why(std::string_view text) {
  const auto config = read(text);
  return config ? "" : to_string(config.error());
}

TEST(FusionConfig, TheShippedFileIsGoodAndSaysTheDefaults) {
  const auto shipped = load_fusion_config("deploy/config/fusion.json", {});
  ASSERT_TRUE(shipped) << to_string(shipped.error());
  const auto bare = read("{}");
  ASSERT_TRUE(bare);
  EXPECT_EQ(shipped->sensors.size(), 6u);
  EXPECT_EQ(shipped->http.port, bare->http.port);
  EXPECT_EQ(shipped->http.address, "127.0.0.1");
  EXPECT_EQ(shipped->output, bare->output);
  EXPECT_EQ(shipped->session, bare->session);
  EXPECT_EQ(shipped->poll.wait, bare->poll.wait);
  EXPECT_EQ(shipped->poll.max_backoff, bare->poll.max_backoff);
  EXPECT_EQ(shipped->pipeline.align.max_gap, bare->pipeline.align.max_gap);
  EXPECT_EQ(shipped->pipeline.align.patience, bare->pipeline.align.patience);
  EXPECT_EQ(shipped->pipeline.association.gate, bare->pipeline.association.gate);
  EXPECT_EQ(shipped->pipeline.fusion.method, bare->pipeline.fusion.method);
  EXPECT_EQ(shipped->pipeline.fusion.noise.along, bare->pipeline.fusion.noise.along);
  EXPECT_NEAR(shipped->pipeline.quality.max_facing, bare->pipeline.quality.max_facing, 1e-12);
  EXPECT_EQ(shipped->registration.joints, bare->registration.joints);
  EXPECT_EQ(shipped->registration.min_pairs, bare->registration.min_pairs);
  EXPECT_EQ(shipped->registration.good_rms, bare->registration.good_rms);
  EXPECT_EQ(shipped->registration.good_duration, bare->registration.good_duration);
}

TEST(FusionConfig, TheCommandLineWins) {
  const auto config = read(R"({"http": {"port": 1234}})",
                           {"http.port=4321", "fusion.method=otto", "registration.seconds=12.5",
                            R"(sensors=[{"id":"a","url":"http://h:1/"}])"});
  ASSERT_TRUE(config) << to_string(config.error());
  EXPECT_EQ(config->http.port, 4321);
  EXPECT_EQ(config->pipeline.fusion.method, fusion::Method::Otto);
  EXPECT_EQ(config->session.target, from_seconds(12.5));
  ASSERT_EQ(config->sensors.size(), 1u);
  EXPECT_EQ(config->sensors[0].url, "http://h:1/");
}

TEST(FusionConfig, ASensorMayHaveANoiseOfItsOwn) {
  const auto config = read(R"({"fusion": {"noise": {"along_m": 0.05}},
      "sensors": [{"id": "a", "url": "http://h/"},
                  {"id": "b", "url": "http://i/", "noise": {"across_m": 0.2}}]})");
  ASSERT_TRUE(config) << to_string(config.error());
  const auto& own = config->pipeline.fusion.sensor_noise;
  ASSERT_EQ(own.size(), 1u);
  EXPECT_EQ(own.at(testing::sensor_id("b")).across, 0.2);
  EXPECT_EQ(own.at(testing::sensor_id("b")).along, 0.05);  // the general one below it
}

TEST(FusionConfig, EveryMistakeIsNamedAtOnce) {
  const std::string text = why(R"({"outptu": {}, "http": {"port": 99999},
      "fusion": {"method": "magic"},
      "sensors": [{"id": "a b", "url": "http://h/"}, {"id": "c", "url": "nonsense"}]})");
  for (const char* part :
       {"outptu", "output", "http.port", "fusion.method", "sensors.0.id", "sensors.1.url"}) {
    EXPECT_NE(text.find(part), std::string::npos) << part << "\n" << text;
  }
}

TEST(FusionConfig, TwoSensorsOfOneNameOrTooManyAreRefused) {
  EXPECT_NE(
      why(R"({"sensors": [{"id": "a", "url": "http://h/"}, {"id": "a", "url": "http://i/"}]})")
          .find("sensors.1.id"),
      std::string::npos);
  std::string many;
  for (int i = 0; i < 65; ++i) {
    many += (i > 0 ? "," : "") + std::string(R"({"id": "s)") + std::to_string(i) +
            R"(", "url": "http://h/"})";
  }
  EXPECT_NE(why(R"({"sensors": [)" + many + "]}").find("64"), std::string::npos);
}

TEST(FusionConfig, NamesWhatNeedsARestart) {
  const auto a = read("{}");
  const auto b = read(R"({"http": {"port": 1}, "state_dir": "x", "output": {"rate_hz": 60},
      "poll": {"wait_s": 5}})");
  ASSERT_TRUE(a && b);
  EXPECT_EQ(needs_restart(*a, *a), "");
  EXPECT_EQ(needs_restart(*a, *b), "http, poll, state_dir");
}

TEST(FusionConfig, AMissingFileSaysSo) {
  const auto none = load_fusion_config("no/such/file.json", {});
  ASSERT_FALSE(none);
  EXPECT_NE(to_string(none.error()).find("no/such/file.json"), std::string::npos);
}

}  // namespace
}  // namespace chorus::server
