// Suits that are played from a recording.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/record/cell_writer.h"
#include "common/synthetic/simulated_suit.h"
#include "services/sensor/device/inertial/inertial_feed.h"
#include "tests/support/builders.h"
#include "tests/support/matchers.h"
#include "tests/support/temporary_folder.h"

namespace chorus::inertial_device {
namespace {

using chorus::testing::IsOk;
using chorus::testing::kStart;
using chorus::testing::sensor_id;
using std::chrono::milliseconds;

synthetic::SimulatedSuit quiet_suit() {
  synthetic::SimulatedSuit suit;
  suit.scene.epoch = kStart;
  suit.scene.people = synthetic::make_people({}, 1);
  suit.limbs = synthetic::limbs_of_suit(13);
  suit.errors.noise = 0.0;
  return suit;
}

/// A clock that shows each instant as soon as somebody waits for it.
class EagerClock final : public Clock {
 public:
  [[nodiscard]] Timestamp now() const override { return now_ += milliseconds(1); }

 private:
  mutable Timestamp now_ = kStart + std::chrono::hours(5);
};

void record_suit(const std::filesystem::path& file, int instants) {
  auto writer = record::CellWriter::create(file, {});
  ASSERT_THAT(writer, IsOk());
  const synthetic::SimulatedSuit suit = quiet_suit();
  for (int i = 0; i < instants; ++i) {
    auto document = std::make_shared<resource::OrientationsResource>();
    auto instant =
        synthetic::suit_at(suit, kStart, kStart + milliseconds(10) * i, std::uint64_t(i) + 1);
    document->sequence = std::uint64_t(i) + 1;
    document->captured = instant.captured;
    document->source = "suit";
    document->instants.push_back(std::move(instant));
    ASSERT_THAT(
        writer->write(record::RawOrientations{sensor_id("suit"), document, document->captured, {}}),
        IsOk());
  }
  ASSERT_THAT(writer->close(), IsOk());
}

TEST(ReplayedSuit, GivesEveryInstantAgainWithTimesOfTodayRoundAfterRound) {
  const chorus::testing::TemporaryFolder folder;
  record_suit(folder / "suit.mcap", 30);
  auto feed = open_replayed_suit({(folder / "suit.mcap").string(), sensor_id("worn"), true, 2.0},
                                 {std::make_shared<EagerClock>(), {}});
  ASSERT_THAT(feed, IsOk());
  EXPECT_NEAR((*feed)->rate_hz(), 200.0, 1.0);
  std::stop_source stop;
  std::vector<inertial::InertialFrame> said;
  const auto ended = (*feed)->run(stop.get_token(), [&](inertial::InertialFrame instant) {
    said.push_back(std::move(instant));
    if (said.size() == 45) stop.request_stop();
  });
  ASSERT_THAT(ended, IsOk());
  ASSERT_EQ(said.size(), 45u);
  for (std::size_t i = 1; i < said.size(); ++i) {
    EXPECT_EQ(said[i].sequence, i + 1);
    EXPECT_GT(said[i].captured, said[i - 1].captured) << i;
    EXPECT_EQ(said[i].readings.at(0).captured, said[i].captured);
  }
  EXPECT_EQ(said[1].captured - said[0].captured, milliseconds(5)) << "twice as fast";
  EXPECT_EQ(said[30].readings.size(), 13u);
  EXPECT_LT(said[3].readings[2].inertial_from_sensor->angularDistance(
                *said[33].readings[2].inertial_from_sensor),
            1e-9);
}

TEST(ReplayedSuit, SaysWhatTheRecordingLacks) {
  const chorus::testing::TemporaryFolder folder;
  record_suit(folder / "none.mcap", 0);
  const auto none =
      open_replayed_suit({(folder / "none.mcap").string(), sensor_id("suit"), true, 1.0},
                         {std::make_shared<EagerClock>(), {}});
  ASSERT_FALSE(none);
  EXPECT_THAT(to_string(none.error()), ::testing::HasSubstr("/orientations"));
}

}  // namespace
}  // namespace chorus::inertial_device
