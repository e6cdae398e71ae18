// Requests and reactions without a socket; tests/integration/http/server_test checks the same over
// a socket.
#include "common/http/responder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace chorus::http {
namespace {

using ::testing::HasSubstr;

class ResponderTest : public ::testing::Test {
 protected:
  ResponderTest() {
    auto router = std::make_shared<Router>();
    router->live("/frame", frame_);
    router->get("/list/", [](const Request&, const PathParams&) {
      return Result<DocumentPtr>(make_document("text/plain", "list", {"1"}));
    });
    router->get("/list/{id}", [](const Request&, const PathParams& params) {
      return Result<DocumentPtr>(make_document("application/json", params.at("id"), {"1"}));
    });
    router->get("/files/{file}", [](const Request&, const PathParams& params) {
      return Result<DocumentPtr>(make_document("text/plain", params.at("file"), {"1"}));
    });
    router->action(Method::Post, "/do", [](const Request& request, const PathParams&) {
      return Result<ActionResult>(
          ActionResult{200, make_document("text/plain", std::string(request.body), {"1"})});
    });
    responder_ = std::make_unique<Responder>(config_, router);
    publish(1);
  }
  void publish(int version) {
    frame_->publish(make_document("text/plain", "x", {std::to_string(version)}));
  }
  Reaction react(const std::string& lines) {
    bytes_ = lines + "\r\n";
    EXPECT_FALSE(read_head(bytes_, head_));
    return responder_->react(head_, {true, "127.0.0.1", 80});
  }

  ServerConfig config_;
  std::shared_ptr<LiveDocument> frame_ = std::make_shared<LiveDocument>();
  std::unique_ptr<Responder> responder_;
  std::string bytes_;
  RequestHead head_;
};

TEST_F(ResponderTest, ALongPollWaitsUntilTheTagChanges) {
  const Reaction reaction = react(
      "GET /frame HTTP/1.1\r\nHost: localhost\r\nPrefer: wait=100\r\nIf-None-Match: \"1-txt\"\r\n");
  ASSERT_EQ(reaction.kind, Reaction::Kind::Wait);
  EXPECT_EQ(reaction.wait, config_.limits.max_wait);
  EXPECT_FALSE(responder_->waited(*reaction.entry, head_));
  publish(1);
  EXPECT_FALSE(responder_->waited(*reaction.entry, head_));
  EXPECT_EQ(responder_->given_up(*reaction.entry, head_).status, 304);
  publish(2);
  const auto answer = responder_->waited(*reaction.entry, head_);
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->status, 200);
  EXPECT_EQ(answer->extra, "Preference-Applied: wait\r\n");
}

TEST_F(ResponderTest, ANameThatEndsInJsonAsksForJson) {
  frame_->publish(std::make_shared<const Document>(
      std::vector<Variant>{{"text/turtle", [] { return std::string("turtle"); }},
                           {"application/json", [] { return std::string("json"); }}},
      DocumentOptions{"1"}));
  EXPECT_EQ(react("GET /frame HTTP/1.1\r\nHost: localhost\r\n").answer.body, "turtle");
  EXPECT_EQ(react("GET /frame.json HTTP/1.1\r\nHost: localhost\r\n").answer.body, "json");
  const Reaction waiting = react(
      "GET /frame.json HTTP/1.1\r\nHost: localhost\r\nPrefer: wait=9\r\nIf-None-Match: "
      "\"1-json\"\r\n");
  ASSERT_EQ(waiting.kind, Reaction::Kind::Wait);
  publish(2);
  EXPECT_EQ(responder_->waited(*waiting.entry, head_)->status, 200);
  EXPECT_EQ(react("GET /nothing.json HTTP/1.1\r\nHost: localhost\r\n").answer.status, 404);
}

TEST_F(ResponderTest, NamesWithAnIdAndContainersMayEndInJsonTooFilesKeepTheirs) {
  EXPECT_EQ(react("GET /list/s1.json HTTP/1.1\r\nHost: localhost\r\n").answer.body, "s1");
  EXPECT_EQ(react("GET /list.json HTTP/1.1\r\nHost: localhost\r\n").answer.body, "list");
  EXPECT_EQ(react("GET /files/a.json HTTP/1.1\r\nHost: localhost\r\n").answer.body, "a.json");
  EXPECT_EQ(react("GET /list/s1 HTTP/1.1\r\nHost: localhost\r\n").answer.body, "s1");
}

