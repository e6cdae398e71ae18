// chorus status and chorus register, against a stand-in that says what a fusion server might.
#include <atomic>

#include <nlohmann/json.hpp>

#include "common/http/server.h"
#include "tests/unit/ctl/program_run.h"

namespace chorus::ctl {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using Json = nlohmann::json;

const Json kPlaces = Json::parse(R"({"verdict": "Good", "master": "s1", "reasons": [],
    "sensors": {"s1": {"x": 0, "y": 1.8, "z": 0, "qx": 0, "qy": 0, "qz": 0, "qw": 1, "error": 0,
                       "chain": ["s1"]},
                "s2": {"x": 2.5, "y": 1.75, "z": 3, "qx": 0, "qy": 1, "qz": 0, "qw": 0,
                       "error": 0.012, "chain": ["s1", "s2"]}},
    "session": {"state": "idle"}})");

const Json kSensors = Json::parse(R"({"sensors": {
    "s1": {"state": "live", "ageMilliseconds": 12.5, "rateHz": 29.97, "bodies": 1, "weight": 0.5,
           "clockOffsetMilliseconds": -0.25, "url": "http://127.0.0.1:8081/"},
    "s2": {"state": "lost", "lastError": "connection refused"}}})");

const Json kFrame = Json::parse(R"({"captured": "2026-11-21T07:30:00Z",
    "bodies": [{"bodyId": 7, "joints": {"Head": {"x": 0.1, "y": 1.6, "z": 2.5}}}]})");

/// Answers what its members say.
class StandIn : public ::testing::Test {
 protected:
  StandIn() {
    auto router = std::make_shared<http::Router>();
    router->get("/sensors/",
                [this](const http::Request&, const http::PathParams&) { return answer(sensors_); });
    router->get("/frame",
                [this](const http::Request&, const http::PathParams&) { return answer(frame_); });
    router->get("/registration", [this](const http::Request&, const http::PathParams&) {
      return answer(registration());
    });
    router->action(http::Method::Post, "/registration",
                   [this](const http::Request& request, const http::PathParams&) {
                     return started(std::string(request.body));
                   });
    router->action(http::Method::Delete, "/registration",
                   [this](const http::Request&, const http::PathParams&) {
                     ++forgotten_;
                     return Result<http::ActionResult>(http::ActionResult{204});
                   });
    server_ = std::make_unique<http::Server>(http::ServerConfig{}, router);
    EXPECT_THAT(server_->start(), chorus::testing::IsOk());
  }

  static Result<http::DocumentPtr> answer(const Json& json) {
    if (json.is_null()) return fail(ErrorCode::Unavailable, "frame", "there is none yet");
    return http::make_document("application/json", json.dump(), {});
  }

  /// A session of three looks, then what it found.
  Json registration() {
    if (looks_left_ <= 0) return found_;
    Json walking = found_;
    walking["verdict"] = "None";
    walking["session"] = {{"state", "collecting"},
                          {"elapsedSeconds", 30 - 10 * looks_left_--},
                          {"targetSeconds", 30}};
    return walking;
  }

  Result<http::ActionResult> started(const std::string& body) {
    asked_ = body;
    if (!refusal_.empty()) return fail(ErrorCode::Conflict, "/registration", refusal_);
    looks_left_ = 3;
    return http::ActionResult{202, http::make_document("application/json", "{}", {})};
  }

  [[nodiscard]] Outcome chorus(std::vector<std::string> words) const {
    words.insert(words.end(),
                 {"--url", "http://127.0.0.1:" + std::to_string(server_->port()) + "/"});
    return run_chorus(words);
  }

  Json sensors_ = kSensors;
  Json frame_ = kFrame;
  Json found_ = kPlaces;
  std::string refusal_;
  std::string asked_;
  std::atomic<int> forgotten_ = 0;
  std::atomic<int> looks_left_ = 0;
  std::unique_ptr<http::Server> server_;
};

TEST_F(StandIn, StatusShowsSensorsPlacesAndBodies) {
  const Outcome status = chorus({"status"});
  EXPECT_EQ(status.code, kExitOk) << status.error;
  for (const char* part : {"s1", "live", "12.5", "30.0", "-0.250", "http://127.0.0.1:8081/",
                           "s2: connection refused", "registration: Good, master s1", "s1 > s2",
                           "fused bodies: 1", "body 7: head at 0.100 1.600 2.500"}) {
    EXPECT_THAT(status.out, HasSubstr(part));
  }
}

