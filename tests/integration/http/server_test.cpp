// The HTTP server over a real socket: what linked data requires of GET, HEAD and OPTIONS; clock
// fields; problem documents; actions and their bodies; starting, stopping and counting.
#include "common/http/server.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/integration/http/test_server.h"

namespace chorus::http::test {
namespace {

using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

TEST(Server, AnswersOnAFreePort) {
  TestServer service;
  service.frame->publish(frame_document(42));
  const auto answer = fetch(service.url("/frame"), {});
  ASSERT_TRUE(answer) << to_string(answer.error());
  EXPECT_EQ(answer->status, 200);
  EXPECT_EQ(answer->headers.at("content-type"), "text/turtle");
  EXPECT_EQ(answer->headers.at("etag"), "\"42-ttl\"");
  EXPECT_EQ(answer->body, "<frame> <n> 42 .\n");
}

TEST(Server, NegotiatesTheRepresentation) {
  TestServer service;
  service.frame->publish(frame_document(1));
  const auto json = service.ask("/frame", {{"Accept", "application/json"}});
  EXPECT_EQ(json.headers.at("content-type"), "application/json");
  EXPECT_EQ(json.headers.at("vary"), "Accept, Accept-Encoding, Origin");
  const auto several = service.ask(
      "/frame", {{"Accept", "image/png"}, {"Accept", "application/ld+json, text/turtle;q=0.9"}});
  EXPECT_EQ(several.headers.at("content-type"), "application/ld+json");
}

TEST(Server, NotAcceptableListsWhatThereIs) {
  TestServer service;
  service.frame->publish(frame_document(1));
  const auto answer = service.ask("/frame", {{"Accept", "image/png"}});
  EXPECT_EQ(answer.status, 406);
  EXPECT_EQ(answer.headers.at("content-type"), "application/problem+json");
  const auto problem = nlohmann::json::parse(answer.body);
  EXPECT_EQ(problem["available"][0], "text/turtle");
  EXPECT_THAT(problem["detail"], HasSubstr("application/json"));
}

TEST(Server, ConditionalGetIsNotModified) {
  TestServer service;
  service.frame->publish(frame_document(7));
  for (const auto tags : {"\"7-ttl\"", "W/\"7-ttl\"", "\"a,b\", \"7-ttl\"", "*"}) {
    const auto answer = service.ask("/frame", {{"If-None-Match", tags}});
    EXPECT_EQ(answer.status, 304) << tags;
    EXPECT_EQ(answer.body, "");
    for (const auto name :
         {"etag", "cache-control", "content-location", "vary", "link", "date", "test-clock"})
      EXPECT_TRUE(answer.headers.contains(name)) << name;
  }
  EXPECT_EQ(service.ask("/frame", {{"If-None-Match", "\"7-json\""}}).status, 200);
  EXPECT_EQ(service.server.counters().not_modified, 4u);
}

TEST(Server, EveryAnswerCarriesItsClock) {
  TestServer service;
  service.frame->publish(frame_document(7));
  const auto answer = service.ask("/frame");
  long long receipt = 0;
  long long sending = 0;
  ASSERT_EQ(std::sscanf(answer.headers.at("test-clock").c_str(), "%lld %lld", &receipt, &sending),
            2);
  EXPECT_LE(answer.sent_ns, receipt);
  EXPECT_LE(receipt, sending);
  EXPECT_LE(sending, answer.received_ns);
  EXPECT_THAT(answer.headers.at("server-timing"), StartsWith("age;dur="));
}

TEST(Server, StampsTheClockItWasGiven) {
  ServerConfig config;
  config.clock = std::make_shared<FakeClock>(from_unix_ns(1'700'000'000'000'000'000));
  TestServer service(config);
  const auto answer = service.ask("/frames/1");
  EXPECT_EQ(answer.headers.at("test-clock"), "1700000000000000000 1700000000000000000");
  EXPECT_EQ(answer.headers.at("date"), "Tue, 14 Nov 2023 22:13:20 GMT");
}

TEST(Server, HeadHasTheHeadersOfGetAndNoBody) {
  TestServer service;
  service.frame->publish(frame_document(7));
  auto get = service.ask("/frame");
  auto head = service.ask("/frame", {}, "HEAD");
  EXPECT_EQ(head.body, "");
  for (const auto changing : {"test-clock", "date", "server-timing"}) {
    EXPECT_EQ(get.headers.erase(changing), 1u);
    EXPECT_EQ(head.headers.erase(changing), 1u);
  }
  EXPECT_EQ(head.headers, get.headers);
}

TEST(Server, OptionsAnswersPreflights) {
  ServerConfig config;
  config.allowed_origin = "*";
  TestServer service(config);
  const auto answer = service.ask("/frame",
                                  {{"Origin", "http://viewer.example"},
                                   {"Access-Control-Request-Method", "GET"},
                                   {"Access-Control-Request-Headers", "prefer"}},
                                  "OPTIONS");
  EXPECT_EQ(answer.status, 204);
  EXPECT_EQ(answer.headers.at("allow"), "GET, HEAD, OPTIONS");
  EXPECT_EQ(answer.headers.at("access-control-allow-origin"), "*");
  EXPECT_EQ(answer.headers.at("access-control-allow-methods"), "GET, HEAD, OPTIONS");
  EXPECT_THAT(answer.headers.at("access-control-allow-headers"), HasSubstr("Prefer"));
  EXPECT_EQ(service.ask("*", {}, "OPTIONS").status, 204);
}

TEST(Server, SaysWhatItsOwnerWantsSaid) {
  ServerConfig config;
  config.allowed_origin = "*";
  TestServer service(config);
  service.frame->publish(frame_document(7));
  const auto answer = service.ask("/frame");
  EXPECT_THAT(answer.headers.at("link"), HasSubstr("</kind>; rel=\"type\""));
  EXPECT_THAT(answer.headers.at("link"), HasSubstr("</description>; rel=\"service-desc\""));
  EXPECT_EQ(answer.headers.at("allow"), "GET, HEAD, OPTIONS");
  EXPECT_FALSE(answer.headers.contains("accept-patch"));
  EXPECT_THAT(answer.headers.at("access-control-expose-headers"), HasSubstr("Test-Clock"));
  const auto lost = service.ask("/nowhere");
  EXPECT_THAT(lost.headers.at("link"), HasSubstr("service-desc"));
  EXPECT_THAT(lost.headers.at("link"), Not(HasSubstr("</kind>")));
}

TEST(Server, ProblemsNameWhatToChange) {
  TestServer service;
  struct Case {
    std::string target;
    std::string method;
    int status;
    std::string detail;
  };
  const std::vector<Case> cases{
      {"/nope", "GET", 404, "no such resource"},
      {"/frames/old", "GET", 410, "evicted"},
      {"/frames/throw", "GET", 500, "broken getter"},
      {"/frame", "GET", 503, "nothing to show yet"},
      {"/frame", "DELETE", 405, "GET, HEAD, OPTIONS"},
      {"/registration", "GET", 405, "POST, DELETE"},
      {"/a/%2e%2e/b", "GET", 400, "segments"},
      {"/frames/%00", "GET", 400, "escape"},
      {"/echo?a=%zz", "GET", 400, "escape"},
      {"/frames/1?profile=nirvana", "GET", 404, "nirvana"},
      {"/frame", "BREW", 501, "those that are: GET"},
  };
  for (const Case& c : cases) {
    const auto answer = service.ask(c.target, {}, c.method);
    EXPECT_EQ(answer.status, c.status) << c.target;
    EXPECT_EQ(answer.headers.at("content-type"), "application/problem+json");
    const auto problem = nlohmann::json::parse(answer.body);
    EXPECT_EQ(problem["status"], c.status);
    EXPECT_THAT(problem["detail"], HasSubstr(c.detail)) << c.target;
  }
  EXPECT_EQ(service.ask("/frame").headers.at("retry-after"), "1");
  EXPECT_EQ(service.ask("/frame", {}, "PUT").headers.at("allow"), "GET, HEAD, OPTIONS");
}

TEST(Server, GettersSeeQueryAndHeaders) {
  TestServer service;
  const auto answer = service.ask("/echo?b=2&a=%20", {{"X-Thing", "one"}, {"x-thing", "two"}});
  EXPECT_THAT(answer.body, StartsWith("a= ;b=2;"));
  EXPECT_THAT(answer.body, HasSubstr("x-thing:one, two;"));
}

TEST(Server, ActionsFromThisHostNeedNoToken) {
  TestServer service;
  const auto made = service.ask("/registration", {}, "POST", "{\"go\":1}");
  EXPECT_EQ(made.status, 201);
  EXPECT_EQ(made.headers.at("location"), "/registration/1");
  EXPECT_EQ(made.body, "<frame> <n> 1 .\n");
  EXPECT_EQ(service.last_body, "{\"go\":1}");
  EXPECT_EQ(service.ask("/registration", {}, "DELETE").status, 204);
  EXPECT_EQ(service.ask("/registration", {}, "POST", "busy").status, 409);
  EXPECT_EQ(service.ask("/registration", {{"Expect", "100-continue"}}, "POST", "x").status, 201);
  EXPECT_EQ(service.ask("/registration", {{"Accept", "image/png"}}, "POST", "x").status, 201);
}

TEST(Server, ActionsOfForeignPagesNeedTheToken) {
  ServerConfig config;
  config.bearer_token = "open sesame";
  TestServer service(config);
  const Header page{"Origin", "http://evil.example"};
  const auto status = [&](std::vector<Header> headers) {
    return service.ask("/registration", std::move(headers), "POST", "x").status;
  };
  EXPECT_EQ(status({page}), 401);
  EXPECT_EQ(status({page, {"Authorization", "Bearer open sesam"}}), 401);
  EXPECT_EQ(status({page, {"Authorization", "Basic open sesame"}}), 401);
  EXPECT_EQ(status({page, {"Authorization", "bearer open sesame"}}), 201);
  EXPECT_EQ(status({{"X-Forwarded-For", "10.0.0.1"}}), 401);
  const std::string own = "http://127.0.0.1:" + std::to_string(service.server.port());
  EXPECT_EQ(status({{"Origin", own}}), 401) << "from this host, but there is a token";
  EXPECT_TRUE(
      service.ask("/registration", {page}, "POST", "x").headers.contains("www-authenticate"));

  service.server.set_tokens({{"another", Role::Control}});
  EXPECT_EQ(status({page, {"Authorization", "Bearer open sesame"}}), 401);
  EXPECT_EQ(status({page, {"Authorization", "Bearer another"}}), 201);

  TestServer without_token;
  const std::string its_own = "http://127.0.0.1:" + std::to_string(without_token.server.port());
  EXPECT_EQ(without_token.ask("/registration", {{"Origin", its_own}}, "POST", "x").status, 201);
  EXPECT_EQ(without_token.ask("/registration", {page}, "POST", "x").status, 403);
}

TEST(Server, BodiesAboveTheLimitAreRefusedUnread) {
  ServerConfig config;
  config.limits.max_body_bytes = 1000;
  TestServer service(config);
  EXPECT_EQ(service.ask("/registration", {}, "POST", std::string(1000, 'a')).status, 201);
  EXPECT_EQ(service.ask("/registration", {}, "POST", std::string(300000, 'a')).status, 413);
}

TEST(Server, BodiesMayBeLargerThanTheHeadBuffer) {
  TestServer service;
  const std::string body(60000, 'b');
  EXPECT_EQ(service.ask("/registration", {}, "POST", body).status, 201);
  EXPECT_EQ(service.last_body, body);
}

TEST(Server, BindErrorsNameTheAddress) {
  TestServer first;
  ServerConfig config;
  config.port = first.server.port();
  Server second(config, std::make_shared<Router>());
  const auto started = second.start();
  ASSERT_FALSE(started);
  EXPECT_EQ(started.error().code, ErrorCode::Io);
  EXPECT_THAT(to_string(started.error()), HasSubstr(std::to_string(config.port)));
  config.address = "my.host";
  EXPECT_EQ(Server(config, std::make_shared<Router>()).start().error().code,
            ErrorCode::InvalidArgument);
}

TEST(Server, StopsTwiceAndWithoutStart) {
  Server never(ServerConfig{}, std::make_shared<Router>());
  never.stop();
  TestServer service;
  service.server.stop();
  service.server.stop();
  EXPECT_FALSE(fetch(service.url(), {}));
  service.frame->publish(frame_document(1));
}

TEST(Server, CountsWhatItDoes) {
  TestServer service;
  (void)service.ask("/frames/1");
  (void)service.ask("/nope");
  const auto counters = service.server.counters();
  EXPECT_EQ(counters.requests, 2u);
  EXPECT_EQ(counters.connections_total, 2u);
  EXPECT_GT(counters.bytes_sent, 100u);
}

}  // namespace
}  // namespace chorus::http::test
