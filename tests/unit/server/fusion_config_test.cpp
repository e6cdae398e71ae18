// deploy/config/fusion.json and all mistakes that a configuration may contain.
#include "fusion-server/server/fusion_settings.h"

#include <gtest/gtest.h>

#include "common/base/file.h"
#include "common/service/config_source.h"
#include "common/service/waiting_keys.h"
#include "fusion-server/learn/error_file.h"
#include "tests/support/builders.h"
#include "tests/support/every_key.h"
#include "tests/support/temporary_folder.h"

namespace chorus::server {
namespace {

Result<FusionSettings> read(std::string_view text, const std::vector<std::string>& overrides = {}) {
  auto root = ConfigReader::parse(text, "test.json");
  if (!root) return pass(root);
  for (const std::string& assignment : overrides) {
    if (auto ok = root->set(assignment); !ok) return pass(ok);
  }
  return read_fusion_settings(*root);
}

std::string why(std::string_view text) {
  const auto settings = read(text);
  return settings ? "" : to_string(settings.error());
}

TEST(FusionConfig, TheShippedFileIsGoodAndSaysTheDefaults) {
  auto shipped =
      service::read_config({"deploy/config/fusion.json", {}}).and_then(read_fusion_settings);
  ASSERT_TRUE(shipped) << to_string(shipped.error());
  EXPECT_EQ(shipped->live.sensors.size(), 6u);
  EXPECT_EQ(shipped->at_start.viewer_dir, "auto");
  shipped->live.sensors.clear();
  const auto bare = read("{}");
  ASSERT_TRUE(bare);
  EXPECT_EQ(shipped->at_start, bare->at_start);
  EXPECT_EQ(shipped->live, bare->live);
}

TEST(FusionConfig, TheCommandLineWins) {
  const auto config = read(R"({"http": {"port": 1234}})",
                           {"http.port=4321", "fusion.method=otto", "registration.seconds=12.5",
                            R"(sensors=[{"id":"a","url":"http://h:1/"}])"});
  ASSERT_TRUE(config) << to_string(config.error());
  EXPECT_EQ(config->at_start.http.port, 4321);
  EXPECT_EQ(config->live.pipeline.fusion.method, fusion::Method::Otto);
  EXPECT_EQ(config->live.session.target, from_seconds(12.5));
  ASSERT_EQ(config->live.sensors.size(), 1u);
  EXPECT_EQ(config->live.sensors[0].url, "http://h:1/");
}

TEST(FusionConfig, ASensorMayHaveANoiseOfItsOwn) {
  const auto config = read(R"({"fusion": {"noise": {"along_m": 0.05}},
      "sensors": [{"id": "a", "url": "http://h/"},
                  {"id": "b", "url": "http://i/", "noise": {"across_m": 0.2}}]})");
  ASSERT_TRUE(config) << to_string(config.error());
  const auto& own = config->live.pipeline.fusion.sensor_noise;
  ASSERT_EQ(own.size(), 1u);
  EXPECT_EQ(own.at(testing::sensor_id("b")).across, 0.2);
  EXPECT_EQ(own.at(testing::sensor_id("b")).along, 0.05);  // inherited from the general `along`
}

TEST(FusionConfig, ReadsLearnedErrorsOfAllSensorsAndOfOne) {
  const testing::TemporaryFolder folder;
  fusion::ErrorPredictor predictor;
  predictor.joints[index_of(JointId::Head)] = fusion::JointPredictor{};
  const std::string file = (folder / "kinect.json").string();
  ASSERT_TRUE(replace_file(file, learn::write_predictor(predictor)));
  const auto config = read(R"({"fusion": {"errors": ")" + file + R"("},
      "sensors": [{"id": "a", "url": "http://h/"},
                  {"id": "b", "url": "http://i/", "errors": ""}]})");
  ASSERT_TRUE(config) << to_string(config.error());
  const fusion::FusionConfig& fusion = config->live.pipeline.fusion;
  ASSERT_TRUE(fusion.errors.model);
  EXPECT_EQ(*fusion.errors.model, predictor);
  ASSERT_EQ(fusion.sensor_errors.size(), 1u);
  EXPECT_FALSE(fusion.sensor_errors.at(testing::sensor_id("b")).model);
  EXPECT_NE(why(R"({"fusion": {"errors": "no/such.json"}})").find("no/such.json"),
            std::string::npos);
  ASSERT_TRUE(replace_file(file, "{}"));
  EXPECT_NE(
      why(R"({"fusion": {"errors": ")" + file + R"("}})").find("no file of `chorus train-error`"),
      std::string::npos);
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

TEST(FusionConfig, AKeyOfAnEarlierVersionIsNamedWithWhatReplacesIt) {
  const std::string text = why(R"({"association": {"alone_s": 3, "look_range_m": "far"}})");
  for (const char* key : {"association.alone_s", "association.look_range_m"})
    EXPECT_NE(text.find(std::string(key) + ": is no longer read"), std::string::npos) << text;
  EXPECT_NE(text.find("association.doubt_s"), std::string::npos) << text;
  EXPECT_EQ(text.find("unknown key"), std::string::npos) << text;
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

TEST(FusionConfig, ReadsHowFarSensorsMayDifferInLatency) {
  const auto none = read(R"({"registration": {"latency_sigma_ms": 0}})");
  ASSERT_TRUE(none) << to_string(none.error());
  EXPECT_EQ(none->live.registration.latency_sigma, Duration{0});
  EXPECT_NE(why(R"({"registration": {"latency_sigma_ms": 201}})").find("latency_sigma_ms"),
            std::string::npos);
}

TEST(FusionConfig, ALengthForCamerasNamesTwoSensors) {
  const auto config = read(R"({"registration": {"stature_m": 1.78,
      "known_distances": [{"between": ["cam1", "cam2"], "m": 4.31}]}})");
  ASSERT_TRUE(config) << to_string(config.error());
  const auto& registration = config->live.registration;
  EXPECT_EQ(registration.stature, 1.78);
  ASSERT_EQ(registration.known_distances.size(), 1u);
  EXPECT_EQ(registration.known_distances[0].second.str(), "cam2");
  EXPECT_EQ(registration.known_distances[0].length, 4.31);
  const auto refused = [](const std::string& one) {
    return why(R"({"registration": {"known_distances": [)" + one + "]}}");
  };
  EXPECT_NE(refused(R"({"between": ["cam1"], "m": 4.31})").find("must name two sensors"),
            std::string::npos);
  EXPECT_NE(refused(R"({"between": ["cam1", "cam1"], "m": 4.31})"), "");
  EXPECT_NE(refused(R"({"between": ["cam1", "cam2"]})").find("in metres"), std::string::npos);
  EXPECT_NE(refused(R"({"between": ["cam1", "cam2"], "m": 431})"), "") << "given in centimetres";
  EXPECT_NE(refused(R"({"between": ["cam1", "cam2"], "m": 0.04})"), "");
}

TEST(FusionConfig, AReloadTakesEveryKeyOverOrItWaits) {
  const std::string text = read_file("deploy/config/fusion.json", 1 << 20).value();
  const std::string plain = ConfigReader::parse(text, "shipped")->text();
  const auto shipped = read(text);
  ASSERT_TRUE(shipped);
  std::size_t live = 0;
  std::size_t waiting = 0;
  for (const auto& [key, changed] :
       testing::every_key_changed(text, [](const std::string& t) { return why(t).empty(); })) {
    if (key == "evaluation.token" || key == "outputs.mqtt.password")
      continue;  // they need evaluation.url and outputs.mqtt.user
    if (key.starts_with("site.") && changed.empty())
      continue;  // name, cell and servers go together
    ASSERT_NE(changed, "") << "no other value is accepted for " << key;
    const auto next = read(changed);
    EXPECT_NE(*next, *shipped) << key << " is read, and goes nowhere";
    live += next->live == shipped->live ? 0 : 1;
    waiting += next->at_start == shipped->at_start ? 0 : 1;
    const auto named = service::waiting_keys(
        plain, changed, [&](const auto& t) { return read(t)->at_start != shipped->at_start; });
    EXPECT_EQ(named, next->at_start == shipped->at_start ? std::vector<std::string>{}
                                                         : std::vector<std::string>{key});
  }
  EXPECT_GT(live, 40u);
  EXPECT_GT(waiting, 20u);
}

}  // namespace
}  // namespace chorus::server
