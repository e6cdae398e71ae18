// The inertial sources that a tracker follows, over HTTP.
#include "fusion-server/rest/inertial_resources.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/support/builders.h"
#include "tests/support/served.h"

namespace chorus::rest {
namespace {

using testing::get;
using testing::kStart;
using testing::sensor_id;

client::FollowReport suit_report() {
  client::FollowReport report;
  report.service = {sensor_id("suit"), "http://127.0.0.1:8091/"};
  report.state = client::SensorState::Live;
  report.streaming = true;
  report.newest = kStart;
  report.rate_hz = 49.75;
  report.clock = ClockEstimate{std::chrono::milliseconds(-12), std::chrono::milliseconds(1)};
  report.frames = 100;
  report.missed = 2;
  return report;
}

TEST(InertialResources, ListWhatIsFollowedAndRelayWhatItSaid) {
  InertialResources resources({"a"}, {sensor_id("suit"), sensor_id("silent")});
  http::Router router;
  resources.add_routes(router);
  resources.publish({suit_report()}, {}, kStart + std::chrono::milliseconds(40));
  const auto list = nlohmann::json::parse(get(router, "/inertial/").body);
  const auto& suit = list.at("inertialSources").at("suit");
  EXPECT_EQ(suit.at("state"), "live");
  EXPECT_EQ(suit.at("ageMilliseconds"), 40.0);
  EXPECT_EQ(suit.at("clockOffsetMilliseconds"), -12.0);
  EXPECT_EQ(suit.at("framesMissed"), 2);
  EXPECT_EQ(suit.at("orientations"), "/inertial/suit/orientations");
  EXPECT_THAT(resource::undeclared_terms(inertial_source_node(suit_report(), kStart, "suit")),
              ::testing::IsEmpty());
  auto document = std::make_shared<resource::OrientationsResource>();
  document->sequence = 5;
  document->captured = kStart;
  document->source = "suit";
  document->instants.push_back({sensor_id("suit"), 9, kStart, {}, {}});
  resources.relay(sensor_id("suit"), document);
  EXPECT_EQ(nlohmann::json::parse(get(router, "/inertial/suit/orientations").body).at("sequence"),
            5);
  EXPECT_EQ(get(router, "/inertial/silent/orientations").status, 503);
  EXPECT_EQ(get(router, "/inertial/stranger/orientations").status, 404);
}

TEST(InertialResources, TellWhoWearsASourceAndWhatIsAmiss) {
  InertialResources resources({"a"}, {sensor_id("suit")});
  http::Router router;
  resources.add_routes(router);
  WornReport worn{sensor_id("suit"), PersonId{7}, "", {}, {"IMU-3"}};
  worn.sensors.push_back({"L", inertial::Limb::ForearmLeft, true, "", 0.05, 0.0, 0.02, {}, 0.0});
  worn.sensors.push_back({"S", inertial::Limb::ShankLeft, false, "bend it", 0, 0, 0, 4.0, 1.0472});
  worn.sensors[0].silent_for = 3.0;
  worn.sensors[1].overstated = 3.4907;
  resources.publish({suit_report()}, {worn}, kStart);
  const auto list = nlohmann::json::parse(get(router, "/inertial/").body);
  const auto& suit = list.at("inertialSources").at("suit");
  EXPECT_EQ(suit.at("wearer"), 7);
  EXPECT_EQ(suit.at("knownLimbs"), nlohmann::json({"ForearmLeft"}));
  EXPECT_EQ(suit.at("reasons").size(), 5U);
  EXPECT_NE(suit.at("reasons").dump().find("left shank has turned on it by 60 degrees"),
            std::string::npos);
  EXPECT_NE(suit.at("reasons").dump().find("left forearm has said nothing for 3 s"),
            std::string::npos);
  EXPECT_NE(suit.at("reasons").dump().find("left shank states an error of 200 degrees"),
            std::string::npos);
  resource::Node node = inertial_source_node(suit_report(), kStart, "suit");
  add_worn(worn, node);
  EXPECT_THAT(resource::undeclared_terms(node), ::testing::IsEmpty());
}

}  // namespace
}  // namespace chorus::rest
