// Following with real sockets on loopback: good, dead, lying and returning sensors at the same
// time.
#include "common/client/followers.h"

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <map>
#include <mutex>
#include <new>
#include <optional>

#include <gtest/gtest.h>

#include "common/http/server.h"
#include "common/resource/frame_document.h"
#include "common/resource/link_lines.h"
#include "tests/support/builders.h"

namespace chorus::client {
namespace {

using std::chrono::milliseconds;
using testing::sensor_id;

constexpr auto kPatience =
    std::chrono::seconds(20);  // for loaded machines; nothing takes that long

/// A sensor service that serves frames on demand, or anything else at /frame.
class FakeSensor {
 public:
  explicit FakeSensor(std::string name, std::uint16_t port = 0,
                      std::shared_ptr<const Clock> clock = std::make_shared<SystemClock>())
      : name_(std::move(name)) {
    auto router = std::make_shared<http::Router>();
    router->live("/frame", live_);
    router->get(
        "/frames/{seq}",
        [this](const http::Request&, const http::PathParams& params) -> Result<http::DocumentPtr> {
          const std::scoped_lock lock(mutex_);
          const auto kept = kept_.find(params.at("seq"));
          if (kept != kept_.end()) return kept->second;
          return fail(ErrorCode::NotFound, "frames", "no such frame");
        });
    http::ServerConfig config;
    config.port = port;
    config.clock = std::move(clock);
    config.policy = resource::answer_policy();
    server_ = std::make_unique<http::Server>(config, router);
    if (auto ok = server_->start(); !ok) ADD_FAILURE() << to_string(ok.error());
  }

  void send(std::uint64_t sequence, Timestamp captured) {
    live_->publish(document(sequence, captured));
  }
  /// Serves a frame at /frames/{seq} only.
  void keep(std::uint64_t sequence, Timestamp captured) {
    const std::scoped_lock lock(mutex_);
    kept_[std::to_string(sequence)] = document(sequence, captured);
  }
  void answer(std::string type, std::string body) {
    http::DocumentOptions options;
    options.version = std::to_string(++version_);
    live_->publish(http::make_document(std::move(type), std::move(body), options));
  }

  [[nodiscard]] std::uint16_t port() const { return server_->port(); }
  [[nodiscard]] std::uint64_t requests() const { return server_->counters().requests; }
  [[nodiscard]] std::string url() const {
    return "http://127.0.0.1:" + std::to_string(port()) + "/";
  }

 private:
  http::DocumentPtr document(std::uint64_t sequence, Timestamp captured) const {
    auto frame = testing::sensor_frame(name_, captured, {});
    auto resource = resource::to_resource(frame);
    resource.sequence = sequence;
    const auto shared = std::make_shared<const resource::FrameResource>(std::move(resource));
    return resource::frame_document(shared, {"frame", {}}, resource::latest_options(*shared));
  }

  std::string name_;
  std::mutex mutex_;
  std::map<std::string, http::DocumentPtr> kept_;  ///< Guarded by mutex_.
  std::shared_ptr<http::LiveDocument> live_ = std::make_shared<http::LiveDocument>();
  std::unique_ptr<http::Server> server_;
  int version_ = 0;
};

class Polling : public ::testing::Test {
 protected:
  Polling() {
    FollowOptions options;
    options.clock = clock_;
    options.timings.wait = std::chrono::seconds(1);
    options.timings.first_backoff = milliseconds(10);
    options.timings.max_backoff = milliseconds(50);
    followers_ = std::make_unique<Followers>(options);
  }
  void follow(std::vector<FollowedService> services) {
    followers_->follow<resource::FrameResource>(
        kFrames, std::move(services), [this](const Arrived<resource::FrameResource>& arrived) {
          const std::scoped_lock lock(mutex_);
          if (arrived.document->sequence == throws_at_) throw std::bad_alloc();
          frames_[arrived.source].push_back(place_in_time(arrived));
          arrived_.notify_all();
        });
  }
  ~Polling() override { followers_.reset(); }

