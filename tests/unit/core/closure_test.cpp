// Loop closure errors of pairs, and what the next best chain would have been.
#include "fusion-server/core/closure.h"

#include <gtest/gtest.h>

#include "tests/unit/core/ring_of_three.h"

namespace chorus::core {
namespace {

using testing::sensor_id;

PairwiseRegistration edge(const Registration& ring, int target, int source, double rms) {
  PairwiseRegistration pair;
  pair.target = sensor_id(name(target));
  pair.source = sensor_id(name(source));
  pair.target_from_source = ring.sensors.at(pair.target).world_from_sensor.inverse() *
                            ring.sensors.at(pair.source).world_from_sensor;
  pair.rms = rms;
  pair.inliers = 100;
  pair.spread = 2.5;
  return pair;
}

/// s1 is the master; the chains of s2 and s3 are direct edges to s1, and there is also an edge
/// s2-s3.
Registration triangle() {
  Registration r = ring();
  r.sensors.at(sensor_id("s1")).chain = {sensor_id("s1")};
  for (const char* own : {"s2", "s3"})
    r.sensors.at(sensor_id(own)).chain = {sensor_id("s1"), sensor_id(own)};
  r.sensors.at(sensor_id("s2")).error = 0.010;
  r.sensors.at(sensor_id("s3")).error = 0.010;
  r.edges = {edge(r, 0, 1, 0.02), edge(r, 0, 2, 0.02), edge(r, 1, 2, 0.03)};
  return r;
}

TEST(Closure, PairsThatAgreeCloseEveryLoop) {
  Registration r = triangle();
  note_closure(r);
  for (const PairwiseRegistration& pair : r.edges) {
    ASSERT_TRUE(pair.loop && pair.apart);
    EXPECT_NEAR(*pair.loop, 0.0, 1e-9);
    EXPECT_NEAR(*pair.apart, 0.0, 1e-9);
  }
}

TEST(Closure, APairThatIsOffShowsInItsLoopAndBesideTheRest) {
  Registration r = triangle();
  r.edges[2].target_from_source.translation().x() += 0.05;
  note_closure(r);
  EXPECT_NEAR(*r.edges[2].apart, 0.05, 1e-9);
  EXPECT_NEAR(*r.edges[0].apart, 0.0, 1e-9);
  for (const PairwiseRegistration& pair : r.edges) EXPECT_NEAR(*pair.loop, 0.05, 1e-9);
}

TEST(Closure, ATurnThatIsOffIsToldAsAnAngle) {
  Registration r = triangle();
  r.edges[2].target_from_source.rotate(Eigen::AngleAxisd(0.02, Eigen::Vector3d::UnitX()));
  note_closure(r);
  for (const PairwiseRegistration& pair : r.edges) EXPECT_NEAR(*pair.loop_turn, 0.02, 1e-9);
  r.edges.pop_back();
  note_closure(r);
  EXPECT_FALSE(r.edges[0].loop_turn) << "there is no loop left";
}

TEST(Closure, ANextBestChainEndsWithAnotherEdge) {
  Registration r = triangle();
  note_closure(r);
  const Extrinsics& third = r.sensors.at(sensor_id("s3"));
  const std::vector<SensorId> through{sensor_id("s1"), sensor_id("s2"), sensor_id("s3")};
  EXPECT_EQ(third.next_chain, through);
  EXPECT_GT(third.next_error, third.error);
  EXPECT_TRUE(r.sensors.at(sensor_id("s1")).next_chain.empty());
}

TEST(Closure, WithoutALoopThereIsNoneToClose) {
  Registration r = triangle();
  r.edges.pop_back();
  note_closure(r);
  EXPECT_FALSE(r.edges[0].loop);
  EXPECT_TRUE(r.sensors.at(sensor_id("s3")).next_chain.empty());
}

}  // namespace
}  // namespace chorus::core
