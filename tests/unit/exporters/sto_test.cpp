#include "common/exporters/sto.h"

#include <gtest/gtest.h>

#include "common/evaluation/limb_frame.h"
#include "common/geometry/rotation.h"
#include "common/inertial/orientation_table.h"

namespace chorus::exporters {
namespace {

PersonTrack bent_leg() {
  PersonTrack track;
  for (int i = 0; i < 4; ++i) {
    Pose pose;
    const auto put = [&](JointId id, double x, double y, double z) {
      pose.skeleton[id].position = {x, y, z};
      pose.skeleton[id].state = JointState::Tracked;
    };
    put(JointId::HipLeft, 0.1, 0.9, 0.0);
    put(JointId::KneeLeft, 0.1, 0.6, 0.3);
    put(JointId::AnkleLeft, 0.1, 0.2, 0.1 * i);
    track.poses.push_back(pose);
  }
  return track;
}

TEST(StoExport, HoldsTheLimbsThatAreSeenAndIsReadAgain) {
  const PersonTrack track = bent_leg();
  const auto table = sto_of(track, 50.0);
  ASSERT_TRUE(table) << to_string(table.error());
  const auto logs = inertial::parse_orientation_table(*table, "walk.sto");
  ASSERT_TRUE(logs) << to_string(logs.error());
  ASSERT_EQ(logs->size(), 2u);
  EXPECT_EQ((*logs)[1].sensor, "tibia_l_imu");
  EXPECT_NEAR((*logs)[1].rate_hz, 50.0, 1e-3);
  for (std::size_t i = 0; i < track.poses.size(); ++i) {
    const auto limb =
        evaluation::limb_from_joints(track.poses[i].skeleton, inertial::Limb::ShankLeft);
    ASSERT_TRUE(limb);
    EXPECT_LT(angular_distance(*(*logs)[1].readings[i].inertial_from_sensor, limb->world_from_limb),
              1e-6);
  }
}

TEST(StoExport, RefusesNobody) {
  EXPECT_FALSE(sto_of({}, 30.0));
  PersonTrack unseen;
  unseen.poses.resize(3);
  EXPECT_FALSE(sto_of(unseen, 30.0));
}

}  // namespace
}  // namespace chorus::exporters