TEST_F(StandIn, StatusBeforeTheFirstFrameIsAStateAndNoFailure) {
  frame_ = nullptr;
  sensors_ = Json::parse(R"({"sensors": {}})");
  found_ = Json::parse(R"({"verdict": "None"})");
  const Outcome status = chorus({"status"});
  EXPECT_EQ(status.code, kExitOk) << status.error;
  EXPECT_THAT(status.out, HasSubstr("no fused frame yet"));
  EXPECT_THAT(status.out, HasSubstr("no sensors are configured"));
  EXPECT_THAT(status.out, HasSubstr("registration: None"));
}

TEST_F(StandIn, StatusAsJsonHoldsWhatTheServerSaid) {
  const Json json = Json::parse(chorus({"status", "--json"}).out);
  EXPECT_EQ(json.at("sensors"), kSensors.at("sensors"));
  EXPECT_EQ(json.at("registration"), kPlaces);
  EXPECT_EQ(json.at("frame"), kFrame);
}

TEST_F(StandIn, StatusTakesAnswersOfAnyShape) {
  for (const char* text : {"[]", "3", R"({"sensors": 1})", R"({"sensors": {"s1": null}})",
                           R"({"bodies": [{"bodyId": "x"}, 3], "captured": 4})"}) {
    sensors_ = frame_ = found_ = Json::parse(text);
    const Outcome status = chorus({"status"});
    EXPECT_EQ(status.code, kExitOk) << text << status.error;
    EXPECT_THAT(status.out, HasSubstr("registration: None")) << text;
  }
}

TEST_F(StandIn, RegisterFollowsTheSessionToItsEnd) {
  const Outcome done = chorus({"register", "--seconds", "45"});
  EXPECT_EQ(done.code, kExitOk) << done.error;
  EXPECT_EQ(Json::parse(asked_).at("seconds"), 45.0);
  EXPECT_EQ(forgotten_, 0);
  EXPECT_THAT(done.error, HasSubstr("walk through the room: 33% None"));
  EXPECT_THAT(done.error, HasSubstr("walk through the room: 100% Good"));
  EXPECT_THAT(done.out, HasSubstr("registration: Good, master s1"));
  EXPECT_THAT(done.out, HasSubstr("180.0"));  // s2 looks back
  EXPECT_THAT(done.out, HasSubstr("12.0"));   // [mm]
}

TEST_F(StandIn, RegisterForgetsFirstWhenAskedTo) {
  EXPECT_EQ(chorus({"register", "--fresh"}).code, kExitOk);
  EXPECT_EQ(forgotten_, 1);
}

TEST_F(StandIn, RegisterFailsWithTheReasons) {
  found_["verdict"] = "Refused";
  found_["reasons"] = {"sensors s1 and s2 never saw the person together"};
  const Outcome refused = chorus({"register"});
  EXPECT_EQ(refused.code, kExitFailed);
  EXPECT_THAT(refused.out, HasSubstr("never saw the person together"));
  EXPECT_EQ(Json::parse(chorus({"register", "--json"}).out).at("verdict"), "Refused");
}

TEST_F(StandIn, RegisterTellsAWalkThatDidNotReplaceABetterOne) {
  found_["session"]["reasons"] = {"the walk was too short"};
  const Outcome worse = chorus({"register"});
  EXPECT_EQ(worse.code, kExitFailed) << "what stands is from before";
  EXPECT_THAT(worse.error, HasSubstr("this walk was not good enough:\n  the walk was too short"));
  EXPECT_THAT(worse.out, HasSubstr("registration: Good"));
}

TEST_F(StandIn, RegisterPassesOnWhyTheServerRefuses) {
  refusal_ = "a session is running already";
  const Outcome refused = chorus({"register"});
  EXPECT_EQ(refused.code, kExitFailed);
  EXPECT_THAT(refused.error, HasSubstr("a session is running already"));
  EXPECT_EQ(refused.out, "");
}

TEST(WithoutAServer, EveryCommandSaysWhereItAsked) {
  for (const std::vector<std::string>& words :
       std::vector<std::vector<std::string>>{{"status"}, {"register"}, {"register", "--fresh"}}) {
    std::vector<std::string> all = words;
    all.insert(all.end(), {"--url", "http://127.0.0.1:1/"});
    const Outcome done = run_chorus(all);
    EXPECT_EQ(done.code, kExitFailed) << words.back();
    EXPECT_THAT(done.error, HasSubstr("127.0.0.1:1"));
    EXPECT_THAT(done.error, Not(HasSubstr("terminate")));
    EXPECT_EQ(done.out, "");
  }
}

}  // namespace
}  // namespace chorus::ctl