  [[nodiscard]] std::size_t count(const char* sensor) {
    const std::scoped_lock lock(mutex_);
    return frames_[sensor_id(sensor)].size();
  }
  bool wait_for(const char* sensor, std::size_t frames) {
    std::unique_lock lock(mutex_);
    return arrived_.wait_for(lock, kPatience,
                             [&] { return frames_[sensor_id(sensor)].size() >= frames; });
  }
  bool wait_until(const std::function<bool(const FollowReport&)>& holds, const char* sensor) {
    const auto deadline = std::chrono::steady_clock::now() + kPatience;
    while (std::chrono::steady_clock::now() < deadline) {
      for (const FollowReport& report : followers_->reports()) {
        if (report.service.id == sensor_id(sensor) && holds(report)) return true;
      }
      std::this_thread::sleep_for(milliseconds(2));
    }
    return false;
  }
  /// Publishes frames one by one, each after the previous one arrived; each must arrive exactly
  /// once.
  void expect_every_frame(FakeSensor& sensor, const char* name, int frames) {
    const std::size_t before = count(name);
    for (int i = 0; i < frames; ++i) {
      sensor.send(++sequence_, clock_->now());
      ASSERT_TRUE(wait_for(name, before + static_cast<std::size_t>(i) + 1)) << i;
    }
    EXPECT_EQ(count(name), before + static_cast<std::size_t>(frames));
  }

