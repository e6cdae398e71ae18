#include "fusion-server/rest/setup_resources.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/rest/asked.h"

namespace chorus::rest {
namespace {

using ::testing::HasSubstr;

TEST(SensorWishes, AreOneOrSeveralAndComplete) {
  const auto one = parse_sensor_wishes(R"({"id": "s1", "url": "http://h:8081/", "token": "t"})");
  ASSERT_TRUE(one);
  EXPECT_EQ(one->front().token, "t");
  const auto two = parse_sensor_wishes(
      R"({"sensors": [{"id": "s1", "url": "http://h:1/"}, {"id": "s2", "url": "http://h:2/"}]})");
  ASSERT_TRUE(two);
  EXPECT_EQ(two->size(), 2u);
  for (const char* bad :
       {"", "[]", "{}", R"({"sensors": []})", R"({"sensors": [{"id": "s1"}]})",
        R"({"sensors": [{"url": "http://h/"}]})", R"({"sensors": [3]})",
        R"({"sensors": [{"id": "s1", "url": "ftp://h/"}]})",
        R"({"sensors": [{"id": "a b", "url": "http://h/"}]})",
        R"({"sensors": [{"id": "s1", "url": "http://h/", "tokens": "t"}]})",
        R"({"sensors": [{"id": "s", "url": "http://a/"}, {"id": "s", "url": "http://b/"}]})"})
    EXPECT_FALSE(parse_sensor_wishes(bad)) << bad;
}

TEST(Setup, SaysWhatWasFoundAndTriedAndNoToken) {
  SetupFacts facts;
  facts.file = "/state/sensors.json";
  facts.found = {{"s1", "s1.local", "10.0.0.1", 8081, false}};
  facts.trials["http://h/"] = {false, {true, "Sensor s1 is there.", "s1"}};
  facts.trials["http://i/"] = {};
  http::Router router;
  SetupControl control;
  control.facts = [&facts] { return facts; };
  add_setup_routes(router, {"run1"}, control);
  const std::string shown = body(ask(router, "/setup"), "application/json");
  EXPECT_THAT(shown, HasSubstr("http://10.0.0.1:8081/"));
  EXPECT_THAT(shown, HasSubstr("\"good\""));
  EXPECT_THAT(shown, HasSubstr("\"trying\""));
  EXPECT_THAT(shown, HasSubstr("Sensor s1 is there."));
  EXPECT_THAT(shown, HasSubstr("/state/sensors.json"));
}

}  // namespace
}  // namespace chorus::rest
