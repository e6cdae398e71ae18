#include "fusion-server/site/joint_match.h"

#include <gtest/gtest.h>

#include <cmath>

namespace chorus::site {
namespace {

const double kAreaLog = std::log(10.0);

CommonError unsure_by(double place) {
  CommonError error;
  error.covariance.diagonal() << place * place, place * place, 1e-4, 1e-4;
  return error;
}

/// Everybody of `ours` against everybody of `theirs`, standing; 4 cm of noise in each cell.
std::vector<PossiblePair> all_pairs(const std::vector<Eigen::Vector2d>& ours,
                                    const std::vector<Eigen::Vector2d>& theirs,
                                    const CommonError& error) {
  std::vector<PossiblePair> pairs;
  for (std::size_t i = 0; i < ours.size(); ++i) {
    for (std::size_t j = 0; j < theirs.size(); ++j) {
      CommonTerm term{ours[i] - theirs[j], lever_at(error, theirs[j], Eigen::Vector2d::Zero()),
                      2 * 0.04 * 0.04 * Eigen::Matrix2d::Identity()};
      pairs.push_back({i, j, term, kAreaLog});
    }
  }
  return pairs;
}

TEST(JointMatching, LetsACommonErrorCancel) {
  // Three people in a row, 0.6 m apart; the other cell is 0.5 m off, so that the nearest of theirs
  // is the wrong one for two of ours.
  const CommonError error = unsure_by(0.3);
  const std::vector<Eigen::Vector2d> ours{{0, 0}, {0.6, 0}, {1.2, 0.2}};
  std::vector<Eigen::Vector2d> theirs = ours;
  for (auto& each : theirs) each.x() += 0.5;
  const JointMatch match = match_jointly({3, 3}, all_pairs(ours, theirs, error), error);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_GT(match.at(i, i), 0.95) << i;
}

TEST(JointMatching, StatesDoubtWhereOnePersonTellsNothingOfTheError) {
  const CommonError error = unsure_by(0.3);
  const JointMatch match =
      match_jointly({1, 2}, all_pairs({{0.3, 0}}, {{0, 0}, {0.6, 0}}, error), error);
  EXPECT_NEAR(match.at(0, 0), match.at(0, 1), 1e-3);
  EXPECT_LT(match.at(0, 0), 0.5);
}

TEST(JointMatching, LeavesAPersonAloneWhomTheOtherCellDoesNotSee) {
  const CommonError error = unsure_by(0.1);
  const JointMatch match =
      match_jointly({2, 1}, all_pairs({{0, 0}, {2, 0}}, {{0.05, 0}}, error), error);
  EXPECT_GT(match.at(0, 0), 0.95);
  EXPECT_GT(match.none[1], 0.99);
}

TEST(JointMatching, IsDefinedWithoutPeople) {
  const CommonError error = unsure_by(0.1);
  EXPECT_TRUE(match_jointly({0, 0}, {}, error).none.empty());
  const JointMatch match = match_jointly({2, 0}, {}, error);
  EXPECT_DOUBLE_EQ(match.none[0], 1.0);
}

TEST(JointMatching, GivesNobodyTwice) {
  const CommonError error = unsure_by(0.1);
  const JointMatch match =
      match_jointly({2, 1}, all_pairs({{0, 0}, {0.1, 0}}, {{0.05, 0}}, error), error);
  EXPECT_LE(match.at(0, 0) + match.at(1, 0), 1.0 + 1e-9);
}

}  // namespace
}  // namespace chorus::site
