// Places and clocks of cells from what they saw at once, all cells together.
#include "fusion-server/site/joint_places.h"

#include <limits>

#include <gtest/gtest.h>

#include "common/base/units.h"
#include "common/geometry/error_radius.h"
#include "common/geometry/rotation.h"
#include "fusion-server/site/late_cells.h"

namespace chorus::site {
namespace {

constexpr double kWalkLength = 60.0;  // [s]
constexpr double kFramePeriod = 1.0 / 30.0;
const Timestamp kWalkBegan = from_unix_ns(1'795'246'200'000'000'000);

using Way = Eigen::Vector2d (*)(double time);

Eigen::Vector2d to_and_fro(double time) {
  return {1.4 * std::sin(0.8 * time), 1.5 * std::sin(0.31 * time)};
}
/// Through the overlap from left to right every ten seconds, always along the same line.
Eigen::Vector2d one_way(double time) { return {-6.0 + 1.2 * std::fmod(time, 10.0), 0.3}; }

CellPlace place_of(const char* name, const Eigen::Vector2d& at, double yaw, Duration clock) {
  CellPlace place;
  place.cell = CellId::parse(name).value();
  place.site_from_cell.linear() =
      Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitY()).toRotationMatrix();
  place.site_from_cell.translation() = Eigen::Vector3d(at.x(), 0, at.y());
  place.clock_added = clock;
  return place;
}

CellPlace truth_of_b() { return place_of("b", {5, -1}, deg(70), std::chrono::milliseconds(-150)); }

/// Arms and legs of somebody who walks, in the site: left and right take turns once a second.
Limbs limbs_at(double time) {
  Limbs limbs;
  for (std::size_t i = 0; i < kLimbs; ++i) {
    const double side = i % 2 == 0 ? 1.0 : -1.0;
    limbs[i] = {side * 0.3 * std::sin(6.3 * time), -0.5, side * 0.15};
  }
  return limbs;
}

/// What a cell sees of the way while x is in (from, to); `wrong`: an error that lasts for seconds.
CellPath seen(const CellPlace& cell, Way way, const Eigen::Vector2d& range, double wrong) {
  CellPath path{cell.cell, {}, {}, {}};
  for (double time = 0.0; time < kWalkLength; time += kFramePeriod) {
    const Eigen::Vector2d at = way(time);
    if (at.x() < range.x() || at.x() > range.y()) continue;
    const Eigen::Vector3d off(wrong * std::sin(1.3 * time), 0, wrong * std::cos(0.9 * time));
    path.at.push_back(kWalkBegan + from_seconds(time) - cell.clock_added);
    path.places.push_back(cell.site_from_cell.inverse() * Eigen::Vector3d(at.x(), 0.9, at.y()) +
                          off);
    path.limbs.push_back(limbs_at(time));
    for (Eigen::Vector3d& limb : path.limbs.back())
      limb = cell.site_from_cell.linear().transpose() * limb;
  }
  return path;
}

std::vector<CellPath> both_see_limbs(Way way, double wrong = 0.02) {
  return {seen(place_of("a", {0, 0}, 0.0, {}), way, {-6, 0.8}, 0.0),
          seen(truth_of_b(), way, {-0.8, 6}, wrong)};
}

std::vector<CellPath> both_see(Way way, double wrong = 0.02) {
  std::vector<CellPath> paths = both_see_limbs(way, wrong);
  for (CellPath& path : paths) path.limbs.clear();
  return paths;
}

/// Where the solver might begin: 0.3 m, 4 degrees and 0.1 s off.
std::vector<CellPlace> where_to_begin() {
  return {place_of("a", {0, 0}, 0.0, {}),
          place_of("b", {5.25, -1.15}, deg(74), std::chrono::milliseconds(-50))};
}

TEST(JointPlaces, FindPlaceTurnAndClock) {
  const auto paths = both_see(&to_and_fro);
  const auto found = joint_places(paths, where_to_begin(), 0.3);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->cells[0].site_from_cell.matrix(), where_to_begin()[0].site_from_cell.matrix());
  const CellPlace& b = found->cells[1];
  const Eigen::Isometry3d truth = truth_of_b().site_from_cell;
  EXPECT_LT((b.site_from_cell.translation() - truth.translation()).norm(), 0.04);
  EXPECT_LT(angular_distance(Eigen::Quaterniond(b.site_from_cell.linear()),
                             Eigen::Quaterniond(truth.linear())),
            deg(0.6));
  EXPECT_NEAR(seconds(b.clock_added), -0.150, 0.01);
  EXPECT_LT(radius_on_floor(b.covariance), 0.15);
  EXPECT_GT(radius_on_floor(b.covariance), 0.01);
}