TEST_F(ResponderTest, ThePathWithOrWithoutItsSlashLeadsToTheOther) {
  const Reaction slash = react("GET /frame/?at=1 HTTP/1.1\r\nHost: localhost\r\n");
  EXPECT_EQ(slash.answer.status, 308);
  EXPECT_THAT(slash.answer.extra, HasSubstr("Location: ../frame?at=1\r\n"));
  EXPECT_EQ(react("GET /list HTTP/1.1\r\nHost: localhost\r\n").answer.extra, "Location: list/\r\n");
  EXPECT_EQ(react("GET // HTTP/1.1\r\nHost: localhost\r\n").answer.status, 404);
  EXPECT_EQ(react("POST /frame/ HTTP/1.1\r\nHost: localhost\r\n").answer.status, 404);
}

TEST_F(ResponderTest, AStrangerIsLedToWhatIsForEverybodyAndNowhereElse) {
  const auto router = std::make_shared<Router>();
  const auto page = [](const Request&, const PathParams&) -> Result<DocumentPtr> {
    return make_document("text/plain", "page", {"1"});
  };
  router->get("/open/", page);
  router->for_everybody("/open/");
  router->get("/shut/", page);
  config_.tokens = {{"a reader's token", Role::Read}};
  const Responder guarded(config_, router);
  const auto status = [&](const std::string& path) {
    bytes_ = "GET " + path + " HTTP/1.1\r\nHost: localhost\r\n\r\n";
    EXPECT_FALSE(read_head(bytes_, head_));
    return guarded.react(head_, {true, "127.0.0.1", 80}).answer.status;
  };
  EXPECT_EQ(status("/open"), 308);
  EXPECT_EQ(status("/open/"), 200);
  for (const char* path : {"/shut", "/shut/", "/open/further", "/nowhere"})
    EXPECT_EQ(status(path), 401) << path;
}

TEST_F(ResponderTest, TheBodyOfTheHotPathIsTheDocumentsOwn) {
  const Reaction reaction = react("GET /frame HTTP/1.1\r\nHost: localhost\r\n");
  const auto* rendered = *frame_->current()->choose("");
  EXPECT_EQ(reaction.answer.body.data(), rendered->body().data());
  EXPECT_EQ(reaction.answer.own.data(), rendered->wire->data());
}

TEST_F(ResponderTest, AnAnswerOutlivesTheNextPublish) {
  const Reaction reaction = react("GET /frame HTTP/1.1\r\nHost: localhost\r\n");
  publish(2);
  EXPECT_EQ(reaction.answer.body, "x");
}

TEST_F(ResponderTest, ActionsAskForTheirBodyFirst) {
  const Reaction reaction = react("POST /do HTTP/1.1\r\nHost: localhost\r\nContent-Length: 2\r\n");
  ASSERT_EQ(reaction.kind, Reaction::Kind::ReadBody);
  EXPECT_EQ(responder_->act(reaction, head_, {true, "127.0.0.1", 80}, "hi").body, "hi");
}

TEST_F(ResponderTest, UnreadBodiesEndTheConnection) {
  EXPECT_TRUE(
      react("POST /frame HTTP/1.1\r\nHost: localhost\r\nContent-Length: 2\r\n").answer.close);
  EXPECT_TRUE(
      react("POST /nope HTTP/1.1\r\nHost: localhost\r\nContent-Length: 2\r\n").answer.close);
  EXPECT_FALSE(react("POST /nope HTTP/1.1\r\nHost: localhost\r\n").answer.close);
}

TEST_F(ResponderTest, OneOriginWhenConfigured) {
  config_.allowed_origin = "http://viewer.example";
  const Responder strict(config_, std::make_shared<Router>());
  EXPECT_FALSE(read_head("GET /frame HTTP/1.1\r\nHost: localhost\r\n\r\n", head_));
  EXPECT_THAT(std::string(strict.react(head_, {}).answer.route),
              HasSubstr("Access-Control-Allow-Origin: http://viewer.example\r\n"));
}

}  // namespace
}  // namespace chorus::http
