#include "fusion-server/registration/consensus.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/registration/walk_builder.h"

namespace chorus::registration {
namespace {

Eigen::Isometry3d at(int number) { return ring_place(deg(60) * number); }

PairwiseRegistration edge(int target, int source,
                          const Eigen::Isometry3d& off = Eigen::Isometry3d::Identity()) {
  PairwiseRegistration found{sensor(target), sensor(source)};
  found.target_from_source = at(target).inverse() * off * at(source);
  found.rms = 0.02;
  found.pairs = 1000;
  found.inliers = 950;
  return found;
}

Evidence evidence_of(std::vector<PairwiseRegistration> edges,
                     std::vector<Contradiction> contradictions = {}) {
  Evidence evidence{std::move(edges), std::move(contradictions), {}};
  for (int i = 0; i < 5; ++i) {
    evidence.middles[sensor(i)] = at(i).inverse() * Eigen::Vector3d(0, 1, 0);
  }
  return evidence;
}

/// The displacement that results if one sensor has seen another person, 2 m away.
Eigen::Isometry3d elsewhere() { return Eigen::Isometry3d(Eigen::Translation3d(2.0, 0.0, 0.5)); }

std::vector<SensorId> names(const std::vector<Outcast>& outcasts) {
  std::vector<SensorId> all;
  for (const Outcast& each : outcasts) all.push_back(each.sensor);
  return all;
}

TEST(CastOut, LeavesSensorsAloneThatAgree) {
  Evidence evidence = evidence_of({edge(0, 1), edge(0, 2), edge(1, 2), edge(2, 3)});
  EXPECT_TRUE(cast_out(evidence).empty());
  EXPECT_EQ(evidence.edges.size(), 4u);
}

TEST(CastOut, NamesWhomAllOthersContradict) {
  Evidence evidence = evidence_of({edge(0, 1), edge(0, 2), edge(1, 2)},
                                  {{sensor(0), sensor(3)}, {sensor(3), sensor(2)}});
  const auto outcasts = cast_out(evidence);
  EXPECT_EQ(names(outcasts), std::vector{sensor(3)});
  EXPECT_THAT(outcasts[0].reason, testing::HasSubstr("sensor s3 contradicts s0, s2"));
  EXPECT_TRUE(evidence.contradictions.empty());
  EXPECT_EQ(evidence.edges.size(), 3u);
}

TEST(CastOut, NamesWhoFitsOneByChanceAndContradictsTheRest) {
  Evidence evidence = evidence_of({edge(0, 1), edge(0, 2), edge(1, 2), edge(0, 3, elsewhere())},
                                  {{sensor(1), sensor(3)}, {sensor(2), sensor(3)}});
  EXPECT_EQ(names(cast_out(evidence)), std::vector{sensor(3)});
  EXPECT_EQ(evidence.edges.size(), 3u);
}

TEST(CastOut, NamesWhomTrianglesDoNotCloseWith) {
  Evidence evidence = evidence_of({edge(0, 1), edge(0, 2), edge(1, 2), edge(0, 3, elsewhere()),
                                   edge(1, 3), edge(2, 3, elsewhere().inverse())});
  const auto outcasts = cast_out(evidence);
  EXPECT_EQ(names(outcasts), std::vector{sensor(3)});
  EXPECT_THAT(outcasts[0].reason, testing::HasSubstr("m apart"));
}

TEST(CastOut, OfThreeThatDoNotCloseTheWorstFittingGoes) {
  PairwiseRegistration poor = edge(0, 2, elsewhere());
  poor.inliers = 400;
  PairwiseRegistration poorer = edge(1, 2);
  poorer.inliers = 350;
  Evidence evidence = evidence_of({edge(0, 1), poor, poorer});
  EXPECT_EQ(names(cast_out(evidence)), std::vector{sensor(2)});
}

TEST(CastOut, NobodyIsShieldedByAnInnocentOneWhosePairFitsWorst) {
  PairwiseRegistration poor = edge(0, 3);
  poor.rms = 0.06;
  Evidence evidence =
      evidence_of({edge(0, 1), edge(0, 2), edge(1, 2, elsewhere()), std::move(poor)});
  const auto outcasts = cast_out(evidence);
  ASSERT_EQ(outcasts.size(), 1u);
  EXPECT_NE(outcasts[0].sensor, sensor(3));
  EXPECT_NE(outcasts[0].sensor, sensor(0)) << "an edge of its own speaks for it";
}

TEST(CastOut, OfTwoNobodyCanSayWhoIsWrong) {
  Evidence evidence = evidence_of({}, {{sensor(0), sensor(1)}});
  EXPECT_TRUE(cast_out(evidence).empty());
  Evidence none = evidence_of({}, {{sensor(0), sensor(1)}, {sensor(0), sensor(2)}});
  EXPECT_TRUE(cast_out(none).empty());  // no sensors that agree would remain
}

TEST(CastOut, TwoWhoLieAreBothNamed) {
  Evidence evidence = evidence_of({edge(0, 1), edge(0, 2), edge(1, 2)}, {{sensor(0), sensor(3)},
                                                                         {sensor(1), sensor(3)},
                                                                         {sensor(2), sensor(3)},
                                                                         {sensor(0), sensor(4)},
                                                                         {sensor(1), sensor(4)},
                                                                         {sensor(3), sensor(4)}});
  EXPECT_THAT(names(cast_out(evidence)), testing::UnorderedElementsAre(sensor(3), sensor(4)));
}

TEST(CastOut, NamesACopy) {
  PairwiseRegistration same = edge(1, 3);
  same.target_from_source.setIdentity();
  same.rms = 1e-6;
  Evidence evidence = evidence_of({edge(0, 1), same});
  const auto outcasts = cast_out(evidence);
  EXPECT_EQ(names(outcasts), std::vector{sensor(3)});
  EXPECT_THAT(outcasts[0].reason, testing::HasSubstr("reports exactly what s1 reports"));
}

TEST(LoopError, IsThatOfTheMiddleOfTheWalkInAnyOrderOfTheEdges) {
  const Evidence evidence = evidence_of({});
  const Eigen::Isometry3d off(Eigen::Translation3d(0.3, 0.0, 0.0));
  EXPECT_LT(loop_error(edge(0, 1), edge(1, 2), edge(0, 2), evidence), 1e-9);
  EXPECT_LT(loop_error(edge(1, 0), edge(2, 1), edge(2, 0), evidence), 1e-9);
  EXPECT_NEAR(loop_error(edge(0, 1, off), edge(1, 2), edge(2, 0), evidence), 0.3, 1e-9);
  EXPECT_NEAR(loop_error(edge(1, 0, off), edge(1, 2), edge(0, 2), evidence), 0.3, 1e-9);
  const Eigen::Isometry3d turned(Eigen::AngleAxisd(deg(20), Eigen::Vector3d::UnitY()));
  EXPECT_TRUE(std::isinf(loop_error(edge(0, 1, turned), edge(1, 2), edge(2, 0), evidence)));
}

}  // namespace
}  // namespace chorus::registration
