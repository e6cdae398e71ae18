// Who shows a place, and when they stand still.
#include "services/ctl/operate/person_watch.h"

#include <gtest/gtest.h>

namespace chorus::ctl {
namespace {

using Json = nlohmann::json;

Json joint(double x, double z) { return {{"x", x}, {"y", 1.0}, {"z", z}}; }
Json watched_frame(std::vector<Json> bodies) { return {{"bodies", std::move(bodies)}}; }

TEST(Shown, IsOneJointOfTheOnlyPerson) {
  const Json body{{"joints", {{"SpineBase", joint(1, 2)}, {"HandLeft", joint(3, 4)}}}};
  EXPECT_EQ(*place_in(watched_frame({body}), "SpineBase"), Eigen::Vector2d(1, 2));
  EXPECT_EQ(*place_in(watched_frame({body}), "HandLeft"), Eigen::Vector2d(3, 4));
  EXPECT_EQ(place_in(watched_frame({body}), "Head").error().code, ErrorCode::NotFound);
  EXPECT_EQ(place_in(watched_frame({}), "SpineBase").error().code, ErrorCode::NotFound);
  EXPECT_EQ(place_in(watched_frame({body, body}), "SpineBase").error().code, ErrorCode::Conflict);
}

TEST(Shown, FeetAreTheMiddleBetweenThem) {
  const Json body{{"joints",
                   {{"AnkleLeft", joint(0.2, 0.0)},
                    {"FootLeft", joint(0.2, 0.2)},
                    {"AnkleRight", joint(-0.2, 0.0)},
                    {"FootRight", joint(-0.2, 0.2)}}}};
  EXPECT_TRUE(place_in(watched_frame({body}), kFeet)->isApprox(Eigen::Vector2d(0, 0.1)));
}

/// Frames at 10 Hz: the first that tells a place, as a time; negative if none does.
double told_at(Standstill& still, double until, const std::function<double(double)>& x_at,
               double from = 0.0) {
  for (int i = 0; from + 0.1 * i <= until; ++i) {
    const double at = from + 0.1 * i;
    if (still.take({x_at(at), 0.0}, at)) return at;
  }
  return -1.0;
}

TEST(Stands, AfterStandingForSoLong) {
  Standstill still(2.0, {}, 0.5);
  EXPECT_NEAR(told_at(still, 10.0, [](double) { return 1.0; }), 2.0, 0.11);
}

TEST(Stands, NotWhileWalking) {
  Standstill still(2.0, {}, 0.5);
  EXPECT_LT(told_at(still, 10.0, [](double at) { return 0.3 * at; }), 0.0);
}

TEST(Stands, TheWayThereDoesNotCount) {
  Standstill still(2.0, {}, 0.5);
  const auto arrives = [](double at) { return std::min(at, 3.0); };
  const double at = told_at(still, 10.0, arrives);
  EXPECT_NEAR(at, 5.0, 0.2);
}

TEST(Stands, NotWhereTheyStoodBefore) {
  Standstill still(2.0, {Eigen::Vector2d(1.0, 0.0)}, 0.5);
  EXPECT_LT(told_at(still, 5.0, [](double) { return 1.3; }), 0.0);
  EXPECT_NEAR(told_at(
                  still, 10.0, [](double) { return 1.8; }, 5.1),
              7.1, 0.11);
}

TEST(Stands, AnInterruptionBeginsAnew) {
  Standstill still(2.0, {}, 0.5);
  EXPECT_LT(told_at(still, 1.5, [](double) { return 1.0; }), 0.0);
  still.interrupt();
  EXPECT_NEAR(told_at(
                  still, 10.0, [](double) { return 1.0; }, 1.6),
              3.6, 0.11);
}

}  // namespace
}  // namespace chorus::ctl
