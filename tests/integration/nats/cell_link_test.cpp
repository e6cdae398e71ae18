// Two cells on a real server: one moves its origin, one asks the other for a frame, one shows whom
// the other tells of before it has anything new itself.
#include "fusion-server/nats/cell_link.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <mutex>
#include <thread>

#include "common/time/clock.h"
#include "fusion-server/nats/cell_records.h"
#include "fusion-server/nats/people_message.h"
#include "fusion-server/nats/subjects.h"
#include "tests/support/nats_server.h"

namespace chorus::nats {
namespace {

using ::testing::HasSubstr;
using testing::NatsServer;

/// A cell that is shown a snapshot every few milliseconds, or when the test says so.
class LinkedCell {
 public:
  LinkedCell(const NatsServer& server, const char* name, bool fed = true)
      : link_(config_of(server, name), clock_, show()) {
    if (fed) feeding_ = std::jthread([this](const std::stop_token& stop) { feed(stop); });
  }

  CellLink& link() { return link_; }
  void feed_once(std::uint64_t number) {
    auto made = std::make_shared<Snapshot>();
    made->sequence = number;
    made->instant = clock_->now();
    made->registration_version = registration_;
    link_.publish(std::move(made));
  }
  /// The first frame with somebody that was made for no snapshot of the cell's own.
  std::optional<Snapshot> shown_in_between() {
    const std::scoped_lock lock(mutex_);
    return in_between_;
  }
  void registration(std::uint64_t version) { registration_ = version; }
  /// Where it holds another cell to be.
  std::optional<site::CellPlace> place_of(const char* name) {
    const std::scoped_lock lock(mutex_);
    if (!view_) return std::nullopt;
    for (const site::KnownCell& cell : view_->cells)
      if (cell.state.cell.str() == name) return cell.place;
    return std::nullopt;
  }

 private:
  static LinkConfig config_of(const NatsServer& server, const char* name) {
    LinkConfig config;
    config.site = "hall";
    config.cell = site::CellId::parse(name).value();
    config.broker.servers = {server.url()};
    config.broker.least_wait = std::chrono::milliseconds(10);
    config.broker.patience = std::chrono::seconds(5);
    return config;
  }
  std::function<void(std::shared_ptr<const site::SiteView>)> show() {
    return [this](auto view) {
      const std::scoped_lock lock(mutex_);
      if (!in_between_ && !view->shown && !view->people.empty()) in_between_ = *view->snapshot;
      view_ = std::move(view);
    };
  }
  void feed(const std::stop_token& stop) {
    for (std::uint64_t i = 1; !stop.stop_requested(); ++i) {
      feed_once(i);
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
  }

  std::shared_ptr<const Clock> clock_ = std::make_shared<SystemClock>();
  std::mutex mutex_;
  std::shared_ptr<const site::SiteView> view_;
  std::optional<Snapshot> in_between_;
  std::atomic<std::uint64_t> registration_ = 1;
  CellLink link_;
  std::jthread feeding_;
};

template <class Condition>
bool comes_true(const Condition& condition,
                std::chrono::milliseconds within = std::chrono::seconds(20)) {
  const auto deadline = std::chrono::steady_clock::now() + within;
  while (!condition() && std::chrono::steady_clock::now() < deadline)
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  return condition();
}

site::CellPlace at_x(const char* cell, double x) {
  site::CellPlace place;
  place.cell = site::CellId::parse(cell).value();
  place.site_from_cell.translation().x() = x;
  return place;
}

TEST(TwoLinks, KnowWhereAMovedCellStandsFromItsNewWorldOn) {
  NatsServer server;
  ASSERT_TRUE(server.start()) << server.log();
  LinkedCell a(server, "a");
  LinkedCell b(server, "b");
  const auto seen_at = [&](double x) {
    const auto place = b.place_of("a");
    return place && place->site_from_cell.translation().x() == x;
  };
  a.link().place(at_x("a", 5));
  ASSERT_TRUE(comes_true([&] { return seen_at(5); }));
  const std::uint64_t version = b.place_of("a")->version;
  a.link().place(at_x("a", 8), 2);
  const auto own = [&] { return a.place_of("a")->site_from_cell.translation().x(); };
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  EXPECT_EQ(own(), 5.0) << "no snapshot of that registration yet";
  a.registration(2);
  ASSERT_TRUE(comes_true([&] { return seen_at(8); }));
  EXPECT_GT(b.place_of("a")->version, version);
  // It stays so, whatever the store still holds.
  for (int i = 0; i < 20; ++i) {
    EXPECT_TRUE(seen_at(8));
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
}

/// What a third cell would publish: one person under a site id.
std::string told_by(const char* cell, std::uint64_t number, Timestamp at) {
  site::CellPeople people{site::CellId::parse(cell).value(), 7, number, at, {}};
  people.people.resize(1);
  people.people[0].body = PersonId{3};
  people.people[0].since = at;
  people.people[0].site_id = site::SiteId::parse("k1").value();
  people.people[0].site_certainty = 1.0;
  people.people[0].place = Eigen::Vector3d(1, 0.9, 2);
  people.people[0].joints[index_of(JointId::SpineBase)] = people.people[0].place;
  return write_people(people);
}

TEST(ALink, ShowsWhomANeighbourTellsOfAtOnce) {
  NatsServer server;
  ASSERT_TRUE(server.start()) << server.log();
  LinkedCell a(server, "a", false);
  a.link().place(at_x("a", 0));
  BrokerConfig as_b;
  as_b.servers = {server.url()};
  Broker b(as_b, {});
  const std::string card = write_card({site::CellId::parse("b").value(), 7, "", "", at_x("b", 5)});
  std::uint64_t number = 0;
  const auto shown_soon = [&] {
    a.feed_once(++number);  // The only frame of its own for a while.
    b.publish(subject_of("hall", "b", kStatus), card);
    b.publish(subject_of("hall", "b", kPeople), told_by("b", number, SystemClock().now()));
    return comes_true([&] { return a.shown_in_between().has_value(); },
                      std::chrono::milliseconds(200));
  };
  ASSERT_TRUE(comes_true(shown_soon));
  const Snapshot shown = *a.shown_in_between();
  ASSERT_EQ(shown.bodies.size(), 1U);
  EXPECT_NEAR(shown.bodies[0].skeleton[JointId::SpineBase].position.x(), 6.0, 1e-6);
  EXPECT_GT(shown.sequence, 1U);
}

TEST(TwoLinks, AskOneAnotherForFrames) {
  NatsServer server;
  ASSERT_TRUE(server.start()) << server.log();
  LinkedCell a(server, "a");
  LinkedCell b(server, "b");
  ASSERT_TRUE(comes_true([&] { return a.link().ask_frame("b", "").has_value(); }));
  EXPECT_THAT(a.link().ask_frame("b", "").value(), HasSubstr("\"sequence\""));
  const auto ancient = a.link().ask_frame("b", "17");
  ASSERT_FALSE(ancient);
  EXPECT_EQ(ancient.error().code, ErrorCode::NotFound);
  const auto nobody = a.link().ask_frame("c", "");
  ASSERT_FALSE(nobody);
  EXPECT_EQ(nobody.error().code, ErrorCode::Unavailable);
  EXPECT_EQ(a.link().ask_frame("*", "").error().code, ErrorCode::NotFound);
}

}  // namespace
}  // namespace chorus::nats
