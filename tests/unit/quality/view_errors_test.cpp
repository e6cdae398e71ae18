#include "common/quality/view_errors.h"

#include <array>
#include <optional>
#include <random>

#include <gmock/gmock.h>

namespace chorus::quality {
namespace {

constexpr std::size_t kTheWrist = 6;

/// Views with independent noise, fused with these shares.
ViewErrors fused_views(const std::vector<double>& sigmas, const std::vector<double>& shares,
                       double stated) {
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  ViewErrors errors;
  for (int i = 0; i < 20'000; ++i) {
    std::vector<Eigen::Vector3d> views;
    Eigen::Vector3d fused = Eigen::Vector3d::Zero();
    for (std::size_t s = 0; s < sigmas.size(); ++s) {
      views.push_back(sigmas[s] * Eigen::Vector3d(normal(random), normal(random), normal(random)));
      fused += shares[s] * views[s];
    }
    std::vector<ViewResidual> step;
    for (std::size_t s = 0; s < sigmas.size(); ++s)
      step.push_back({1, kTheWrist, s, views[s] - fused, shares[s], stated * stated});
    errors.add(step);
  }
  return errors;
}

TEST(ViewErrors, FindTheErrorOfTheMeanFromHowItsViewsDisagree) {
  // 1 / sqrt(sum 1 / s^2)
  const auto wrist =
      fused_views({0.01, 0.02, 0.03}, {36.0 / 49, 9.0 / 49, 4.0 / 49}, 0.004).finish()[kTheWrist];
  EXPECT_NEAR(wrist.found, 0.06 / 7.0, 0.0002);
  EXPECT_NEAR(wrist.stated, 0.004, 1e-9);
}

TEST(ViewErrors, OfTwoViewsTheyFindItToo) {
  const auto wrist = fused_views({0.02, 0.02}, {0.5, 0.5}, 0.01).finish()[kTheWrist];
  EXPECT_NEAR(wrist.found, 0.02 / std::sqrt(2.0), 0.0006);
}

/// Four views with errors that are new in each instant and errors that last, of a joint that swings
/// by 0.3 m; the fused joint follows their mean with a gain.  The error of the fused joint, found
/// over true.
double found_over_true(double gain, double fresh, double lasting) {
  constexpr double kStep = 1.0 / 30.0;
  constexpr double kShare = 0.25;
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  const auto drawn = [&] {
    return Eigen::Vector3d(normal(random), normal(random), normal(random));
  };
  std::array<Eigen::Vector3d, 4> slow{drawn(), drawn(), drawn(), drawn()};
  ViewErrors errors;
  std::optional<Eigen::Vector3d> fused;
  double squares = 0.0;
  constexpr int kSteps = 20'000;
  for (int i = 0; i < kSteps; ++i) {
    const Eigen::Vector3d exact(0.3 * std::sin(1.5 * kStep * i), 1.0, 0.0);
    std::array<Eigen::Vector3d, 4> views;
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (std::size_t s = 0; s < views.size(); ++s) {
      slow[s] = 0.995 * slow[s] + std::sqrt(1.0 - 0.995 * 0.995) * drawn();
      views[s] = exact + fresh * drawn() + lasting * slow[s];
      mean += kShare * views[s];
    }
    fused = fused ? Eigen::Vector3d(*fused + gain * (mean - *fused)) : mean;
    squares += (*fused - exact).squaredNorm() / 3.0;
    std::vector<ViewResidual> step;
    for (std::size_t s = 0; s < views.size(); ++s)
      step.push_back({1, kTheWrist, s, views[s] - *fused, kShare, 0.01 * 0.01});
    errors.add(step);
  }
  return errors.finish()[kTheWrist].found / std::sqrt(squares / kSteps);
}

TEST(ViewErrors, CountThatTheFusedJointFollowsItsViewsOverSeveralInstants) {
  EXPECT_NEAR(found_over_true(1.0, 0.02, 0.0), 1.0, 0.05);
  EXPECT_NEAR(found_over_true(0.5, 0.02, 0.0), 1.0, 0.15);
  EXPECT_NEAR(found_over_true(0.5, 0.02, 0.02), 1.0, 0.15);
  EXPECT_NEAR(found_over_true(0.5, 0.005, 0.03), 1.0, 0.15);
}

TEST(ViewErrors, OfOneViewAndOfNoneAreUnknown) {
  EXPECT_TRUE(std::isnan(fused_views({0.02}, {1.0}, 0.01).finish()[kTheWrist].found));
  EXPECT_TRUE(std::isnan(ViewErrors().finish()[0].found));
}

}  // namespace
}  // namespace chorus::quality
