#include "common/service/common_resources.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "common/http/route_table.h"
#include "proto/embedded.h"

namespace chorus::service {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

class EndpointTest : public ::testing::Test {
 protected:
  void SetUp() override {
    add_routes(router_,
               {clock_, [this] { return health_; }, [] { return std::string("up 1\n"); }, {}});
  }
  Result<http::DocumentPtr> get(std::string_view path) const {
    const auto match = router_.match(path);
    if (!match) return pass(match);
    return match->entry->getter(http::Request{}, {});
  }
  std::string body(std::string_view path, std::string_view accept = "") const {
    const auto document = get(path);
    if (!document) return to_string(document.error());
    const auto chosen = (*document)->choose(accept);
    return chosen ? std::string((*chosen)->body()) : to_string(chosen.error());
  }
  std::string media_type(std::string_view path, std::string_view accept = "") const {
    return (*(*get(path))->choose(accept))->media_type;
  }

  std::shared_ptr<FakeClock> clock_ =
      std::make_shared<FakeClock>(from_unix_ns(1'700'000'000'123'456'789));
  Health health_;
  http::Router router_;
};

TEST_F(EndpointTest, ClockTellsItsTimeAndWhatTheKernelKnows) {
  const auto json = nlohmann::json::parse(body("/clock", "application/json"));
  EXPECT_EQ(json["@type"], "Clock");
  EXPECT_EQ(json["now"], "2023-11-14T22:13:20.123456789Z");
  EXPECT_EQ(json["nowNanoseconds"], "1700000000123456789");
  EXPECT_TRUE(json["synchronised"].is_boolean());
  for (const auto key :
       {"offsetNanoseconds", "maxErrorNanoseconds", "estimatedErrorNanoseconds", "frequencyPpm"})
    EXPECT_TRUE(json.contains(key)) << key;
  EXPECT_EQ(media_type("/clock"), "text/turtle");
}

TEST_F(EndpointTest, TheThingIsDescribedOnceForEachAddress) {
  Self self{"one", "A thing.", "Sensor", {}, {}};
  http::Router router;
  add_routes(router, {clock_, {}, {}, [&] { return self; }});
  const auto described = [&](const std::string& root) {
    http::Request request;
    request.root = root;
    const auto match = router.match("/.well-known/wot");
    return *match->entry->getter(request, {});
  };
  const auto first = described("http://10.0.0.1/");
  EXPECT_EQ(described("http://10.0.0.1/"), first);
  const auto other = described("http://10.0.0.2/");
  EXPECT_NE(other, first);
  EXPECT_THAT((*other->choose(""))->body(), HasSubstr("http://10.0.0.2/"));
  for (int i = 0; i < 20; ++i) (void)described("http://10.0.1." + std::to_string(i) + "/");
  EXPECT_NE(described("http://10.0.0.1/"), first) << "only the last few are kept";
  const auto before = described("http://10.0.0.1/");
  self.title = "another";
  EXPECT_NE(described("http://10.0.0.1/"), before);
}

TEST_F(EndpointTest, ClockIsNeverCached) {
  const auto before = *get("/clock");
  clock_->advance(std::chrono::seconds(1));
  EXPECT_NE((*before->choose(""))->etag, (*(*get("/clock"))->choose(""))->etag);
  EXPECT_EQ(before->options().cache_control, "no-store");
}

TEST_F(EndpointTest, HealthIsOkOrUnavailableWithTheReason) {
  EXPECT_EQ(body("/healthz"), "{\"status\":\"ok\"}\n");
  EXPECT_EQ(body("/healthz", "text/plain"), "ok\n");
  health_ = {false, "no sensor answers"};
  const auto ill = get("/healthz");
  ASSERT_FALSE(ill);
  EXPECT_EQ(ill.error().code, ErrorCode::Unavailable);
  EXPECT_THAT(ill.error().message, HasSubstr("no sensor answers"));
}

TEST_F(EndpointTest, MetricsArePrometheusText) {
  EXPECT_THAT(body("/metrics"), StartsWith("up 1\n"));
  EXPECT_THAT(body("/metrics"), HasSubstr("\nchorus_log_dropped_lines_total 0\n"));
  EXPECT_THAT(std::string((*(*get("/metrics"))->choose("text/plain;version=0.0.4"))->head()),
              HasSubstr("Content-Type: text/plain; version=0.0.4; charset=utf-8\r\n"));
}

TEST_F(EndpointTest, ServesTheContractAsItWasCompiledIn) {
  EXPECT_EQ(body("/ns"), proto::vocabulary());
  EXPECT_EQ(body("/shapes"), proto::shapes());
  EXPECT_EQ(body("/context.jsonld"), proto::context());
  EXPECT_EQ(body("/openapi.json"), proto::openapi_json());
  EXPECT_EQ(media_type("/ns"), "text/turtle");
  EXPECT_EQ(media_type("/shapes"), "text/turtle");
  EXPECT_EQ(media_type("/context.jsonld"), "application/ld+json");
  EXPECT_EQ(media_type("/context.jsonld", "application/json"), "application/json");
  EXPECT_EQ(media_type("/openapi.json"), "application/json");
  EXPECT_TRUE(nlohmann::json::accept(body("/context.jsonld")));
}

TEST_F(EndpointTest, VoidPointsToTheDataBesideItself) {
  const std::string turtle = body("/.well-known/void");
  EXPECT_THAT(turtle, HasSubstr("Dataset"));
  EXPECT_THAT(turtle, HasSubstr("<../frame>"));
  EXPECT_THAT(turtle, HasSubstr("https://w3id.org/chorus-tracking/ns#"));
}

TEST(Endpoint, ClockHealthAndMetricsAreOptional) {
  http::Router router;
  add_routes(router, {});
  EXPECT_TRUE(router.match("/clock")->entry->getter({}, {}));
  EXPECT_TRUE(router.match("/healthz")->entry->getter({}, {}));
  EXPECT_FALSE(router.match("/metrics"));
}

}  // namespace
}  // namespace chorus::service
