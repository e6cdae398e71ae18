#include "common/body/stature.h"

#include <gtest/gtest.h>

#include <cmath>

namespace chorus {
namespace {

/// Proportions of Drillis and Contini: shank 0.246, thigh 0.245, hip to shoulder 0.288.
BoneLengthOf bones_of(double stature) {
  BoneLengthOf bones;
  for (const JointId ankle : {JointId::AnkleLeft, JointId::AnkleRight})
    bones[index_of(ankle)] = {0.246 * stature, 0.003};
  for (const JointId knee : {JointId::KneeLeft, JointId::KneeRight})
    bones[index_of(knee)] = {0.245 * stature, 0.003};
  bones[index_of(JointId::SpineMid)] = {0.144 * stature, 0.003};
  bones[index_of(JointId::SpineShoulder)] = {0.144 * stature, 0.003};
  return bones;
}

TEST(Stature, ComesFromLegsAndSpine) {
  const auto stature = stature_of(bones_of(1.8));
  ASSERT_TRUE(stature);
  EXPECT_NEAR(stature->length, 1.8, 1e-9);
  EXPECT_NEAR(stature->sigma, 0.04 * 1.8, 0.001) << "proportions differ by more than lengths";
}

TEST(Stature, OneLegIsEnoughAndTheSpineIsNeeded) {
  BoneLengthOf bones = bones_of(1.6);
  bones[index_of(JointId::AnkleLeft)] = {};
  bones[index_of(JointId::KneeRight)] = {};
  ASSERT_TRUE(stature_of(bones));
  EXPECT_NEAR(stature_of(bones)->length, 1.6, 1e-9);
  bones[index_of(JointId::SpineMid)] = {};
  EXPECT_FALSE(stature_of(bones));
  EXPECT_FALSE(stature_of({}));
}

TEST(Stature, LengthsThatAreHardlyKnownMakeItLessSure) {
  BoneLengthOf bones = bones_of(1.8);
  bones[index_of(JointId::SpineShoulder)].sigma = 0.2;
  EXPECT_NEAR(stature_of(bones)->sigma, std::hypot(0.04 * 1.8, 0.2 / kChainOfStature), 0.001);
}

}  // namespace
}  // namespace chorus
