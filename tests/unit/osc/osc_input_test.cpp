// What we send by VMC and VRChat's OSC is read again as orientations of the same limbs.
#include <gtest/gtest.h>

#include "common/geometry/rotation.h"
#include "common/inertial/vmc.h"
#include "fusion-server/osc/vmc_encoder.h"
#include "fusion-server/osc/vrchat_encoder.h"
#include "fusion-server/outlet/humanoid.h"
#include "tests/unit/outlet/rig_poses.h"

namespace chorus::vmc {
namespace {

using inertial::Limb;
using outlet::HumanBone;

struct LimbBone {
  Limb limb;
  HumanBone bone;
};
constexpr LimbBone kSame[] = {
    {Limb::Pelvis, HumanBone::Hips},
    {Limb::Head, HumanBone::Head},
    {Limb::UpperArmLeft, HumanBone::LeftUpperArm},
    {Limb::ForearmRight, HumanBone::RightLowerArm},
    {Limb::ThighLeft, HumanBone::LeftUpperLeg},
    {Limb::ShankRight, HumanBone::RightLowerLeg},
    {Limb::FootLeft, HumanBone::LeftFoot},
};

/// The largest angle between what is read and what our rig says, over the limbs that are read.
double worst_limb(inertial::StreamReader& reader, const std::vector<std::vector<char>>& sent,
                  const outlet::Humanoid& rig, int& limbs) {
  for (const auto& datagram : sent)
    EXPECT_TRUE(reader.take({datagram.data(), datagram.size()}, {}));
  const auto frame = reader.instant({});
  if (!frame) return 1e9;
  double worst = 0.0;
  for (const LimbBone& same : kSame)
    for (const auto& reading : frame->readings)
      if (reading.limb == same.limb) {
        ++limbs;
        worst = std::max(
            worst, angular_distance(*reading.inertial_from_sensor, rig[same.bone].world_from_bone));
      }
  return worst;
}

TEST(OscInput, ReadsOurOwnVmcAsTheSameLimbs) {
  const outlet::TrackerBody body = outlet::testing::asymmetric_pose();
  const auto reader = inertial::make_vmc_reader();
  int limbs = 0;
  const double worst = worst_limb(*reader, encode(&body, {}), outlet::humanoid_of(body), limbs);
  EXPECT_LT(worst, 1e-5);
  EXPECT_EQ(limbs, 7);
}

TEST(OscInput, ReadsOurOwnVrchatTrackersAsTheSameLimbs) {
  const outlet::TrackerBody body = outlet::testing::asymmetric_pose();
  const auto reader = inertial::make_vrchat_reader();
  int limbs = 0;
  const double worst = worst_limb(*reader, vrchat::encode(body), outlet::humanoid_of(body), limbs);
  EXPECT_LT(worst, 1e-5);
  EXPECT_EQ(limbs, 5) << "no forearm, no shank";
}

}  // namespace
}  // namespace chorus::vmc
