#include "fusion-server/facing/trunk.h"

#include <gtest/gtest.h>

#include "tests/unit/facing/posed_body.h"

namespace chorus::facing {
namespace {

Skeleton<WorldSpace> tilted(double angle) {
  return turned(body_at({1, 0, 2}, 0), Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitX()).matrix());
}

double upright_at(double angle) {
  return upright_share(trunk_of({view_from(1, 0, tilted(angle))}), {});
}

TEST(Trunk, PointsFromTheHipsToTheShouldersAsTheMeanOfTheViews) {
  EXPECT_NEAR((trunk_of({view_from(1, 0, tilted(deg(90)))}) - Eigen::Vector3d::UnitZ()).norm(), 0,
              1e-9);
  const Eigen::Vector3d mean =
      trunk_of({view_from(1, 0, tilted(deg(20))), view_from(2, 0, tilted(deg(-20)))});
  EXPECT_NEAR((mean - Eigen::Vector3d::UnitY()).norm(), 0, 1e-9);
}

TEST(Trunk, IsUprightWhereNobodySeesIt) {
  EXPECT_EQ(trunk_of({}), Eigen::Vector3d::UnitY());
  EXPECT_EQ(trunk_of({view_from(1, 0, {})}), Eigen::Vector3d::UnitY());
}

TEST(Trunk, OfSomebodyWhoBendsIsUprightAndOfSomebodyWhoLiesOrIsUpsideDownIsNot) {
  EXPECT_EQ(upright_at(0), 1.0);
  EXPECT_EQ(upright_at(deg(40)), 1.0);
  EXPECT_EQ(upright_at(deg(-40)), 1.0);
  EXPECT_GT(upright_at(deg(60)), 0.4);
  EXPECT_LT(upright_at(deg(60)), 0.6);
  EXPECT_EQ(upright_at(deg(80)), 0.0);
  EXPECT_EQ(upright_at(deg(-90)), 0.0);
  EXPECT_EQ(upright_at(deg(180)), 0.0);
}

}  // namespace
}  // namespace chorus::facing
