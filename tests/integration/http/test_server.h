// A small service on a free port, used by the integration tests.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "common/http/client.h"
#include "common/http/server.h"

namespace chorus::http::test {

/// Version `n` of the live document: Turtle first, then JSON-LD and JSON.
[[nodiscard]] inline DocumentPtr frame_document(int n) {
  const std::string number = std::to_string(n);
  DocumentOptions options;
  options.version = number;
  options.content_location = "frames/" + number;
  options.captured = SystemClock().now();
  return std::make_shared<const Document>(
      std::vector<Variant>{
          {"text/turtle", [number] { return "<frame> <n> " + number + " .\n"; }},
          {"application/ld+json", [number] { return "{\"n\":\"" + number + "\"}"; }},
          {"application/json", [number] { return "{\"n\":" + number + "}"; }}},
      options);
}

/// What the test server adds to its answers.
[[nodiscard]] inline AnswerPolicy test_policy() {
  return {"Test-Clock", "Link: </kind>; rel=\"type\"\r\n",
          "Link: </description>; rel=\"service-desc\"\r\n", "test"};
}

struct TestServer {
  explicit TestServer(ServerConfig config = {}) : server(with_policy(std::move(config)), routes()) {
    const auto started = server.start();
    EXPECT_TRUE(started) << to_string(started.error());
  }

  [[nodiscard]] Url url(std::string target = "/") const {
    return {"127.0.0.1", server.port(), std::move(target)};
  }

  /// Calls fetch(), which must succeed.
  [[nodiscard]] ClientResponse ask(const std::string& target, std::vector<Header> headers = {},
                                   const std::string& method = "GET",
                                   const std::string& body = {}) const {
    const auto answer = fetch(url(), {method, target, std::move(headers), body});
    EXPECT_TRUE(answer) << to_string(answer.error());
    return answer ? *answer : ClientResponse{};
  }

  std::shared_ptr<LiveDocument> frame = std::make_shared<LiveDocument>();
  std::string last_body;  ///< Body of the last POST /registration; read it only after the answer.
  Server server;

 private:
  static ServerConfig with_policy(ServerConfig config) {
    config.policy = test_policy();
    return config;
  }
  std::shared_ptr<const Router> routes() {
    auto router = std::make_shared<Router>();
    router->live("/frame", frame);
    router->get("/frames/{seq}",
                [](const Request&, const PathParams& params) -> Result<DocumentPtr> {
                  const std::string& seq = params.at("seq");
                  if (seq == "old")
                    return fail(ErrorCode::Gone, seq, "this frame has been evicted; ask /frame");
                  if (seq == "throw") throw std::runtime_error("broken getter");
                  return make_document("text/plain", seq, {seq});
                });
    router->get("/echo", [](const Request& request, const PathParams&) -> Result<DocumentPtr> {
      std::string text;
      for (const auto& [key, value] : request.query) text += key + "=" + value + ";";
      for (const auto& [key, value] : request.headers) text += key + ":" + value + ";";
      return make_document("text/plain", text, {"1"});
    });
    router->get("/health", [](const Request&, const PathParams&) -> Result<DocumentPtr> {
      return make_document("text/plain", "ok", {"1"});
    });
    router->for_everybody("/health");
    router->get("/image", [](const Request&, const PathParams&) -> Result<DocumentPtr> {
      return make_document("image/png", "x", {"1"});
    });
    router->shows_people("/image");
    router->get("/vital", [](const Request&, const PathParams&) -> Result<DocumentPtr> {
      return make_document("text/plain", "well", {"1"});
    });
    router->vital("/vital");
    router->get("/big",
                [big = std::string(8u << 20, 'x')](const Request&,
                                                   const PathParams&) -> Result<DocumentPtr> {
                  return make_document("application/octet-stream", big, {"1"});
                });
    router->action(Method::Post, "/registration",
                   [this](const Request& request, const PathParams&) -> Result<ActionResult> {
                     last_body = request.body;
                     if (request.body == "busy")
                       return fail(ErrorCode::Conflict, "session", "one is running already");
                     return ActionResult{201, frame_document(1), "/registration/1"};
                   });
    router->action(Method::Delete, "/registration",
                   [](const Request&, const PathParams&) -> Result<ActionResult> {
                     return ActionResult{204};
                   });
    return router;
  }
};

}  // namespace chorus::http::test
