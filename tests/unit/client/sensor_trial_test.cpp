#include "common/client/sensor_trial.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "common/http/router.h"
#include "common/http/server.h"

namespace chorus::client {
namespace {

using ::testing::HasSubstr;

/// A service that describes itself like this, and sees nobody.
struct Stranger {
  explicit Stranger(const nlohmann::json& self) {
    const auto serve = [this](const char* path, const std::string& text) {
      http::DocumentOptions options;
      options.version = "1.run7";
      const auto document = std::make_shared<const http::Document>(
          std::vector<http::Variant>{{"application/json", [text] { return text; }}}, options);
      router->get(path, [document](const http::Request&, const http::PathParams&) {
        return Result<http::DocumentPtr>(document);
      });
    };
    serve("/", self.dump());
    serve("/frame", R"({"bodies": []})");
    server = std::make_unique<http::Server>(http::ServerConfig{}, router);
    EXPECT_TRUE(server->start());
  }
  [[nodiscard]] SensorTrial tried(const std::string& own_run = {}) {
    return try_sensor("http://127.0.0.1:" + std::to_string(server->port()) + "/", "", {}, own_run);
  }

  std::shared_ptr<http::Router> router = std::make_shared<http::Router>();
  std::unique_ptr<http::Server> server;  ///< Knows the routes that there were when it was made.
};

TEST(SensorTrial, KeepsTheBeginningOfATitleAndAValidId) {
  Stranger sensor({{"frame", "frame"}, {"title", "Sensor s1"}, {"sensorId", "s1"}});
  const SensorTrial good = sensor.tried();
  EXPECT_TRUE(good.good);
  EXPECT_EQ(good.words, "Sensor s1 is there and sees nobody now.");
  EXPECT_EQ(good.sensor_id, "s1");
  Stranger talker({{"frame", "frame"},
                   {"title", std::string(100'000, 'x')},
                   {"sensorId", std::string(100'000, 'y')}});
  const SensorTrial cut = talker.tried();
  EXPECT_TRUE(cut.good);
  EXPECT_EQ(cut.words, std::string(80, 'x') + "... is there and sees nobody now.");
  EXPECT_EQ(cut.sensor_id, "");
}

TEST(SensorTrial, NoticesItsOwnServer) {
  Stranger own({{"frame", "frame"}, {"title", "Tracker"}});
  EXPECT_TRUE(own.tried("run8").good);
  const SensorTrial trial = own.tried("run7");
  EXPECT_FALSE(trial.good);
  EXPECT_THAT(trial.words, HasSubstr("this server itself"));
}

}  // namespace
}  // namespace chorus::client
