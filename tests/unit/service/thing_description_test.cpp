#include "common/service/thing_description.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "common/http/route_table.h"
#include "common/service/common_resources.h"

namespace chorus::service {
namespace {

using nlohmann::json;

/// A service with a live frame, bodies, images, a registration and what every service has.
class ThingTest : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto nothing = [](const http::Request&, const http::PathParams&) {
      return Result<http::DocumentPtr>(nullptr);
    };
    const auto action = [](const http::Request&, const http::PathParams&) {
      return Result<http::ActionResult>(http::ActionResult{});
    };
    router_.live("/frame", std::make_shared<http::LiveDocument>());
    router_.get("/skeletons/{body}", nothing);
    router_.get("/images/color", nothing);
    router_.shows_people("/images/color");
    router_.get("/registration", nothing);
    router_.action(http::Method::Post, "/registration", action);
    router_.action(http::Method::Delete, "/registration", action);
    add_routes(router_, {nullptr, {}, {}, [this] { return self_; }});
  }
  [[nodiscard]] json thing(const ThingFacts& facts) const {
    return json::parse(thing_description(self_, router_, facts));
  }
  [[nodiscard]] static json first_form(const json& affordance) {
    return affordance.at("forms").at(0);
  }

  Self self_{"Hall 3",
             "A \"tracker\".",
             "Tracker",
             {},
             {{"frame", "frame", "the frame"},
              {"images/color", "", "a picture"},
              {"registration", "registration", "where sensors stand"}}};
  http::Router router_;
};

TEST_F(ThingTest, HasTheResourcesAsPropertiesActionsAndEvents) {
  const json td = thing({"http://127.0.0.1:8080/", false, false});
  EXPECT_EQ(td["@context"][0], "https://www.w3.org/2022/wot/td/v1.1");
  EXPECT_EQ(td["title"], "Hall 3");
  EXPECT_EQ(td["base"], "http://127.0.0.1:8080/");
  EXPECT_EQ(td["security"], json::array({"nosec"}));
  const json& frame = td["properties"]["frame"];
  std::vector<std::string> types;
  for (const json& form : frame["forms"]) types.push_back(form["contentType"]);
  EXPECT_THAT(types, ::testing::UnorderedElementsAre("text/turtle", "application/ld+json",
                                                     "application/json", "application/n-triples"));
  EXPECT_EQ(first_form(frame)["href"], "frame");
  EXPECT_EQ(first_form(td["events"]["frame"])["subprotocol"], "sse");
  EXPECT_FALSE(td["events"].contains("registration")) << "here it is not live";
  EXPECT_EQ(first_form(td["actions"]["startRegistration"])["htv:methodName"], "POST");
  EXPECT_TRUE(td["actions"]["startRegistration"]["input"]["properties"].contains("seconds"));
  EXPECT_EQ(first_form(td["actions"]["forgetRegistration"])["htv:methodName"], "DELETE");
  EXPECT_TRUE(td["properties"]["skeleton"]["uriVariables"].contains("id"));
  EXPECT_TRUE(td["properties"].contains("clock"));
}

TEST_F(ThingTest, SaysNothingOfWhatTheServiceDoesNotHave) {
  self_.resources.pop_back();
  self_.resources.pop_back();  // the configuration does not allow images
  const json td = thing({});
  for (const char* absent : {"colorImage", "registration", "sensors", "thing", "openApi"})
    EXPECT_FALSE(td["properties"].contains(absent)) << absent;
  EXPECT_FALSE(td["actions"].contains("startRecording"));
  EXPECT_FALSE(td.contains("base"));
  EXPECT_EQ(first_form(td["properties"]["frame"])["href"], "../frame");
}

TEST_F(ThingTest, NamesTheRoleThatAFormNeeds) {
  const auto needs = [](const json& td, const json& affordance) {
    return first_form(affordance).value("security", td["security"]);
  };
  const json open = thing({"", true, true});
  EXPECT_EQ(open["securityDefinitions"]["read"]["scheme"], "bearer");
  EXPECT_EQ(needs(open, open["properties"]["frame"]), json::array({"read"}));
  EXPECT_EQ(needs(open, open["properties"]["colorImage"]), json::array({"images"}));
  EXPECT_EQ(needs(open, open["properties"]["health"]), json::array({"nosec"}));
  EXPECT_EQ(needs(open, open["events"]["frame"]), json::array({"read"}));
  EXPECT_EQ(needs(open, open["actions"]["startRegistration"]), json::array({"control"}));
  const json own_host = thing({"", false, true});
  EXPECT_EQ(needs(own_host, own_host["properties"]["colorImage"]), json::array({"nosec"}));
  EXPECT_EQ(needs(own_host, own_host["actions"]["startRegistration"]), json::array({"control"}));
}

TEST_F(ThingTest, IsServedAsTdWithTheAddressThatWasAsked) {
  const auto match = router_.match("/.well-known/wot");
  ASSERT_TRUE(match);
  http::Request request;
  request.root = "https://tracker.local:8443/";
  const auto document = match->entry->getter(request, {});
  ASSERT_TRUE(document);
  const auto chosen = (*document)->choose("");
  EXPECT_EQ((*chosen)->media_type, "application/td+json");
  EXPECT_EQ(json::parse((*chosen)->body())["base"], "https://tracker.local:8443/");
}

}  // namespace
}  // namespace chorus::service
