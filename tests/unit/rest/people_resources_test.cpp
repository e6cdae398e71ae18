// /people/ and /events without a socket.
#include "fusion-server/rest/people_resources.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "fusion-server/rest/event_resources.h"
#include "tests/support/served.h"
#include "tests/unit/rest/asked.h"

namespace chorus::rest {
namespace {

using ::testing::ElementsAre;
using testing::get;
using ::testing::IsEmpty;
using testing::kStart;
using Json = nlohmann::json;

class People : public ::testing::Test {
 protected:
  People() { people_.add_routes(router_); }

  /// The status of a writing request, or of its refusal; its answer is in answer_.
  int ask_to(http::Method method, const std::string& path, std::string_view body = {}) {
    const auto match = router_.match(path);
    if (!match) return 404;
    http::Request request;
    request.method = method;
    request.path = path;
    request.body = body;
    const auto done = match->entry->actions.at(method)(request, match->params);
    answer_ = done ? "" : done.error().message;
    return done ? done->status : http_status(done.error().code);
  }
  [[nodiscard]] Json list() const {
    return Json::parse(get(router_, "/people/").body).at("people");
  }

  std::vector<PersonId> forgotten_;
  PeopleResources people_{
      {"run1"}, std::chrono::minutes(1), [this](PersonId id) { forgotten_.push_back(id); }};
  http::Router router_;
  std::string answer_;
};

TEST_F(People, AreListedWithWhatIsKnownOfThem) {
  EXPECT_THAT(list(), IsEmpty()) << "there is a list before there is anybody";
  people_.publish(snapshot(1));
  const Json seven = list().at("7");
  EXPECT_EQ(Json::parse(get(router_, "/people/7").body).at("personId"), "7") << "the key above";
  EXPECT_EQ(seven.at("state"), "seen");
  EXPECT_EQ(seven.at("sensors"), Json::array({"s1"}));
  EXPECT_FALSE(seven.contains("name"));
  EXPECT_FALSE(seven.contains("lastSeen"));
  EXPECT_EQ(get(router_, "/people/7").status, 200);
  EXPECT_EQ(get(router_, "/people/8").status, 404);
  EXPECT_EQ(get(router_, "/people/anna").status, 404);
  journal::KnownPerson whole;
  whole.name = "Anna";
  whole.slot = 0;
  whole.last_seen = kStart;
  whole.sides_confidence = 0.9;
  whole.stature = LearnedLength{1.8, 0.02};
  EXPECT_THAT(resource::undeclared_terms(person_node(whole, "7")), IsEmpty());
}

TEST_F(People, GetANameThatIsChecked) {
  people_.publish(snapshot(1));
  EXPECT_EQ(ask_to(http::Method::Patch, "/people/7", R"({"name": "Anna"})"), 200);
  EXPECT_EQ(list().at("7").at("name"), "Anna");
  EXPECT_EQ(Json::parse(get(router_, "/people/7").body).at("name"), "Anna");
  for (const char* bad : {R"({"name": "a/b"})", R"({"name": "a\u0000"})", R"({"name": 7})", "{}",
                          "", R"({"name": "x", "slot": 1})", "[]", R"({"name": "\ud800"})"})
    EXPECT_EQ(ask_to(http::Method::Patch, "/people/7", bad), 400) << bad;
  EXPECT_EQ(list().at("7").at("name"), "Anna");
  EXPECT_EQ(ask_to(http::Method::Patch, "/people/8", R"({"name": "Bob"})"), 404);
  EXPECT_EQ(ask_to(http::Method::Patch, "/people/7", R"({"name": null})"), 200);
  EXPECT_FALSE(list().at("7").contains("name"));
}

TEST_F(People, AreForgottenAtOnce) {
  people_.publish(snapshot(1));
  EXPECT_EQ(ask_to(http::Method::Post, "/people/8/forget"), 404);
  EXPECT_EQ(ask_to(http::Method::Post, "/people/7/forget"), 204);
  EXPECT_THAT(forgotten_, ElementsAre(PersonId{7}));
  people_.publish(snapshot(100));
  EXPECT_THAT(list(), IsEmpty()) << "though an instant on its way still has them";
}

TEST_F(People, TheListIsPublishedFiveTimesASecondAtMost) {
  people_.publish(snapshot(1));
  const std::string first = get(router_, "/people/").etag;
  auto other = std::make_shared<Snapshot>(*snapshot(2));
  other->bodies[0].contributors.fill(0);
  people_.publish(other);
  EXPECT_EQ(get(router_, "/people/").etag, first);
  EXPECT_THAT(Json::parse(get(router_, "/people/7").body).at("sensors"), IsEmpty())
      << "one person is shown as they are now";
  auto later = std::make_shared<Snapshot>(*other);
  later->instant += std::chrono::milliseconds(200);
  people_.publish(later);
  EXPECT_NE(get(router_, "/people/").etag, first) << "a change is not lost";
}

journal::Glimpse glimpse(const char* state, Duration after) {
  journal::Glimpse now;
  now.time = kStart + after;
  SensorStatus one;
  one.id = testing::sensor_id("s1");
  one.state = state;
  now.sensors = {one};
  return now;
}

TEST(Events, AreListedAndStreamedByTheirIds) {
  EventResources events({"run1"}, 500);
  http::Router router;
  events.add_routes(router);
  EXPECT_THAT(Json::parse(get(router, "/events").body).at("events"), IsEmpty());
  EXPECT_THAT(events.look(glimpse("live", {})), IsEmpty());
  EXPECT_EQ(events.look(glimpse("lost", std::chrono::seconds(1))).size(), 1u);
  EXPECT_EQ(events.look(glimpse("live", std::chrono::seconds(2))).size(), 1u);
  const Json all = Json::parse(get(router, "/events").body).at("events");
  ASSERT_EQ(all.size(), 2u);
  EXPECT_EQ(all[0].at("eventId"), "500");
  EXPECT_EQ(all[0].at("kind"), "sensor-lost");
  EXPECT_EQ(all[0].at("severity"), "warning");
  EXPECT_TRUE(all[0].contains("advice"));
  EXPECT_EQ(all[1].at("kind"), "sensor-back");
  const Json later = Json::parse(get(router, "/events?after=500").body).at("events");
  ASSERT_EQ(later.size(), 1u);
  EXPECT_EQ(later[0].at("eventId"), "501");
  EXPECT_EQ(get(router, "/events?after=x").status, 400);
  const auto match = router.match("/events");
  ASSERT_TRUE(match && match->entry->log);
  const auto streamed = match->entry->log->after(500);
  ASSERT_TRUE(streamed);
  EXPECT_EQ(streamed->id, 501u);
  EXPECT_EQ(streamed->json.find('\n'), std::string::npos) << "one line of the stream";
  EXPECT_EQ(Json::parse(streamed->json).at("message"), "s1 delivers frames again.");
  EXPECT_FALSE(match->entry->log->after(501));
  journal::Event whole;
  whole.about = "s1";
  whole.advice = "Do it.";
  EXPECT_THAT(resource::undeclared_terms(event_node(whole)), IsEmpty());
}

}  // namespace
}  // namespace chorus::rest
