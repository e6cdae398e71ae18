#include "common/synthetic/kinect/joint_bias.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "common/body/bones.h"

namespace chorus::synthetic::kinect {
namespace {

const Eigen::Vector3d kJoint(0.3, 0.2, 2.4);
const JointBias kBias = nominal_profile("A").bias;

Eigen::Vector3d bias_of(JointId id, double facing, const JointBias& bias, const BiasKeys& keys,
                        const Eigen::Vector3d& joint = kJoint) {
  return joint_bias(id, joint, facing, bias, harmonics_of(bias, keys));
}

TEST(JointBias, IsZeroWhenSwitchedOff) {
  JointBias none = kBias;
  none.core = none.head_forward = none.hip_radial = none.vertical = 0;
  for (std::size_t i = 0; i < kJointCount; ++i) {
    for (double facing = -3.1; facing < 3.1; facing += 0.3) {
      EXPECT_EQ(bias_of(static_cast<JointId>(i), facing, none, {1, 2}), Eigen::Vector3d::Zero());
    }
  }
}

TEST(JointBias, ChangesSmoothlyAsTheBodyTurnsAllTheWayRound) {
  for (std::size_t i = 0; i < kJointCount; ++i) {
    const auto id = static_cast<JointId>(i);
    for (int angle = -180; angle < 180; ++angle) {
      const double next = angle == 179 ? -180.0 : angle + 1.0;
      const double jump =
          (bias_of(id, deg(angle), kBias, {1, 2}) - bias_of(id, deg(next), kBias, {1, 2})).norm();
      EXPECT_LT(jump, mm(2.5)) << name_of(id) << " at " << angle;
    }
  }
}

TEST(JointBias, HasTheStatedSizeOverManyDraws) {
  JointBias trunk = kBias;
  trunk.hip_radial = 0;
  double squares = 0;
  int count = 0;
  for (std::uint64_t draw = 1; draw <= 300; ++draw) {
    for (const double facing : {0.0, 0.7, 1.5, 2.5}) {
      const auto error = bias_of(JointId::SpineMid, facing, trunk, {draw, draw});
      squares += error.x() * error.x() + error.z() * error.z();
      ++count;
    }
  }
  const double horizontal = std::sqrt(squares / count);
  EXPECT_GT(horizontal, mm(5)) << "Otto Fig. 8: 5 to 10 mm";
  EXPECT_LT(horizontal, mm(10));
}

TEST(JointBias, TheNeckErrsLeastOfAll) {
  JointBias same = kBias;
  same.neck_factor = 1.0;
  const auto full = bias_of(JointId::Neck, 0.7, same, {3, 3});
  EXPECT_NEAR(bias_of(JointId::Neck, 0.7, kBias, {3, 3}).norm(), kBias.neck_factor * full.norm(),
              1e-9);
}

TEST(JointBias, HipsErrWithTheSpineBaseAndTheChestWithTheNeck) {
  JointBias none = kBias;
  none.follow_share = 0;
  double led = 0, free = 0;
  for (std::uint64_t draw = 1; draw <= 100; ++draw) {
    const BiasKeys keys{draw, draw};
    for (const auto& [joint, leads] : {std::pair{JointId::HipLeft, JointId::SpineBase},
                                       {JointId::SpineShoulder, JointId::Neck}}) {
      const double facing = deg(80);
      led += (bias_of(joint, facing, kBias, keys) - bias_of(leads, facing, kBias, keys)).norm();
      free += (bias_of(joint, facing, none, keys) - bias_of(leads, facing, none, keys)).norm();
    }
  }
  EXPECT_NEAR(led / free, 1.0 - kBias.follow_share, 1e-9);
}

TEST(JointBias, TheHeadMovesForwardBeyondFortyFiveDegreesAndTheHipAway) {
  JointBias only = kBias;
  only.core = only.vertical = 0;
  const auto at = [&](JointId id, double facing) {
    return bias_of(id, facing, only, {}, Eigen::Vector3d(0, 0, 2));
  };
  EXPECT_EQ(at(JointId::Head, deg(44)).norm(), 0.0);
  EXPECT_NEAR(at(JointId::Head, deg(90)).norm(), only.head_forward, 1e-9);
  EXPECT_EQ(at(JointId::SpineBase, deg(59)).norm(), 0.0);
  EXPECT_NEAR(at(JointId::SpineBase, deg(90)).z(), only.hip_radial, 1e-9) << "away from the sensor";
  EXPECT_EQ(at(JointId::Neck, deg(90)).norm(), 0.0);
}

TEST(JointBias, BelongsPartlyToThePersonAndIsTheSameForEverySensor) {
  const auto one = bias_of(JointId::Neck, 1.0, kBias, {1, 1});
  EXPECT_EQ(one, bias_of(JointId::Neck, 1.0, kBias, {1, 1}));
  EXPECT_NE(one, bias_of(JointId::Neck, 1.0, kBias, {1, 2}));
  JointBias shared = kBias;
  shared.common_share = 1.0;
  EXPECT_EQ(bias_of(JointId::Neck, 1.0, shared, {1, 1}),
            bias_of(JointId::Neck, 1.0, shared, {1, 2}));
}

TEST(JointBias, NonsenseHasNoBias) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(bias_of(JointId::Neck, nan, kBias, {}), Eigen::Vector3d::Zero());
  EXPECT_EQ(bias_of(JointId::Neck, 0, kBias, {}, {0, 0, 0}), Eigen::Vector3d::Zero());
  EXPECT_EQ(bias_of(JointId::Neck, 0, kBias, {}, {nan, 0, 1}), Eigen::Vector3d::Zero());
}

}  // namespace
}  // namespace chorus::synthetic::kinect
