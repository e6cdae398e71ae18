#include "common/synthetic/depth/depth_profile.h"

#include <gtest/gtest.h>

#include "common/base/units.h"

namespace chorus::synthetic::depth {
namespace {

using kinect::Source;

TEST(DepthProfile, NominalValuesAreThoseOfTheNotes) {
  const DepthProfile profile = nominal_depth_profile();
  EXPECT_DOUBLE_EQ(profile.camera.noise_near, mm(1.2));
  EXPECT_DOUBLE_EQ(profile.camera.noise_square, mm(0.4));
  EXPECT_DOUBLE_EQ(profile.build.girth, 0.15);
  EXPECT_DOUBLE_EQ(profile.delivery.period, kinect::nominal_profile("A").delivery.period);
}

TEST(DepthProfile, ADrawStaysInItsIntervalAndRepeats) {
  const DepthProfile nominal = nominal_depth_profile();
  const DepthProfile once = draw_depth_profile(5);
  EXPECT_EQ(once.camera.noise_near, draw_depth_profile(5).camera.noise_near);
  EXPECT_NE(once.camera.noise_near, draw_depth_profile(6).camera.noise_near);
  EXPECT_NE(once.delivery.latency, nominal.delivery.latency);
  for (std::uint64_t seed = 1; seed < 50; ++seed) {
    const double drawn = draw_depth_profile(seed).camera.noise_near / nominal.camera.noise_near;
    ASSERT_GE(drawn, 0.7);
    ASSERT_LE(drawn, 1.3);
  }
}

TEST(DepthProfile, EachSourceScalesItsOwnParametersOnly) {
  const DepthProfile nominal = nominal_depth_profile();
  const DepthProfile quiet = with_source(nominal, Source::White, 0.0);
  EXPECT_EQ(quiet.camera.noise_near, 0.0);
  EXPECT_EQ(quiet.camera.noise_square, 0.0);
  EXPECT_EQ(quiet.camera.flying_share, nominal.camera.flying_share);
  EXPECT_EQ(quiet.build.girth, nominal.build.girth);
  const DepthProfile stray = with_source(nominal, Source::Gross, 2.0);
  EXPECT_DOUBLE_EQ(stray.camera.flying_share, 2 * nominal.camera.flying_share);
  EXPECT_LE(with_source(nominal, Source::Gross, 100.0).camera.dark_hole_share, 0.9);
  EXPECT_EQ(stray.camera.noise_near, nominal.camera.noise_near);
  EXPECT_EQ(with_source(nominal, Source::Bias, 0.0).build.girth, 0.0);
  EXPECT_EQ(with_source(nominal, Source::Delivery, 0.0).delivery.drop_share, 0.0);
  EXPECT_DOUBLE_EQ(with_source(nominal, Source::Clock, 3.0).clock.offset, 3 * nominal.clock.offset);
}

// As with profile A (kinect/profile_test.cpp), published results were computed with exactly this
// code.
TEST(DepthProfile, IsFrozen) { EXPECT_EQ(frozen_depth_hash(), "1c105da3f830"); }

}  // namespace
}  // namespace chorus::synthetic::depth
