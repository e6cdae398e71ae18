// A member of a hall without a server: what the link is told of where our own cell stands.
#include "fusion-server/server/site_member.h"

#include <condition_variable>
#include <mutex>
#include <thread>

#include <gtest/gtest.h>

#include "common/time/clock.h"
#include "fusion-server/nats/cell_records.h"

namespace chorus::server {
namespace {

constexpr int kRounds = 500;

SensorId sensor(const char* name) { return SensorId::parse(name).value(); }

class Member {
 public:
  Member() : member_(options(), places_of(0, 0)) {}

  SiteMember& operator*() { return member_; }
  SiteMember* operator->() { return &member_; }

  /// Our cell at x = `ours`, and another one.
  static std::string places_of(int ours, int other) {
    site::CellPlace a;
    a.cell = site::CellId::parse("a").value();
    a.site_from_cell.translation().x() = ours;
    site::CellPlace b;
    b.cell = site::CellId::parse("b").value();
    b.site_from_cell.translation().x() = other;
    return nats::write_places({a, b});
  }
  /// The origin is moved by a metre from one version to the next.
  static Registration registration(int version) {
    Registration out;
    out.version = static_cast<std::uint64_t>(version);
    out.sensors[sensor("s1")].world_from_sensor.translation() = Eigen::Vector3d(version, 1, 2);
    return out;
  }
  /// Where the link holds our cell to be, once it has taken what it was told.
  double x() {
    auto snapshot = std::make_shared<Snapshot>();
    snapshot->sequence = ++sequence_;
    snapshot->instant = begin_ + sequence_ * std::chrono::milliseconds(50);
    snapshot->registration_version = kRounds + 1;
    member_.link().publish(snapshot);
    std::unique_lock lock(mutex_);
    came_.wait_for(lock, std::chrono::seconds(20),
                   [&] { return view_ && view_->snapshot->sequence >= sequence_; });
    if (!view_ || view_->cells.empty() || !view_->cells[0].place) return -1;
    return view_->cells[0].place->site_from_cell.translation().x();
  }

 private:
  SiteMemberOptions options() {
    SiteMemberOptions out;
    out.settings.link.site = "hall";
    out.settings.link.cell = site::CellId::parse("a").value();
    out.clock = std::make_shared<SystemClock>();
    out.on_view = [this](auto view) {
      const std::scoped_lock lock(mutex_);
      view_ = std::move(view);
      came_.notify_all();
    };
    return out;
  }

  const Timestamp begin_ = SystemClock().now();
  std::uint64_t sequence_ = 0;
  std::mutex mutex_;
  std::condition_variable came_;
  std::shared_ptr<const site::SiteView> view_;
  SiteMember member_;
};

TEST(SiteMember, TellsTheLinkOfAMovedOriginAndOfAnotherFile) {
  Member member;
  EXPECT_EQ(member.x(), 0.0);
  member->follow(Member::registration(1));
  member->follow(Member::registration(2));
  EXPECT_NEAR(member.x(), -1.0, 1e-9);
  member->places(Member::places_of(0, 5));
  EXPECT_NEAR(member.x(), -1.0, 1e-9) << "the file says the same of our cell";
  member->places(Member::places_of(3, 5));
  EXPECT_NEAR(member.x(), 3.0, 1e-9);
}

// The file of places is read by one thread, registrations come by another.
TEST(SiteMember, TellsTheLinkTheNewestThoughBothChangeAtOnce) {
  Member member;
  std::jthread reading([&] {
    for (int i = 1; i <= kRounds; ++i) member->places(Member::places_of(1000 * i, 0));
  });
  std::jthread moving([&] {
    for (int i = 1; i <= kRounds; ++i) member->follow(Member::registration(i));
  });
  reading.join();
  moving.join();
  const double told = member.x();
  // The file says the same of our cell, so the link is told once more what the member holds.
  member->places(Member::places_of(1000 * kRounds, 1));
  EXPECT_EQ(member.x(), told);
  EXPECT_LE(told, 1000.0 * kRounds);
  EXPECT_GE(told, 1000.0 * kRounds - kRounds);
}

}  // namespace
}  // namespace chorus::server