TEST(JointPlaces, KnowThatOneWayTellsNoClockFromAPlace) {
  const auto to_and_back = joint_places(both_see(&to_and_fro), where_to_begin(), 0.3);
  const auto one = joint_places(both_see(&one_way, 0.0), where_to_begin(), 0.3);
  ASSERT_TRUE(to_and_back && one);
  // 0.3 s at 1.2 m/s are 0.36 m along the way.
  EXPECT_GT(std::sqrt(one->cells[1].covariance(3, 3)), 0.2);
  EXPECT_GT(one->cells[1].clock_sigma, std::chrono::milliseconds(200));
  EXPECT_LT(to_and_back->cells[1].clock_sigma, std::chrono::milliseconds(30));
}

TEST(JointPlaces, HaveTheirClocksFromArmsAndLegs) {
  const auto found = joint_places(both_see_limbs(&one_way, 0.05), where_to_begin(), 0.3);
  ASSERT_TRUE(found);
  EXPECT_NEAR(seconds(found->cells[1].clock_added), -0.150, 0.003);
  EXPECT_LT(found->cells[1].clock_sigma, std::chrono::milliseconds(10));
}

TEST(JointPlaces, DoNotBelieveArmsAndLegsWhoseSidesAreExchanged) {
  auto paths = both_see_limbs(&to_and_fro);
  for (Limbs& limbs : paths[1].limbs) {
    for (std::size_t left = 0; left < kLimbs; left += 2) std::swap(limbs[left], limbs[left + 1]);
  }
  const auto found = joint_places(paths, where_to_begin(), 0.3);
  const auto without = joint_places(both_see(&to_and_fro), where_to_begin(), 0.3);
  ASSERT_TRUE(found && without);
  EXPECT_NEAR(seconds(found->cells[1].clock_added), seconds(without->cells[1].clock_added), 0.01);
}

TEST(JointPlaces, DoWithoutLimbsThatAreNotSeen) {
  auto paths = both_see_limbs(&to_and_fro);
  for (Limbs& limbs : paths[1].limbs)
    limbs.fill(Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN()));
  const auto found = joint_places(paths, where_to_begin(), 0.3);
  const auto without = joint_places(both_see(&to_and_fro), where_to_begin(), 0.3);
  ASSERT_TRUE(found && without);
  EXPECT_EQ(found->cells[1].clock_added, without->cells[1].clock_added);
}

TEST(JointPlaces, AreNoneWithoutAnOverlap) {
  std::vector<CellPath> paths = both_see(&to_and_fro);
  for (Timestamp& at : paths[1].at) at += std::chrono::minutes(5);
  EXPECT_FALSE(joint_places(paths, where_to_begin(), 0.3));
  EXPECT_FALSE(joint_places({}, where_to_begin(), 0.3));
  EXPECT_FALSE(joint_places(paths, {where_to_begin()[0]}, 0.3));
  EXPECT_FALSE(joint_places(paths, {}, 0.3));
}

TEST(JointPlaces, GiveEachPairASayOfItsOwn) {
  const auto paths = both_see(&to_and_fro);
  const auto found = joint_places(paths, where_to_begin(), 0.3);
  ASSERT_TRUE(found);
  const auto pairs = pairs_of(paths, *found);
  ASSERT_EQ(pairs.size(), 1U);
  EXPECT_LT(
      (pairs[0].target_from_source.translation() - found->cells[1].site_from_cell.translation())
          .norm(),
      0.01);
  EXPECT_GT(pairs[0].pairs, 50U);
  EXPECT_LT(pairs[0].rms, 0.05);
}

TEST(LateCells, BeginWhereTheirPathFitsAtWhateverClock) {
  const auto paths = both_see(&to_and_fro);
  const auto place = place_beside(paths[1], paths, std::vector{place_of("a", {0, 0}, 0.0, {})});
  ASSERT_TRUE(place);
  EXPECT_EQ(place->cell, truth_of_b().cell);
  const auto found = joint_places(paths, {place_of("a", {0, 0}, 0.0, {}), *place}, 0.3);
  ASSERT_TRUE(found);
  EXPECT_LT(
      (found->cells[1].site_from_cell.translation() - truth_of_b().site_from_cell.translation())
          .norm(),
      0.04);
  EXPECT_NEAR(seconds(place->clock_added), -0.150, 0.030);
}

TEST(LateCells, HaveNoPlaceWhereTheySawSomethingElse) {
  const std::vector placed{place_of("a", {0, 0}, 0.0, {})};
  auto in_a_mirror = both_see(&to_and_fro);
  for (Eigen::Vector3d& place : in_a_mirror[1].places) place.x() = -place.x();
  EXPECT_FALSE(place_beside(in_a_mirror[1], in_a_mirror, placed));
  auto moved = both_see(&to_and_fro);
  for (std::size_t i = moved[1].places.size() / 2; i < moved[1].places.size(); ++i)
    moved[1].places[i].z() += 0.5;
  EXPECT_FALSE(place_beside(moved[1], moved, placed));
  auto hardly = both_see(&to_and_fro);
  hardly[1].at.resize(45);
  hardly[1].places.resize(45);
  EXPECT_FALSE(place_beside(hardly[1], hardly, placed)) << "a second and a half";
}

}  // namespace
}  // namespace chorus::site
