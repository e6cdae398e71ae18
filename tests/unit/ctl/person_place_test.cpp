// The pose of a person who shows the origin of the world.
#include "services/ctl/align/person_place.h"

#include <gtest/gtest.h>

#include "common/base/units.h"

namespace chorus::ctl {
namespace {

using Json = nlohmann::json;

/// A person at (x, z) who faces `yaw`; left relates to front as +x to +z.
Json body(double x, double z, double yaw, double sure = 0.99) {
  const auto at = [&](double left) {
    return Json{{"x", x + left * std::cos(yaw)}, {"y", 1.0}, {"z", z - left * std::sin(yaw)}};
  };
  return {{"sidesConfidence", sure},
          {"joints",
           {{"SpineBase", at(0)},
            {"HipLeft", at(0.1)},
            {"HipRight", at(-0.1)},
            {"ShoulderLeft", at(0.2)},
            {"ShoulderRight", at(-0.2)}}}};
}

Json frame(std::vector<Json> bodies) { return {{"bodies", std::move(bodies)}}; }

TEST(PersonPlace, IsWherePelvisAndFrontAre) {
  for (const double yaw : {0.0, 30.0, 90.0, 179.0, -120.0}) {
    const auto stance = person_place(frame({body(1.5, -2.0, deg(yaw))}));
    ASSERT_TRUE(stance);
    EXPECT_NEAR(stance->x, 1.5, 1e-12);
    EXPECT_NEAR(stance->z, -2.0, 1e-12);
    EXPECT_NEAR(to_deg(stance->yaw), yaw, 1e-9);
  }
}

TEST(PersonPlace, IsOfOnePersonWhoseFrontIsKnown) {
  EXPECT_EQ(person_place(frame({})).error().code, ErrorCode::NotFound);
  EXPECT_EQ(person_place(Json()).error().code, ErrorCode::NotFound);
  EXPECT_EQ(person_place(frame({body(0, 0, 0), body(1, 0, 0)})).error().code, ErrorCode::Conflict);
  EXPECT_EQ(person_place(frame({body(0, 0, 0, 0.6)})).error().code, ErrorCode::Unavailable);
  Json without = body(0, 0, 0);
  without["joints"].erase("HipLeft");
  EXPECT_EQ(person_place(frame({without})).error().code, ErrorCode::NotFound);
}

TEST(Steady, IsTheMeanAlsoAcrossTheTurn) {
  std::vector<alignment::FloorPose> seen;
  for (int i = 0; i < 10; ++i) seen.push_back({0.01 * i, 1.0, deg(i % 2 == 0 ? 178.0 : -178.0)});
  const auto mean = alignment::steady(seen);
  ASSERT_TRUE(mean);
  EXPECT_NEAR(mean->x, 0.045, 1e-12);
  EXPECT_NEAR(std::abs(to_deg(mean->yaw)), 180.0, 1e-9);
}

TEST(Steady, IsNobodyWhoMovesOrTurns) {
  const std::vector<alignment::FloorPose> still(6, alignment::FloorPose{1, 1, 0});
  EXPECT_TRUE(alignment::steady(still));
  EXPECT_EQ(alignment::steady(std::span(still).first(4)).error().code, ErrorCode::NotFound);
  std::vector<alignment::FloorPose> moves = still;
  moves.back().x += 0.2;
  EXPECT_EQ(alignment::steady(moves).error().code, ErrorCode::Conflict);
  std::vector<alignment::FloorPose> turns = still;
  turns.back().yaw += deg(20);
  EXPECT_EQ(alignment::steady(turns).error().code, ErrorCode::Conflict);
}

}  // namespace
}  // namespace chorus::ctl