  std::shared_ptr<const Clock> clock_ = std::make_shared<SystemClock>();
  std::mutex mutex_;
  std::condition_variable arrived_;
  std::map<SensorId, std::vector<SensorFrame>> frames_;
  std::uint64_t sequence_ = 0;
  std::optional<std::uint64_t> throws_at_;  ///< Guarded by mutex_: where deliver() throws.
  std::unique_ptr<Followers> followers_;
};

TEST_F(Polling, DeliversEveryFrameOnce) {
  FakeSensor s1("s1");
  follow({{sensor_id("s1"), s1.url()}});
  expect_every_frame(s1, "s1", 20);
  EXPECT_TRUE(wait_until([](const FollowReport& r) { return r.state == SensorState::Live; }, "s1"));
  const auto report = followers_->reports().at(0);
  EXPECT_EQ(report.frames, 20u);
  EXPECT_EQ(report.missed, 0u);
  ASSERT_TRUE(report.clock);
  // Both clocks are this host's: the estimate must be zero within its own bound.
  EXPECT_LE(std::chrono::abs(report.clock->ours_minus_theirs), report.clock->uncertainty);
}

TEST_F(Polling, ADeadAndALyingSensorDoNotStallAGoodOne) {
  FakeSensor good("s1");
  FakeSensor liar("s2");
  liar.answer("text/turtle", std::string(20000, '['));
  FakeSensor page("s3");
  page.answer("text/html", "<html></html>");
  follow({{sensor_id("s1"), good.url()},
          {sensor_id("s2"), liar.url()},
          {sensor_id("s3"), page.url()},
          {sensor_id("s4"), "http://127.0.0.1:1/"}});
  expect_every_frame(good, "s1", 20);
  const auto refused = [](const FollowReport& r) { return r.state == SensorState::Refused; };
  EXPECT_TRUE(wait_until(refused, "s2"));
  EXPECT_TRUE(wait_until(refused, "s3"));
  EXPECT_TRUE(wait_until([](const FollowReport& r) { return !r.last_error.empty(); }, "s4"));
  EXPECT_EQ(count("s2") + count("s3") + count("s4"), 0u);
}

TEST_F(Polling, ALiarThatTellsTheTruthAgainIsTakenBack) {
  FakeSensor s1("s1");
  s1.answer("text/turtle", "nonsense");
  follow({{sensor_id("s1"), s1.url()}});
  EXPECT_TRUE(
      wait_until([](const FollowReport& r) { return r.state == SensorState::Refused; }, "s1"));
  expect_every_frame(s1, "s1", 3);
  EXPECT_TRUE(wait_until([](const FollowReport& r) { return r.state == SensorState::Live; }, "s1"));
}

TEST_F(Polling, AReturningSensorIsFoundAgain) {
  auto s1 = std::make_unique<FakeSensor>("s1");
  const std::uint16_t port = s1->port();
  follow({{sensor_id("s1"), s1->url()}});
  expect_every_frame(*s1, "s1", 3);
  s1.reset();
  EXPECT_TRUE(wait_until([](const FollowReport& r) { return r.state == SensorState::Lost; }, "s1"));
  s1 = std::make_unique<FakeSensor>("s1", port);
  expect_every_frame(*s1, "s1", 3);
}

TEST_F(Polling, SensorsComeAndGo) {
  FakeSensor s1("s1");
  FakeSensor s2("s2");
  follow({{sensor_id("s1"), s1.url()}});
  expect_every_frame(s1, "s1", 2);
  follow({{sensor_id("s1"), s1.url()}, {sensor_id("s2"), s2.url()}});
  expect_every_frame(s2, "s2", 2);
  follow({{sensor_id("s2"), s2.url()}});
  ASSERT_EQ(followers_->reports().size(), 1u);
  expect_every_frame(s2, "s2", 2);
}

TEST_F(Polling, WhatIsThrownOverAFrameIsAFailedPollAndNotTheEnd) {
  FakeSensor s1("s1");
  FakeSensor s2("s2");
  {
    const std::scoped_lock lock(mutex_);
    throws_at_ = 7;
  }
  follow({{sensor_id("s1"), s1.url()}, {sensor_id("s2"), s2.url()}});
  s1.send(7, clock_->now());
  EXPECT_TRUE(wait_until([](const FollowReport& r) { return r.failures == 1; }, "s1"));
  EXPECT_NE(followers_->reports().at(0).last_error.find("bad_alloc"), std::string::npos);
  sequence_ = 7;
  expect_every_frame(s1, "s1", 3);
  expect_every_frame(s2, "s2", 3);
  EXPECT_TRUE(wait_until([](const FollowReport& r) { return r.state == SensorState::Live; }, "s1"));
}

TEST_F(Polling, AnEndlessStreamOfTheSameFrameIsNotASpin) {
  FakeSensor s1("s1");
  follow({{sensor_id("s1"), s1.url()}});
  const Timestamp once = clock_->now();
  s1.send(1, once);
  ASSERT_TRUE(wait_for("s1", 1));
  const auto before = s1.requests();
  for (int i = 2; i < 40; ++i) {  // a new tag, but the old capture time
    s1.send(static_cast<std::uint64_t>(i), once);
    std::this_thread::sleep_for(milliseconds(2));
  }
  EXPECT_EQ(count("s1"), 1u);
  EXPECT_LT(s1.requests() - before, 40u);
}

bool streams(const FollowReport& report) { return report.streaming; }

TEST_F(Polling, ASensorWithAnEventStreamIsNotPolled) {
  FakeSensor s1("s1");
  follow({{sensor_id("s1"), s1.url()}});
  expect_every_frame(s1, "s1", 2);
  ASSERT_TRUE(wait_until(streams, "s1"));
  const auto before = s1.requests();
  expect_every_frame(s1, "s1", 50);
  EXPECT_LT(s1.requests() - before, 25u);  // most of these are requests for the clock
}

TEST_F(Polling, WhatAStreamLeftOutIsFetched) {
  FakeSensor s1("s1");
  follow({{sensor_id("s1"), s1.url()}});
  expect_every_frame(s1, "s1", 2);
  ASSERT_TRUE(wait_until(streams, "s1"));
  const Timestamp now = clock_->now();
  s1.keep(3, now - milliseconds(99));
  s1.keep(4, now - milliseconds(66));
  s1.send(5, now);
  ASSERT_TRUE(wait_for("s1", 5));
  EXPECT_EQ(followers_->reports().at(0).missed, 0u);
}

TEST_F(Polling, OneThatNeverStreamsIsPolled) {
  FollowOptions options;
  options.clock = clock_;
  options.timings.stream = false;
  std::atomic<int> frames = 0;
  Followers polling(options);
  FakeSensor s1("s1");
  polling.follow<resource::FrameResource>(
      kFrames, {{sensor_id("s1"), s1.url()}},
      [&](const Arrived<resource::FrameResource>&) { ++frames; });
  for (int i = 1; i <= 20; ++i) {
    s1.send(static_cast<std::uint64_t>(i), clock_->now());
    const auto deadline = std::chrono::steady_clock::now() + kPatience;
    while (frames < i && std::chrono::steady_clock::now() < deadline)
      std::this_thread::sleep_for(milliseconds(1));
  }
  EXPECT_EQ(frames, 20);
  EXPECT_FALSE(polling.reports().at(0).streaming);
}

/// A clock that is set while it is in use.
class SetClock final : public Clock {
 public:
  [[nodiscard]] Timestamp now() const override {
    return SystemClock().now() + Duration(error_ns_.load());
  }
  void set(Duration error) { error_ns_ = error.count(); }

