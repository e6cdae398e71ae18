// The origin of the world from marks on the floor.
#include "common/alignment/marked_points.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/base/units.h"

namespace chorus::alignment {
namespace {

using Place = Eigen::Vector2d;
using ::testing::HasSubstr;

/// The places of a world whose origin is at (1, -2) and whose front is at `yaw`, in the old world.
Place old_place(const Place& fresh, double yaw) {
  return Place(1.0 + fresh.x() * std::cos(yaw) + fresh.y() * std::sin(yaw),
               -2.0 - fresh.x() * std::sin(yaw) + fresh.y() * std::cos(yaw));
}

std::vector<FloorMark> marks_of(const std::vector<Place>& fresh, double yaw) {
  std::vector<FloorMark> marks;
  for (const Place& place : fresh) marks.push_back({old_place(place, yaw), place});
  return marks;
}

TEST(Marks, TellOriginAndFront) {
  for (const double degrees : {0.0, 35.0, 90.0, -150.0}) {
    const auto found = origin_from_marks(marks_of({{0, 0}, {0, 2}, {1.5, 0.5}}, deg(degrees)));
    ASSERT_TRUE(found) << degrees;
    EXPECT_NEAR(found->origin.x, 1.0, 1e-9);
    EXPECT_NEAR(found->origin.z, -2.0, 1e-9);
    EXPECT_NEAR(to_deg(found->origin.yaw), degrees, 1e-9);
    EXPECT_NEAR(found->off[2], 0.0, 1e-9);
  }
}

TEST(Marks, NeedNotContainTheOrigin) {
  const auto found = origin_from_marks(marks_of({{3, 1}, {-2, 4}}, deg(20)));
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->origin.x, 1.0, 1e-9);
  EXPECT_NEAR(to_deg(found->origin.yaw), 20.0, 1e-9);
}

TEST(Marks, ShareWhatDoesNotFit) {
  auto marks = marks_of({{0, 0}, {0, 2}}, 0.0);
  marks[1].now.y() += 0.06;
  const auto found = origin_from_marks(marks);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->off[0], 0.03, 1e-9);
  EXPECT_NEAR(found->off[1], 0.03, 1e-9);
  EXPECT_NEAR(found->origin.z, -1.97, 1e-9);
}

TEST(Marks, ThatContradictOneAnotherAreRefusedByName) {
  auto marks = marks_of({{0, 0}, {0, 2}, {2, 0}}, 0.0);
  marks[2].now.x() += 0.5;
  const auto found = origin_from_marks(marks);
  ASSERT_FALSE(found);
  EXPECT_EQ(found.error().code, ErrorCode::Conflict);
  EXPECT_THAT(found.error().message, HasSubstr("mark 3 would be"));
  auto two = marks_of({{0, 0}, {0, 2}}, 0.0);
  two[1].now.y() += 0.5;
  EXPECT_THAT(origin_from_marks(two).error().message,
              HasSubstr("they are 2.50 m apart and shall be 2.00 m apart"));
}

TEST(Marks, WithLeftAndRightExchangedAreNamed) {
  auto marks = marks_of({{0, 0}, {0, 2}, {2, 0}}, 0.0);
  for (FloorMark& mark : marks) mark.shall.x() = -mark.shall.x();
  EXPECT_THAT(origin_from_marks(marks).error().message, HasSubstr("left and right exchanged"));
}

TEST(Marks, NearTogetherTellNoDirection) {
  EXPECT_EQ(origin_from_marks(marks_of({{0, 0}}, 0.0)).error().code, ErrorCode::InvalidArgument);
  EXPECT_EQ(origin_from_marks(marks_of({{0, 0}, {0, 0.4}}, 0.0)).error().code,
            ErrorCode::InvalidArgument);
}

TEST(Axes, FirstIsTheOriginSecondIsAhead) {
  const double yaw = deg(60);
  const auto found =
      origin_from_axes(old_place({0, 0}, yaw), old_place({0, 3}, yaw), old_place({1.0, 0.4}, yaw));
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->origin.x, 1.0, 1e-9);
  EXPECT_NEAR(to_deg(found->origin.yaw), 60.0, 1e-9);
  EXPECT_NEAR(found->apart, 3.0, 1e-9);
}

TEST(Axes, TheThirdChecksTheSide) {
  const auto right = origin_from_axes({0, 0}, {0, 3}, Place(-1, 0));
  EXPECT_EQ(right.error().code, ErrorCode::Conflict);
  EXPECT_THAT(right.error().message, HasSubstr("on the right"));
  EXPECT_THAT(origin_from_axes({0, 0}, {0, 3}, Place(0.05, 1)).error().message,
              HasSubstr("on the line"));
  EXPECT_TRUE(origin_from_axes({0, 0}, {0, 3}, std::nullopt));
  EXPECT_EQ(origin_from_axes({0, 0}, {0, 0.3}, std::nullopt).error().code,
            ErrorCode::InvalidArgument);
}

TEST(Places, AreReadFromText) {
  EXPECT_EQ(*read_place("0.5,-2"), Place(0.5, -2));
  EXPECT_EQ(read_mark("1,2=3,4")->now, Place(1, 2));
  EXPECT_EQ(read_mark("1,2=3,4")->shall, Place(3, 4));
  for (const char* wrong : {"", "1", "1,", "1,x", "1,2,3", "1001,0", "nan,0"})
    EXPECT_FALSE(read_place(wrong)) << wrong;
  for (const char* wrong : {"1,2", "1,2=", "1,2=3,4=5,6"}) EXPECT_FALSE(read_mark(wrong)) << wrong;
}

}  // namespace
}  // namespace chorus::alignment
