#include "common/characteristics/kind.h"

#include <gmock/gmock.h>

#include "tests/support/matchers.h"
#include "tests/unit/characteristics/turning_person.h"

namespace chorus::characteristics {
namespace {

constexpr double kUsual = mm(15);

/// Three sensors around the person, with equal noise.
struct Cell {
  std::vector<std::vector<SensorFrame>> frames;
  std::vector<PlacedTrack> tracks;

  Cell(double along, double across) {
    TurnSpec spec;
    spec.along = along;
    spec.across = across;
    spec.seconds = 20;
    std::vector<Eigen::Isometry3d> places;
    for (const double yaw : {0.0, deg(90), deg(215)}) {
      const Eigen::Vector3d middle(0, 1.6, kMarkAt);
      places.push_back(chorus::testing::sensor_pose(
          middle - about_y(yaw) * Eigen::Vector3d(0, 0, 2.5), yaw, deg(5)));
      ++spec.seed;
      frames.push_back(record_turn(spec, places.back()));
    }
    for (std::size_t i = 0; i < places.size(); ++i) tracks.push_back({places[i], &frames[i]});
  }
};

TEST(Agreement, TellsErrorsAlongTheLineOfSightFromThoseAcross) {
  const Cell cell(mm(12), mm(4));
  const auto found = agreement_of(cell.tracks);
  ASSERT_TRUE(found);
  EXPECT_NEAR(to_mm(found->along), 12, 1.0);
  EXPECT_NEAR(to_mm(found->across), 4, 0.5);
}

TEST(Agreement, OneSensorAgreesWithNobody) {
  const Cell cell(mm(12), mm(4));
  EXPECT_FALSE(agreement_of({cell.tracks.front()}));
}

TEST(Agreement, SensorsOfTwoPeopleOrSideBySideTellNothing) {
  const Cell cell(mm(12), mm(4));
  std::vector<PlacedTrack> strangers{cell.tracks[0], cell.tracks[1]};
  ASSERT_TRUE(agreement_of(strangers));
  strangers[1].world_from_sensor.translation().x() += 1.0;
  EXPECT_FALSE(agreement_of(strangers));
  EXPECT_FALSE(agreement_of({cell.tracks[0], cell.tracks[0]}));
}

TEST(Agreement, FramesFarApartAreNotInterpolated) {
  Cell cell(mm(12), mm(4));
  for (auto& frames : cell.frames) {
    std::vector<SensorFrame> few;
    for (std::size_t i = 0; i < frames.size(); i += 3) few.push_back(frames[i]);  // 5 Hz
    frames = few;
  }
  EXPECT_FALSE(agreement_of(cell.tracks));
}

Measured measured(const TurnSpec& spec, const std::optional<Mark>& mark = {}) {
  Measured all;
  auto found = characterise(record_turn(spec), {mark});
  EXPECT_THAT(found, chorus::testing::IsOk());
  if (found) all.sensors.push_back(std::move(*found));
  return all;
}

TEST(Kind, TellsFusionNothingOfJitterThatIsSmallerThanErrorsThatLast) {
  TurnSpec spec;
  spec.along = spec.across = mm(4);
  EXPECT_FALSE(kind_of(measured(spec), kUsual).noise);
  spec.along = mm(30);
  const Kind kind = kind_of(measured(spec), kUsual);
  ASSERT_TRUE(kind.noise);
  EXPECT_NEAR(to_mm(kind.noise->along), 30, 2);
  EXPECT_EQ(kind.noise->across, kUsual);
}

TEST(Kind, TellsRegistrationOnlyADepthBiasThatIsThere) {
  TurnSpec spec;
  EXPECT_FALSE(kind_of(measured(spec, Mark{kMarkAt}), kUsual).depth_bias);
  spec.bias = mm(24);
  const Kind kind = kind_of(measured(spec, Mark{kMarkAt, mm(5)}), kUsual);
  ASSERT_TRUE(kind.depth_bias);
  EXPECT_NEAR(to_mm(kind.depth_bias->bias), 24, 2);
}

TEST(Kind, SensorsThatDifferAreMixed) {
  TurnSpec spec;
  Measured all = measured(spec);
  spec.out = deg(130);
  spec.back = deg(60);
  const Measured other = measured(spec);
  all.sensors.insert(all.sensors.end(), other.sensors.begin(), other.sensors.end());
  const Kind kind = kind_of(all, kUsual);
  EXPECT_EQ(kind.front_rear, FrontRear::Mixed);
  ASSERT_TRUE(kind.exchanged_at);
  EXPECT_NEAR(to_deg(*kind.exchanged_at), 130, 4);
}

}  // namespace
}  // namespace chorus::characteristics
