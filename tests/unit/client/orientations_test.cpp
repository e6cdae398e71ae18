// Following /orientations with real sockets on loopback: the same follower, another kind.
#include "common/client/orientations.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <condition_variable>
#include <mutex>

#include "common/client/answer.h"
#include "common/client/followers.h"
#include "common/http/server.h"
#include "common/resource/link_lines.h"
#include "tests/support/builders.h"

namespace chorus::client {
namespace {

using resource::OrientationsResource;
using std::chrono::milliseconds;
using testing::sensor_id;

std::shared_ptr<const OrientationsResource> said(std::uint64_t sequence, Timestamp captured) {
  auto document = std::make_shared<OrientationsResource>();
  document->sequence = sequence;
  document->captured = captured;
  document->source = "suit";
  for (const int i : {1, 0}) {
    inertial::InertialFrame& instant = document->instants.emplace_back();
    instant.sequence = 2 * sequence - static_cast<std::uint64_t>(i);
    instant.captured = captured - milliseconds(10) * i;
    inertial::InertialReading& one = instant.readings.emplace_back();
    one.sensor = "pelvis";
    one.captured = instant.captured;
    one.inertial_from_sensor = Eigen::Quaterniond::Identity();
  }
  return document;
}

/// Serves the newest document live, and any document by its number.
class Suit {
 public:
  Suit() {
    auto router = std::make_shared<http::Router>();
    router->live("/orientations", live_);
    router->get("/orientations/{seq}",
                [this](const http::Request&, const http::PathParams& params) {
                  return Result<http::DocumentPtr>(
                      document(said(std::stoull(params.at("seq")), SystemClock().now())));
                });
    http::ServerConfig config;
    config.port = 0;
    config.policy = resource::answer_policy();
    server_ = std::make_unique<http::Server>(config, router);
    if (auto ok = server_->start(); !ok) ADD_FAILURE() << to_string(ok.error());
  }
  void say(std::uint64_t sequence) {
    live_->publish(document(said(sequence, SystemClock().now())));
  }
  [[nodiscard]] std::string url() const {
    return "http://127.0.0.1:" + std::to_string(server_->port()) + "/";
  }

 private:
  static http::DocumentPtr document(std::shared_ptr<const OrientationsResource> orientations) {
    const auto options =
        resource::latest_options(resource::document_of_value(orientations), "orientations/", "");
    return resource::orientations_document(std::move(orientations), {"orientations"}, options);
  }

  std::shared_ptr<http::LiveDocument> live_ = std::make_shared<http::LiveDocument>();
  std::unique_ptr<http::Server> server_;
};

struct Listener {
  std::mutex mutex;
  std::condition_variable arrived;
  std::vector<Arrived<OrientationsResource>> heard;

  bool wait_for(std::size_t count) {
    std::unique_lock lock(mutex);
    return arrived.wait_for(lock, std::chrono::seconds(20), [&] { return heard.size() >= count; });
  }
};

TEST(FollowingOrientations, DeliversEachDocumentOnceAndFetchesWhatAStreamLeftOut) {
  Suit suit;
  Listener listener;
  Followers followers({});
  followers.follow<OrientationsResource>(kOrientations, {{sensor_id("suit"), suit.url()}},
                                         [&](Arrived<OrientationsResource> one) {
                                           const std::scoped_lock lock(listener.mutex);
                                           listener.heard.push_back(std::move(one));
                                           listener.arrived.notify_all();
                                         });
  for (std::uint64_t i = 1; i <= 10; ++i) {
    suit.say(i);
    ASSERT_TRUE(listener.wait_for(i)) << i;
  }
  const auto streams = [&] { return followers.reports(kOrientations).at(0).streaming; };
  for (std::uint64_t i = 11; !streams() && i < 2000; ++i) {
    suit.say(i);
    ASSERT_TRUE(listener.wait_for(i));
  }
  const std::uint64_t newest = listener.heard.back().document->sequence;
  const std::size_t before = listener.heard.size();
  suit.say(newest + 3);  // Two are left out.
  ASSERT_TRUE(listener.wait_for(before + 3));
  EXPECT_EQ(followers.reports(kOrientations).at(0).missed, 0u);
  EXPECT_TRUE(followers.reports(kFrames).empty()) << "it is no sensor";
  followers.stop();
  const auto placed = place_in_time(listener.heard.front());
  ASSERT_EQ(placed.size(), 2u);
  EXPECT_EQ(placed[0].source, sensor_id("suit"));
  EXPECT_LT(std::chrono::abs(placed[1].captured - listener.heard.front().document->captured),
            milliseconds(50));
  EXPECT_EQ(placed[1].captured - placed[0].captured, milliseconds(10));
}

TEST(FollowingOrientations, RefusesAnotherSourceAndAnotherKind) {
  const auto text =
      resource::write(*said(1, from_unix_ns(1'795'246'200'000'000'000)), resource::Format::Json);
  EXPECT_TRUE(read_event(text, kOrientations, sensor_id("suit")));
  const auto stranger = read_event(text, kOrientations, sensor_id("s1"));
  ASSERT_FALSE(stranger);
  EXPECT_THAT(to_string(stranger.error()), ::testing::HasSubstr("make both the same"));
  EXPECT_FALSE(read_event(text, kFrames, sensor_id("suit")));
  EXPECT_FALSE(read_event(R"({"@type":"Frame"})", kOrientations, sensor_id("suit")));
}

}  // namespace
}  // namespace chorus::client
