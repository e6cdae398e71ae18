// The routes of the fusion server, called without a socket.
#include <gtest/gtest.h>

#include "common/base/log.h"
#include "common/base/units.h"
#include "fusion-server/core/awaited.h"
#include "fusion-server/rest/frame_sink.h"
#include "fusion-server/rest/metrics.h"
#include "fusion-server/rest/registration_resources.h"
#include "fusion-server/rest/sensor_resources.h"
#include "fusion-server/rest/tracker_description.h"
#include "tests/unit/rest/asked.h"

namespace chorus::rest {
namespace {

using testing::kStart;
using testing::sensor_id;

SensorStatus status(const char* name) {
  SensorStatus s;
  s.id = sensor_id(name);
  s.url = "http://127.0.0.1:8081/";
  s.state = "live";
  s.last_error = "once it did not answer";
  s.age = std::chrono::milliseconds(12);
  s.clock_offset = std::chrono::microseconds(150);
  s.clock_uncertainty = std::chrono::microseconds(90);
  s.clock_corrected = true;
  s.share = 0.75;
  return s;
}

TEST(SensorResources, ListsEverySensorAndRelaysItsFrame) {
  http::Router router;
  SensorResources sensors({"run1"}, {sensor_id("s1")});
  sensors.add_routes(router);
  sensors.publish({status("s1"), status("s2")});
  EXPECT_EQ(resource::undeclared_terms(sensor_node(status("s1"), "s1")),
            std::vector<std::string>{});
  const auto list = body(ask(router, "/sensors/"), "application/json");
  EXPECT_NE(list.find("\"s2\""), std::string::npos);
  EXPECT_NE(list.find("\"clockOffsetMilliseconds\": 0.15"), std::string::npos);
  EXPECT_NE(list.find("\"share\": 0.75"), std::string::npos) << list;
  EXPECT_TRUE(ask(router, "/sensors/s2"));
  EXPECT_EQ(ask(router, "/sensors/s3").error().code, ErrorCode::NotFound);

  const auto raw = std::make_shared<const resource::FrameResource>(
      resource::to_resource(testing::sensor_frame("s2", kStart, {})));
  EXPECT_EQ(ask(router, "/sensors/s2/frame").error().code, ErrorCode::NotFound);
  sensors.relay(sensor_id("s1"), raw);
  // A sensor added after the start has no long poll, but its frame is served.
  sensors.relay(sensor_id("s2"), raw);
  EXPECT_NE(body(ask(router, "/sensors/s1/frame"), "text/turtle").find("SensorSpace"),
            std::string::npos);
  EXPECT_TRUE(ask(router, "/sensors/s2/frame"));
}

TEST(SensorResources, TellsOfTheClockByWhomAndWhatBecameOfUntimelyFrames) {
  SensorStatus s = status("s1");
  s.walked_offset = std::chrono::milliseconds(200);
  s.walked_sigma = std::chrono::milliseconds(4);
  s.host = NtpStatus{};
  s.fates = {1, 2, 3, 4, 5, 6};
  EXPECT_EQ(resource::undeclared_terms(sensor_node(s, "s1")), std::vector<std::string>{});
  http::Router router;
  SensorResources sensors({"run1"}, {});
  sensors.add_routes(router);
  sensors.publish({s});
  const auto text = body(ask(router, "/sensors/s1"), "application/json");
  for (const char* part :
       {"\"clockOffsetMilliseconds\": 200.15", "\"clockFromWalkMilliseconds\": 200",
        "\"clockUncertaintyWithoutWalkMilliseconds\": 0.09", "\"clockUncertaintyMilliseconds\": 8",
        "\"hostSynchronised\": false", "\"framesLate\": 1", "\"framesDoubled\": 2",
        "\"framesEarly\": 3", "\"framesBackwards\": 4", "\"framesStale\": 5",
        "\"clockRestarts\": 6"})
    EXPECT_NE(text.find(part), std::string::npos) << part << "\n" << text;
  EXPECT_EQ(text.find("latency"), std::string::npos) << "no walk told it";
  s.latency = Latency{std::chrono::milliseconds(42), std::chrono::milliseconds(2), true};
  sensors.publish({s});
  const auto late = body(ask(router, "/sensors/s1"), "application/json");
  for (const char* part : {"\"latencyMilliseconds\": 42", "\"latencyUncertaintyMilliseconds\": 2",
                           "\"latencyCorrected\": true"})
    EXPECT_NE(late.find(part), std::string::npos) << part << "\n" << late;
  s.guessed_from_age = true;
  EXPECT_EQ(resource::undeclared_terms(sensor_node(s, "s1")), std::vector<std::string>{});
  sensors.publish({s});
  const auto alone = body(ask(router, "/sensors/s1"), "application/json");
  for (const char* part :
       {"\"clockOffsetMilliseconds\": 200.15", "\"clockFromAgeMilliseconds\": 200",
        "\"clockUncertaintyMilliseconds\": 100"})
    EXPECT_NE(alone.find(part), std::string::npos) << part << "\n" << alone;
  EXPECT_EQ(alone.find("clockFromWalk"), std::string::npos) << "no walk told it";
  sensors.publish({status("s1")});
  const auto calm = body(ask(router, "/sensors/s1"), "application/json");
  EXPECT_EQ(calm.find("framesLate"), std::string::npos);
  EXPECT_EQ(calm.find("clockFromWalk"), std::string::npos);
}

TEST(SelfDescription, LeadsToEverythingAndUsesOnlyDeclaredTerms) {
  EXPECT_EQ(resource::undeclared_terms(service::self_node(self_of("x", true, true))),
            std::vector<std::string>{});
  const auto page = service::self_page(self_of("<script>", true));
  EXPECT_EQ(page.find("<script>"), std::string::npos);
  for (const char* path : {"viewer/", "frame", "sensors/", "registration", "recordings/", "ns"}) {
    EXPECT_NE(page.find("<a href=\"" + std::string(path) + "\">"), std::string::npos) << path;
  }
  EXPECT_EQ(service::self_page(self_of("x", false)).find("viewer/"), std::string::npos);
}

TEST(SelfDescription, BrowsersGetThePageOthersTurtle) {
  http::Router router;
  add_description_routes(router, {"run1"}, self_of("Hall 3", false), "");
  EXPECT_NE(body(ask(router, "/"), "text/html,application/xhtml+xml,*/*;q=0.8").find("<h1>Hall 3"),
            std::string::npos);
  EXPECT_NE(body(ask(router, "/"), "").find("dcterms:title \"Hall 3\""), std::string::npos);
  EXPECT_NE(body(ask(router, "/floor-plane"), "application/json").find("\"normalY\": 1"),
            std::string::npos);
}

TEST(SessionRequest, IsSecondsAndWhenToAdoptOrNothing) {
  const SessionRequest fallback{std::chrono::seconds(30), Adoption::WhenAccepted};
  for (const char* nothing : {"", " {} "}) {
    EXPECT_EQ(parse_session_request(nothing, fallback)->target, fallback.target);
    EXPECT_EQ(parse_session_request(nothing, fallback)->adoption, Adoption::WhenAccepted);
  }
  const auto both = parse_session_request(R"({"seconds": 12.5, "adopt": "at-once"})", fallback);
  EXPECT_EQ(both->target, from_seconds(12.5));
  EXPECT_EQ(both->adoption, Adoption::AtOnce);
  for (const char* wrong :
       {"nonsense", "[]", "7", R"({"seconds": "30"})", R"({"seconds": 1})", R"({"seconds": 1e9})",
        R"({"second": 30})", R"({"seconds": null})", R"({"seconds": 30, "seconds": 40})",
        R"({"adopt": 1})", R"({"seconds": [[[[[30]]]]]})"}) {
    const auto read = parse_session_request(wrong, fallback);
    ASSERT_FALSE(read) << wrong;
    EXPECT_EQ(read.error().code, ErrorCode::InvalidArgument);
  }
}

/// A registrar that carries out requests when the test allows it.
class Registering : public ::testing::Test {
 protected:
  Registering() : resources_({"run1"}, control()) {
    resources_.add_routes(router_);
    progress_.next_session = 41;
  }
  RegistrationControl control() {
    RegistrationControl c;
    c.start = [this](const SessionRequest& request, std::uint64_t session, std::uint64_t ticket) {
      asked_ += "start " + std::to_string(session) + " for " +
                log::number_text(seconds(request.target)) +
                (request.adoption == Adoption::AtOnce ? "" : " to propose") + " #" +
                std::to_string(ticket) + "; ";
    };
    c.decide = [this](bool accept, std::uint64_t ticket) {
      asked_ += (accept ? "accept #" : "decline #") + std::to_string(ticket) + "; ";
    };
    c.cancel = [this](std::uint64_t session, std::uint64_t ticket) {
      asked_ += "cancel " + std::to_string(session) + " #" + std::to_string(ticket) + "; ";
    };
    c.forget = [this](std::uint64_t ticket) {
      asked_ += "forget #" + std::to_string(ticket) + "; ";
    };
    c.move_origin = [this](const core::Origin& origin, std::uint64_t ticket) {
      asked_ += "origin " + log::number_text(origin.x) + " " + log::number_text(origin.z) + " " +
                log::number_text(to_deg(origin.yaw)) + " #" + std::to_string(ticket) + "; ";
    };
    return c;
  }
  void publish() { resources_.publish(registration_, progress_); }
  Result<http::ActionResult> act(http::Method method, const std::string& path,
                                 std::string_view text = "") {
    const auto match = router_.match(path);
    http::Request request;
    request.body = text;
    return match->entry->actions.at(method)(request, match->params);
  }
  std::string shown(const std::string& path = "/registration") {
    return body(ask(router_, path), "application/json");
  }
  SessionStatus& add_session(std::uint64_t id, SessionState state, bool automatic = false) {
    SessionStatus session;
    session.id = id;
    session.state = state;
    session.automatic = automatic;
    progress_.sessions.insert(progress_.sessions.begin(), session);
    progress_.next_session = id + 1;
    return progress_.sessions.front();
  }

