#include "fusion-server/site/loops.h"

#include <gtest/gtest.h>

#include <map>

#include "common/base/units.h"
#include "common/geometry/rotation.h"

namespace chorus::site {
namespace {

CellId cell(const char* name) { return *SensorId::parse(name); }

/// Cells at the corners of squares: a b c above, d e f below, turned by some angle each.
Eigen::Isometry3d corner(const char* name) {
  const std::string names = "abcdef";
  const std::size_t i = names.find(name[0]);
  Eigen::Isometry3d place = Eigen::Isometry3d::Identity();
  place.linear() = about_y(0.5 * static_cast<double>(i)).toRotationMatrix();
  place.translation() =
      5.0 * Eigen::Vector3d(static_cast<double>(i % 3), 0, static_cast<double>(i / 3));
  return place;
}

PairwiseRegistration link(const char* target, const char* source, double off = 0.0) {
  PairwiseRegistration all;
  all.target = cell(target);
  all.source = cell(source);
  all.target_from_source = corner(target).inverse() * corner(source);
  all.target_from_source.translation().x() += off;
  all.covariance.diagonal() << 1e-6, 1e-6, 1e-6, 4e-4, 4e-4, 4e-4;
  return all;
}

std::vector<PairwiseRegistration> grid(double off_of_e = 0.0) {
  return {link("a", "b"),           link("b", "c"), link("a", "d"), link("c", "f"),
          link("d", "e", off_of_e), link("e", "f"), link("b", "e")};
}

TEST(Loops, ThatFitClose) {
  const auto loops = loops_of(grid());
  EXPECT_EQ(loops.size(), 2U);
  for (const CellLoop& loop : loops) {
    EXPECT_LT(loop.closure, 1e-9);
    EXPECT_GE(loop.cells.size(), 4U);
  }
  EXPECT_FALSE(misfit_of(grid(), {}));
}

TEST(Loops, ThatDoNotCloseNameTheCell) {
  // Cell e was moved by 0.6 m between its walk with d and those with b and f.
  const auto misfit = misfit_of(grid(0.6), {});
  ASSERT_TRUE(misfit);
  EXPECT_GT(misfit->worst.closure, 0.3);
  // One loop alone cannot tell which of its cells it was; those of loops that close are spared.
  EXPECT_FALSE(misfit->alone);
  EXPECT_TRUE(misfit->cell == cell("a") || misfit->cell == cell("d"));
  EXPECT_GT(std::ranges::count(misfit->worst.cells, misfit->cell), 0);
}

TEST(Loops, ThatAreAllOpenNameACellOfAllOfThem) {
  std::vector<PairwiseRegistration> links = grid(0.6);
  links[6] = link("b", "e", -0.8);
  const auto misfit = misfit_of(links, {});
  ASSERT_TRUE(misfit);
  EXPECT_TRUE(misfit->cell == cell("b") || misfit->cell == cell("e"));
}

TEST(Loops, AreAllowedWhatTheirLinksDoNotKnow) {
  std::vector<PairwiseRegistration> links = grid(0.3);
  for (auto& each : links) each.covariance.bottomRightCorner<3, 3>() *= 40.0;
  EXPECT_FALSE(misfit_of(links, {}));
}

TEST(Loops, AreNoneInARowOfCells) {
  EXPECT_TRUE(loops_of({link("a", "b", 3.0), link("b", "c")}).empty());
  EXPECT_TRUE(loops_of({}).empty());
}

}  // namespace
}  // namespace chorus::site
