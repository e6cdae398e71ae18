// A link without a server: what it shows of our own cell, and what it makes of an answer.
#include "fusion-server/nats/cell_link.h"

#include <condition_variable>
#include <mutex>

#include <gtest/gtest.h>

#include "common/base/shortened.h"
#include "common/sensor/limits.h"
#include "common/time/clock.h"
#include "fusion-server/nats/frame_desk.h"
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

/// As many people as a cell may have, each with all that fusion knows of a joint.
std::string largest_frame() {
  Snapshot made;
  made.sequence = 7;
  made.instant = SystemClock().now();
  constexpr std::size_t kSensors = 16;
  for (std::size_t i = 0; i < kSensors; ++i)
    made.sensors.push_back(SensorId::parse("camera-" + std::to_string(i)).value());
  ShareTally everybody;
  for (std::size_t i = 0; i < kSensors; ++i) everybody.add(std::uint64_t{1} << i, 1.0);
  made.bodies.resize(kMaxBodies);
  for (std::size_t i = 0; i < kMaxBodies; ++i) {
    FusedBody& body = made.bodies[i];
    body.id = PersonId{i + 1};
    body.slot = i;
    body.motion.emplace();
    for (std::size_t j = 0; j < kJointCount; ++j) {
      Joint& joint = body.skeleton.joints[j];
      joint.position = Eigen::Vector3d(1.0 / 3.0, 2.0 / 3.0, 4.0 / 3.0);
      joint.orientation = Eigen::Quaterniond(0.5, 0.5, 0.5, 0.5);
      joint.state = JointState::Tracked;
      body.variance[j] = 1.0 / 3e4;
      body.contributors[j] = (1U << kSensors) - 1;
      body.shares[j] = everybody.shares();
      (*body.motion)[j].velocity = Eigen::Vector3d(0.1, 0.2, 1.0 / 7.0);
      (*body.motion)[j].variance = 1.0 / 70.0;
    }
  }
  FrameDesk desk;
  desk.show(std::make_shared<const Snapshot>(std::move(made)), SystemClock().now());
  return desk.frame_at("");
}

TEST(AnAnswerOfACell, IsPassedOnIfItIsAFrame) {
  const std::string frame = largest_frame();
  EXPECT_GT(frame.size(), 350'000U);
  // Half of what is read, so that there is room for more.
  EXPECT_LT(frame.size(), 2'000'000U);
  const auto answered = frame_answered("b", frame);
  ASSERT_TRUE(answered) << to_string(answered.error());
  EXPECT_EQ(*answered, frame);
}

TEST(AnAnswerOfACell, ThatIsNonsenseIsNoAnswer) {
  const std::string deep = R"({"sequence": )" + std::string(100'000, '[');
  const std::string large = R"({"sequence": 1, "more": ")" + std::string(5'000'000, 'x') + R"("})";
  for (const std::string& answer :
       {std::string(), std::string("nonsense"), std::string("[]"), std::string("{}"),
        std::string(R"({"error": 5})"), std::string(R"({"sequence": 1, "sequence": 2})"), deep,
        large}) {
    const auto answered = frame_answered("b", answer);
    const std::string shown = answer.substr(0, 40);
    ASSERT_FALSE(answered) << shown;
    EXPECT_EQ(answered.error().code, ErrorCode::Unavailable) << shown;
    EXPECT_EQ(answered.error().context, "cell b");
    EXPECT_LT(answered.error().message.size(), kMaxReason + 50) << shown;
  }
}

TEST(AnAnswerOfACell, ThatItHasNoSuchFrameIsToldInItsWords) {
  const auto refused = frame_answered("b", R"({"error": "there is no frame of that time"})");
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::NotFound);
  EXPECT_EQ(refused.error().message, "there is no frame of that time");
  const auto chatty = frame_answered("b", R"({"error": ")" + std::string(100'000, 'x') + "\"}");
  ASSERT_FALSE(chatty);
  EXPECT_EQ(chatty.error().code, ErrorCode::NotFound);
  EXPECT_LT(chatty.error().message.size(), kMaxReason + 10);
}

}  // namespace
}  // namespace chorus::nats
