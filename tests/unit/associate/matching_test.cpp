#include "fusion-server/associate/matching.h"

#include <gtest/gtest.h>

#include "tests/support/builders.h"

namespace chorus::associate {
namespace {

PlacedView of_size(double size, double x) {
  PlacedView placed;
  placed.view.sensor = testing::sensor_id("s1");
  placed.view.skeleton = testing::standing_person();
  for (Joint& joint : placed.view.skeleton.joints)
    joint.position = size * joint.position + Eigen::Vector3d(x, 0, 0);
  placed.core = {x, 1.2, 0};
  return placed;
}

/// Somebody whose build is known and who is expected at x.
Candidate known_at(double size, double x) {
  Candidate out;
  out.predicted = {x, 1.2, 0};
  out.gate = 0.6;
  out.track.admitted = true;
  out.track.usual.add(spans_of(std::vector{of_size(size, x)}, {}), 10.0);
  return out;
}

/// A child and an adult meet; both bodies are about half-way between the places where the two are
/// expected, each a little nearer to the other's place.
TEST(Matching, WhereTwoAreAsNearSizeDecides) {
  std::vector<Candidate> candidates{known_at(0.85, 0.0), known_at(1.15, 0.4)};
  const PlacedView adult = of_size(1.15, 0.19);
  const PlacedView child = of_size(0.85, 0.21);
  EXPECT_TRUE(match({adult, child}, candidates).empty());
  ASSERT_EQ(candidates[0].sights.size(), 1u);
  ASSERT_EQ(candidates[1].sights.size(), 1u);
  EXPECT_EQ(candidates[0].sights[0].core.x(), child.core.x());
  EXPECT_EQ(candidates[1].sights[0].core.x(), adult.core.x());
}

}  // namespace
}  // namespace chorus::associate
