#include "common/geometry/ray.h"

#include <array>
#include <vector>

#include <gtest/gtest.h>

#include "common/base/units.h"

namespace chorus {
namespace {

Ray towards(const Eigen::Vector3d& eye, const Eigen::Vector3d& point) {
  return {eye, (point - eye).normalized()};
}

TEST(RayDistance, IsAcrossTheRayAndToTheEyeBehindIt) {
  const Ray ray{{0, 1, 0}, {0, 0, 1}};
  EXPECT_NEAR(distance(ray, {0.3, 1, 5}), 0.3, 1e-12);
  EXPECT_NEAR(distance(ray, {0.3, 1, -0.4}), 0.5, 1e-12);
  EXPECT_TRUE(nearest_on(ray, {0.3, 1, 5}).isApprox(Eigen::Vector3d(0, 1, 5)));
}

TEST(MeetingPoint, IsWhereRaysMeet) {
  const Eigen::Vector3d point(0.2, 1.4, -0.3);
  std::vector<Ray> rays{towards({3, 1, 0}, point), towards({0, 2, 3}, point)};
  EXPECT_LT((meeting_point(rays).value() - point).norm(), 1e-12);
  rays.push_back(towards({-3, 1, -1}, point));
  EXPECT_LT((meeting_point(rays).value() - point).norm(), 1e-12);
}

TEST(MeetingPoint, IsHalfWayBetweenTwoRaysThatPassEachOther) {
  const std::array rays{Ray{{0, 0, 0}, {0, 0, 1}}, Ray{{-2, 0.1, 2}, {1, 0, 0}}};
  EXPECT_TRUE(meeting_point(rays).value().isApprox(Eigen::Vector3d(0, 0.05, 2)));
  EXPECT_NEAR(distance(rays[0], rays[1]).value(), 0.1, 1e-12);
}

TEST(MeetingPoint, NoDepthComesFromOneRayOrFromParallelOnes) {
  EXPECT_FALSE(meeting_point({}));
  EXPECT_FALSE(meeting_point(std::array{Ray{}}));
  const auto apart_by = [](double angle) {
    return std::array{Ray{{0, 0, 0}, {0, 0, 1}},
                      Ray{{1, 0, 0}, {-std::sin(angle), 0, std::cos(angle)}}};
  };
  EXPECT_FALSE(meeting_point(apart_by(0)));
  EXPECT_FALSE(meeting_point(apart_by(deg(4))));
  EXPECT_TRUE(meeting_point(apart_by(deg(6))));
}

TEST(RayDistance, RaysThatMeetBehindAnEyeHaveNone) {
  const Ray away{{0, 0, 0}, {0, 0, 1}};
  EXPECT_FALSE(distance(away, Ray{{-1, 0, -2}, {1, 0, 0}}));
  EXPECT_TRUE(distance(away, Ray{{-1, 0, 2}, {1, 0, 0}}));
}

}  // namespace
}  // namespace chorus
