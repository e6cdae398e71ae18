#include "fusion-server/registration/transform_graph.h"

#include <gtest/gtest.h>

#include "fusion-server/registration/adjoint.h"
#include "tests/unit/registration/walk_builder.h"

namespace chorus::registration {
namespace {

/// An exact edge between two known places; only its rms is chosen freely.
PairwiseRegistration edge(int target, int source, const std::vector<Eigen::Isometry3d>& places,
                          double rms) {
  PairwiseRegistration between{sensor(target), sensor(source)};
  between.target_from_source = places.at(static_cast<std::size_t>(target)).inverse() *
                               places.at(static_cast<std::size_t>(source));
  between.rms = rms;
  between.pairs = between.inliers = 100;
  between.spread = 1.0;
  between.covariance = 1e-6 * Matrix6::Identity();
  return between;
}

const std::vector<Eigen::Isometry3d> kGraphPlaces{place(0, 0, 0), place(1, 0, 0.3),
                                                  place(2, 1, -0.5), place(3, 1, 2.0)};

TEST(BestChains, ADetourOverGoodEdgesBeatsABadDirectOne) {
  const std::vector edges{edge(0, 1, kGraphPlaces, 0.01), edge(1, 2, kGraphPlaces, 0.01),
                          edge(0, 2, kGraphPlaces, 0.5)};
  const auto chains = best_chains(sensor(0), edges);
  EXPECT_EQ(chains.at(sensor(2)).sensors, (std::vector{sensor(0), sensor(1), sensor(2)}));
  EXPECT_NEAR(chains.at(sensor(2)).error, edge_error(edges[0]) + edge_error(edges[1]), 1e-12);
}

TEST(BestChains, TheDirectEdgeWinsATie) {
  const std::vector edges{edge(0, 1, kGraphPlaces, 0.01), edge(1, 2, kGraphPlaces, 0.01),
                          edge(0, 2, kGraphPlaces, 0.01)};
  EXPECT_EQ(best_chains(sensor(0), edges).at(sensor(2)).sensors.size(), 2u);
}

TEST(BestChains, EdgesAreWalkedBothWaysAndComposeToTheTruth) {
  const std::vector edges{edge(1, 0, kGraphPlaces, 0.01), edge(1, 2, kGraphPlaces, 0.01),
                          edge(3, 2, kGraphPlaces, 0.01)};
  for (int master = 0; master < 4; ++master) {
    const auto chains = best_chains(sensor(master), edges);
    ASSERT_EQ(chains.size(), 4u);
    for (int i = 0; i < 4; ++i) {
      const Eigen::Isometry3d expected = kGraphPlaces[static_cast<std::size_t>(master)].inverse() *
                                         kGraphPlaces[static_cast<std::size_t>(i)];
      const PlaceError off = difference(chains.at(sensor(i)).master_from_sensor, expected);
      EXPECT_LT(off.position, 1e-9);
      EXPECT_LT(off.angle, 1e-6);
    }
  }
}

TEST(BestChains, UnreachableSensorsAreMissingAndTheMasterIsItsOwnChain) {
  const auto chains = best_chains(sensor(0), {edge(2, 3, kGraphPlaces, 0.01)});
  ASSERT_EQ(chains.size(), 1u);
  EXPECT_EQ(chains.at(sensor(0)).sensors, std::vector{sensor(0)});
  EXPECT_EQ(chains.at(sensor(0)).error, 0.0);
}

TEST(BestChains, UncertaintyGrowsWithEveryHop) {
  const std::vector edges{edge(0, 1, kGraphPlaces, 0.01), edge(2, 1, kGraphPlaces, 0.01),
                          edge(2, 3, kGraphPlaces, 0.01)};
  const auto chains = best_chains(sensor(0), edges);
  double last = 0.0;
  for (int i = 1; i < 4; ++i) {
    const double now = chains.at(sensor(i)).covariance.trace();
    EXPECT_GT(now, last);
    last = now;
  }
}

TEST(EdgeError, IsFiniteForAnyEdgeAndFallsWithInliersAndSpread) {
  EXPECT_TRUE(std::isfinite(edge_error({})));
  PairwiseRegistration one = edge(0, 1, kGraphPlaces, 0.02);
  const double before = edge_error(one);
  one.inliers = 1000;
  EXPECT_LT(edge_error(one), before);
  const double many = edge_error(one);
  one.spread = 0.3;
  EXPECT_GT(edge_error(one), many);
}

TEST(EdgeError, IsTheStandardErrorAtTheSensorPlusAFloor) {
  PairwiseRegistration one = edge(0, 1, kGraphPlaces, 0.02);
  one.inliers = 400;
  one.spread = 2.5;  // as wide as the lever arm is long
  EXPECT_NEAR(edge_error(one), 0.002 + 0.02 / 20.0 * std::sqrt(2.0), 1e-12);
}

TEST(BestChains, ALaterBetterWayReplacesAnEarlierOne) {
  // The edge 0-3 is found first and is poor; the chain 0-1-2-3 is longer and better, also for all
  // sensors that are reached through 3.
  const std::vector edges{edge(0, 3, kGraphPlaces, 0.9), edge(0, 1, kGraphPlaces, 0.01),
                          edge(1, 2, kGraphPlaces, 0.01), edge(2, 3, kGraphPlaces, 0.01)};
  const auto chains = best_chains(sensor(0), edges);
  EXPECT_EQ(chains.at(sensor(3)).sensors.size(), 4u);
  EXPECT_NEAR(chains.at(sensor(3)).error, 3 * edge_error(edges[1]), 1e-12);
  std::vector reversed(edges.rbegin(), edges.rend());
  EXPECT_EQ(best_chains(sensor(0), reversed).at(sensor(3)).sensors, chains.at(sensor(3)).sensors);
}

}  // namespace
}  // namespace chorus::registration
