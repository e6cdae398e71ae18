// Suits that are simulated, and suits that are played from a recording.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/record/cell_writer.h"
#include "services/sensor/device/inertial/inertial_feed.h"
#include "services/sensor/device/inertial/simulated_suit.h"
#include "tests/support/builders.h"
#include "tests/support/matchers.h"
#include "tests/support/temporary_folder.h"

namespace chorus::inertial_device {
namespace {

using chorus::testing::IsOk;
using chorus::testing::kStart;
using chorus::testing::sensor_id;
using std::chrono::milliseconds;

SimulatedSuit quiet_suit() {
  SimulatedSuit suit;
  suit.scene.epoch = kStart;
  suit.scene.people = synthetic::make_people({}, 1);
  suit.limbs = limbs_of_suit(13);
  suit.noise = 0.0;
  return suit;
}

/// The largest angle between what a sensor predicts with the true calibration and its limb.
double worst_prediction(const SimulatedSuit& suit, Duration after) {
  const auto calibration = true_calibration(suit, sensor_id("suit"));
  const auto frame = suit_at(suit, kStart, kStart + after, 1);
  double worst = 0.0;
  for (const auto& one : calibration.sensors) {
    const auto reading =
        std::ranges::find(frame.readings, one.sensor, &inertial::InertialReading::sensor);
    EXPECT_TRUE(reading != frame.readings.end() && reading->inertial_from_sensor) << one.sensor;
    if (reading == frame.readings.end() || !reading->inertial_from_sensor) continue;
    SimulatedSuit exact = suit;  // What a sensor that sits straight and faces the world says.
    exact.slips.reset();
    const auto unslipped = suit_at(exact, kStart, kStart + after, 1);
    const auto truth =
        std::ranges::find(unslipped.readings, one.sensor, &inertial::InertialReading::sensor);
    worst =
        std::max(worst, predicted_limb(one, *reading->inertial_from_sensor)
                            .angularDistance(predicted_limb(one, *truth->inertial_from_sensor)));
  }
  return worst;
}

TEST(SimulatedSuit, IsTakenBackToTheLimbsByItsTrueCalibration) {
  const SimulatedSuit suit = quiet_suit();
  const auto calibration = true_calibration(suit, sensor_id("suit"));
  const auto person = synthetic::truth(suit.scene, 0, kStart + milliseconds(700));
  const auto frame = suit_at(suit, kStart, kStart + milliseconds(700), 7);
  ASSERT_EQ(frame.readings.size(), 13u);
  ASSERT_EQ(calibration.sensors[0].limb, inertial::Limb::Pelvis);
  ASSERT_TRUE(frame.readings[0].inertial_from_sensor);
  EXPECT_LT(predicted_limb(calibration.sensors[0], *frame.readings[0].inertial_from_sensor)
                .angularDistance(person[JointId::SpineBase].orientation),
            1e-6);
  EXPECT_THAT(inertial::checked(frame), IsOk());
}

TEST(SimulatedSuit, SlipsWhenItIsTold) {
  SimulatedSuit suit = quiet_suit();
  suit.slips = inertial::Limb::ForearmLeft;
  suit.slips_after = std::chrono::seconds(2);
  EXPECT_LT(worst_prediction(suit, milliseconds(1900)), 1e-6);
  EXPECT_NEAR(worst_prediction(suit, milliseconds(2100)), suit.slips_by, 1e-6);
}

TEST(SimulatedSuit, SaysTheSameOfTheSameSeedOnly) {
  SimulatedSuit suit = quiet_suit();
  suit.noise = 0.03;
  const auto said = [&](std::uint64_t number) {
    return suit_at(suit, kStart, kStart, number).readings[3].inertial_from_sensor->coeffs();
  };
  EXPECT_EQ(said(4), said(4));
  EXPECT_NE(said(4), said(5));
  const auto before = said(4);
  suit.seed = 2;
  EXPECT_NE(said(4), before);
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
  const SimulatedSuit suit = quiet_suit();
  for (int i = 0; i < instants; ++i) {
    auto document = std::make_shared<resource::OrientationsResource>();
    auto instant = suit_at(suit, kStart, kStart + milliseconds(10) * i, std::uint64_t(i) + 1);
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