 private:
  std::atomic<std::int64_t> error_ns_ = 0;
};

TEST_F(Polling, AClockThatIsSetIsFollowedAndCostsHardlyAFrame) {
  for (const Duration step : {Duration(milliseconds(-700)), Duration(milliseconds(900))}) {
    const auto theirs = std::make_shared<SetClock>();
    FakeSensor s1("s1", 0, theirs);
    follow({{sensor_id("s1"), s1.url()}});
    expect_every_frame(s1, "s1", 20);
    ASSERT_TRUE(wait_until(streams, "s1"));
    const std::size_t before = count("s1");
    theirs->set(step);
    std::vector<Timestamp> truth;
    for (int i = 0; i < 40; ++i) {
      truth.push_back(clock_->now());
      s1.send(++sequence_, theirs->now());
      std::this_thread::sleep_for(milliseconds(33));
    }
    ASSERT_TRUE(wait_for("s1", before + 38));
    const std::scoped_lock lock(mutex_);
    int wrong = 0;
    const auto& frames = frames_[sensor_id("s1")];
    for (std::size_t i = before; i < frames.size(); ++i) {
      const auto nearest = std::min_element(truth.begin(), truth.end(), [&](auto a, auto b) {
        return std::chrono::abs(a - frames[i].captured) < std::chrono::abs(b - frames[i].captured);
      });
      wrong += std::chrono::abs(*nearest - frames[i].captured) > milliseconds(10) ? 1 : 0;
    }
    EXPECT_LE(wrong, 2) << std::chrono::seconds(1) / step;
    follow({});
    frames_.clear();
  }
}

TEST_F(Polling, StampsOfAnotherTimeAreRefusedByName) {
  FakeSensor ahead("s1");
  FakeSensor behind("s2");
  follow({{sensor_id("s1"), ahead.url()}, {sensor_id("s2"), behind.url()}});
  ahead.send(1, clock_->now() + std::chrono::hours(1));
  behind.send(1, from_unix_ns(0));
  const auto refused = [](const FollowReport& r) { return r.state == SensorState::Refused; };
  ASSERT_TRUE(wait_until(refused, "s1"));
  ASSERT_TRUE(wait_until(refused, "s2"));
  const auto reports = followers_->reports();
  EXPECT_NE(reports.at(0).last_error.find("s ahead of our clock"), std::string::npos)
      << reports.at(0).last_error;
  EXPECT_NE(reports.at(1).last_error.find("s behind our clock"), std::string::npos);
  EXPECT_GE(reports.at(0).early, 1u);
  EXPECT_GE(reports.at(1).stale, 1u);
  EXPECT_EQ(count("s1") + count("s2"), 0u);
}

TEST_F(Polling, NothingIsDeliveredAfterStop) {
  FakeSensor s1("s1");
  follow({{sensor_id("s1"), s1.url()}});
  expect_every_frame(s1, "s1", 2);
  followers_->stop();
  s1.send(99, clock_->now());
  EXPECT_EQ(count("s1"), 2u);
  EXPECT_EQ(followers_->reports().size(), 1u);
}

}  // namespace
}  // namespace chorus::client