  std::string asked_;
  http::Router router_;
  RegistrationResources resources_;
  Registration registration_;
  RegistrationProgress progress_;
};

TEST_F(Registering, TheAnswerNamesASessionThatEverybodyCanReadAtOnce) {
  add_session(40, SessionState::Done).verdict = Verdict::Good;
  publish();
  const auto started = act(http::Method::Post, "/registration", R"({"seconds": 20})");
  ASSERT_TRUE(started);
  EXPECT_EQ(started->status, 202);
  EXPECT_EQ(started->location, "/registration/sessions/41");
  EXPECT_EQ(asked_, "start 41 for 20 #1; ");
  for (int i = 0; i < 2; ++i) {
    EXPECT_NE(shown().find("\"state\": \"collecting\""), std::string::npos) << shown();
    EXPECT_NE(shown().find("\"sessionId\": 41"), std::string::npos);
    const std::string session = shown("/registration/sessions/41");
    EXPECT_NE(session.find("\"collecting\""), std::string::npos) << session;
    EXPECT_NE(session.find("\"verdict\": \"None\""), std::string::npos) << "not the old one's";
    publish();  // a state from before the request was carried out
  }
  EXPECT_NE(shown("/registration/sessions/40").find("\"Good\""), std::string::npos);
  progress_.commands = 1;
  add_session(41, SessionState::Done).verdict = Verdict::Refused;
  publish();
  EXPECT_NE(shown().find("\"idle\""), std::string::npos);
  EXPECT_NE(shown("/registration/sessions/41").find("\"Refused\""), std::string::npos);
  EXPECT_EQ(ask(router_, "/registration/sessions/99").error().code, ErrorCode::NotFound);
}

TEST_F(Registering, ASessionThatRunsByItselfIsTakenOverAndASecondClientIsRefused) {
  add_session(40, SessionState::Collecting, true).elapsed = 5;
  publish();
  const auto started = act(http::Method::Post, "/registration");
  ASSERT_TRUE(started);
  EXPECT_EQ(started->location, "/registration/sessions/40");
  EXPECT_EQ(asked_, "start 40 for 30 #1; ");
  const auto second = act(http::Method::Post, "/registration");
  ASSERT_FALSE(second);
  EXPECT_EQ(second.error().code, ErrorCode::Conflict);
  EXPECT_NE(second.error().message.find("/registration/sessions/40"), std::string::npos);
}

TEST_F(Registering, EachPlaceSaysHowWellItIsKnown) {
  for (const char* id : {"s1", "s2"}) registration_.sensors[sensor_id(id)] = Extrinsics{};
  auto& known = registration_.sensors[sensor_id("s2")].covariance;
  known.diagonal() << 1e-6, 1e-6, 1e-6, 4e-4, 1.0, 4e-4;  // 20 mm on the floor, 1 m in height
  registration_.master = sensor_id("s1");
  publish();
  const std::string text = shown();
  EXPECT_EQ(text.find("presentRadius"), text.rfind("presentRadius")) << "nothing is known of s1";
  EXPECT_NE(text.find("\"presentRadius\": 0.049"), std::string::npos) << text;
}

TEST_F(Registering, AProposalIsShownWithItsNumbersAndAcceptedOrDeclined) {
  EXPECT_FALSE(parse_session_request(R"({"adopt": "later"})", {}));
  registration_.sensors[sensor_id("s1")] = Extrinsics{};
  registration_.master = sensor_id("s1");
  registration_.version = 4;
  publish();
  EXPECT_EQ(act(http::Method::Post, "/registration/accept").error().code, ErrorCode::NotFound);
  EXPECT_EQ(act(http::Method::Post, "/registration/decline").error().code, ErrorCode::NotFound);
  ASSERT_TRUE(act(http::Method::Post, "/registration", R"({"adopt": "when-accepted"})"));
  EXPECT_NE(shown("/registration/sessions/41").find("\"adopt\": \"when-accepted\""),
            std::string::npos);
  EXPECT_EQ(act(http::Method::Post, "/registration/accept").error().code, ErrorCode::Conflict);
  progress_.commands = 1;
  add_session(41, SessionState::Done);
  Registration next = registration_;
  next.sensors[sensor_id("s2")] = Extrinsics{};
  progress_.proposal = Proposal{41, next, {{sensor_id("s1"), 0.04, 0.02, 0.12, 0.05}}};
  progress_.awaits = {core::kDecide, "sensor s3 has no place yet"};
  progress_.alarms = {"s1 was moved"};
  publish();
  EXPECT_NE(shown().find("new places wait for your decision"), std::string::npos);
  for (const char* text : {"\"presentRadius\": 0.04", "\"expectedRadius\": 0.02", "\"moves\": 0.12",
                           "\"turnsDegrees\": 2.8648"})
    EXPECT_NE(shown().find(text), std::string::npos) << text << shown();
  EXPECT_EQ(shown().find("sensors/s2"), std::string::npos) << "not in use yet";
  EXPECT_EQ(act(http::Method::Post, "/registration/decline")->status, 200);
  EXPECT_EQ(shown().find("proposal"), std::string::npos);
  EXPECT_EQ(shown().find("wait for your decision"), std::string::npos) << shown();
  EXPECT_NE(shown().find("sensor s3 has no place yet"), std::string::npos);
  progress_.commands = 2;
  publish();
  EXPECT_EQ(act(http::Method::Post, "/registration/accept")->status, 200);
  EXPECT_NE(shown().find("sensors/s2"), std::string::npos) << shown();
  EXPECT_EQ(shown().find("\"proposal\""), std::string::npos);
  EXPECT_EQ(shown().find("wait for your decision"), std::string::npos) << shown();
  EXPECT_NE(shown().find("\"earlier\""), std::string::npos);
  EXPECT_EQ(shown().find("sensor s3 has no place yet"), std::string::npos) << "of the old places";
  EXPECT_EQ(shown().find("s1 was moved"), std::string::npos);
  EXPECT_EQ(asked_, "start 41 for 30 to propose #1; decline #2; accept #3; ");
}

TEST_F(Registering, DeleteForgetsAndShowsItFromTheAnswerOn) {
  registration_.sensors[sensor_id("s1")] = Extrinsics{};
  registration_.verdict = Verdict::Good;
  add_session(40, SessionState::Collecting);
  publish();
  EXPECT_EQ(act(http::Method::Delete, "/registration")->status, 204);
  publish();
  EXPECT_EQ(asked_, "forget #1; ");
  EXPECT_EQ(shown().find("\"s1\""), std::string::npos) << shown();
  EXPECT_NE(shown().find("\"verdict\": \"None\""), std::string::npos);
  EXPECT_NE(shown("/registration/sessions/40").find("\"cancelled\""), std::string::npos);
  // The next session has an id that none had before.
  EXPECT_EQ(act(http::Method::Post, "/registration")->location, "/registration/sessions/41");
}

TEST_F(Registering, TheOriginMovesAndIsShownFromTheAnswerOn) {
  registration_.sensors[sensor_id("s1")] = Extrinsics{};
  registration_.verdict = Verdict::Good;
  registration_.version = 12;
  publish();
  EXPECT_EQ(shown().find("\"earlier\""), std::string::npos);
  const auto moved = act(http::Method::Post, "/registration/origin", R"({"x": 2, "z": -1.5})");
  ASSERT_TRUE(moved) << to_string(moved.error());
  EXPECT_EQ(moved->status, 200);
  EXPECT_EQ(asked_, "origin 2 -1.5 0 #1; ");
  EXPECT_NE(shown().find("\"version\": 13"), std::string::npos) << shown();
  EXPECT_NE(shown().find("\"earlier\""), std::string::npos) << "what undo returns to";
  publish();  // publishes a state from before the command was carried out
  EXPECT_NE(shown().find("\"x\": -2"), std::string::npos) << shown();
  EXPECT_NE(shown().find("\"z\": 1.5"), std::string::npos);
}

TEST_F(Registering, TheOriginNeedsAPlaceAndNoSession) {
  publish();
  EXPECT_EQ(act(http::Method::Post, "/registration/origin", "{}").error().code,
            ErrorCode::NotFound);
  registration_.sensors[sensor_id("s1")] = Extrinsics{};
  add_session(40, SessionState::Collecting, true);
  publish();
  const auto busy = act(http::Method::Post, "/registration/origin", "{}");
  EXPECT_EQ(busy.error().code, ErrorCode::Conflict);
  for (const char* way : {"chorus register --cancel", "DELETE /registration/sessions/40"})
    EXPECT_NE(busy.error().message.find(way), std::string::npos) << busy.error().message;
  EXPECT_EQ(asked_, "");
}

TEST(OriginRequest, IsNumbersByName) {
  const auto origin = parse_origin_request(R"({"x": 1, "z": 2, "yawDegrees": 180})");
  ASSERT_TRUE(origin);
  EXPECT_EQ(origin->x, 1.0);
  EXPECT_EQ(origin->z, 2.0);
  EXPECT_NEAR(origin->yaw, deg(180), 1e-12);
  for (const char* wrong : {"", "[]", "3", R"({"y": 1})", R"({"x": "1"})", R"({"yaw": 1})", "{x"})
    EXPECT_EQ(parse_origin_request(wrong).error().code, ErrorCode::InvalidArgument) << wrong;
}

TEST_F(Registering, OnlyASessionThatRunsCanBeCancelled) {
  add_session(40, SessionState::Done);
  add_session(41, SessionState::Collecting);
  publish();
  EXPECT_EQ(act(http::Method::Delete, "/registration/sessions/40").error().code,
            ErrorCode::Conflict);
  EXPECT_EQ(act(http::Method::Delete, "/registration/sessions/9").error().code,
            ErrorCode::NotFound);
  EXPECT_EQ(act(http::Method::Delete, "/registration/sessions/41")->status, 204);
  EXPECT_EQ(asked_, "cancel 41 #1; ");
  EXPECT_NE(shown().find("\"idle\""), std::string::npos);
}

TEST_F(Registering, WhatIsAskedBeforeTheFirstNewsComesTooEarly) {
  EXPECT_EQ(act(http::Method::Post, "/registration").error().code, ErrorCode::Unavailable);
}

TEST(Weights, AreShownOnlyWhereTheMethodUsesThem) {
  SensorStatus s = status("s1");
  const auto document = [&s] { return write(sensor_node(s, "s1"), resource::Format::Json); };
  const auto metrics = [&s] {
    Status all;
    all.sensors = {s};
    return metrics_text(all, {}, {});
  };
  EXPECT_EQ(document().find("\"weight\""), std::string::npos) << document();
  EXPECT_EQ(metrics().find("chorus_view_weight"), std::string::npos);
  s.weight = 0.25;
  EXPECT_NE(document().find("\"weight\": 0.25"), std::string::npos) << document();
  EXPECT_NE(metrics().find("chorus_view_weight{sensor=\"s1\"} 0.25"), std::string::npos);
}

TEST(Metrics, NameEverySensorAndEveryCounterOnce) {
  Status all;
  all.sensors = {status("s1"), status("s2")};
  all.counters.ticks = 42;
  const std::string text = metrics_text(all, {}, {});
  EXPECT_NE(text.find("chorus_fused_frames_total 42"), std::string::npos);
  EXPECT_NE(text.find("chorus_sensor_up{sensor=\"s2\"} 1"), std::string::npos);
  EXPECT_NE(text.find("chorus_frame_age_seconds{sensor=\"s1\"} 0.012"), std::string::npos);
  EXPECT_NE(text.find("chorus_sensor_share{sensor=\"s1\"} 0.75"), std::string::npos);
  EXPECT_NE(text.find("chorus_registration_stored 0"), std::string::npos);
  all.progress.storage.folder = "/var/lib/chorus";
  EXPECT_NE(metrics_text(all, {}, {}).find("chorus_registration_stored 1"), std::string::npos);
  all.progress.own_provisional = true;
  EXPECT_NE(metrics_text(all, {}, {}).find("chorus_registration_stored 0"), std::string::npos)
      << "a restart would not find it";
  const auto first = text.find("# TYPE chorus_sensor_up gauge");
  EXPECT_NE(first, std::string::npos);
  EXPECT_EQ(text.find("# TYPE chorus_sensor_up gauge", first + 1), std::string::npos);
}

}  // namespace
}  // namespace chorus::rest
