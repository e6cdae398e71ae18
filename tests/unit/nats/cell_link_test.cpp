// A link without a server: what it shows of our own cell.
#include "fusion-server/nats/cell_link.h"

#include <condition_variable>
#include <mutex>

#include <gtest/gtest.h>

#include "common/time/clock.h"
#include "fusion-server/nats/site_snapshot.h"

namespace chorus::nats {
namespace {

using ViewPtr = std::shared_ptr<const site::SiteView>;

class Shown {
 public:
  void show(ViewPtr view) {
    {
      const std::scoped_lock lock(mutex_);
      newest_ = std::move(view);
    }
    came_.notify_all();
  }
  /// The view of the snapshot, or of a later one.
  ViewPtr of(std::uint64_t sequence) {
    std::unique_lock lock(mutex_);
    came_.wait_for(lock, std::chrono::seconds(20),
                   [&] { return newest_ && newest_->snapshot->sequence >= sequence; });
    return newest_;
  }

 private:
  std::mutex mutex_;
  std::condition_variable came_;
  ViewPtr newest_;
};

/// `number` seconds from the beginning, by a clock that the test sets itself.
std::shared_ptr<const Snapshot> somebody_at(Timestamp begin, std::uint64_t number) {
  auto made = std::make_shared<Snapshot>();
  made->sequence = number;
  made->instant = begin + number * std::chrono::milliseconds(50);
  made->bodies.resize(1);
  made->bodies[0].id = PersonId{5};
  Joint& pelvis = made->bodies[0].skeleton[JointId::SpineBase];
  pelvis.position = Eigen::Vector3d(1, 0.9, 2);
  pelvis.state = JointState::Tracked;
  return made;
}

TEST(ALink, ShowsOutputsOurOwnCellUntilItHasAPlace) {
  const auto clock = std::make_shared<SystemClock>();
  const Timestamp begin = clock->now();
  LinkConfig config;
  config.site = "hall";
  config.cell = site::CellId::parse("a").value();
  Shown shown;
  CellLink link(config, clock, [&](ViewPtr view) { shown.show(std::move(view)); });
  link.publish(somebody_at(begin, 1));
  const ViewPtr before = shown.of(1);
  ASSERT_TRUE(before);
  EXPECT_TRUE(before->snapshot->bodies.empty());
  ASSERT_EQ(before->shown->bodies.size(), 1U);
  EXPECT_EQ(before->shown->bodies[0].id, PersonId{5});
  site::CellPlace place;
  place.cell = config.cell;
  place.site_from_cell.translation() = Eigen::Vector3d(10, 0, 0);
  link.place(place);
  link.publish(somebody_at(begin, 2));
  const ViewPtr after = shown.of(2);
  ASSERT_TRUE(after);
  EXPECT_EQ(after->shown, after->snapshot);
  ASSERT_EQ(after->cells.size(), 1U);
  ASSERT_TRUE(after->cells[0].place);
  EXPECT_EQ(after->cells[0].place->site_from_cell.translation().x(), 10.0);
}

}  // namespace
}  // namespace chorus::nats
