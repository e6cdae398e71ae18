// Xsens MVN's stream as sensors: one for each limb whose orientation it says.
#include "services/sensor/device/inertial/mxtp_orientations.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/builders.h"
#include "tests/support/matchers.h"
#include "tests/unit/suit/mxtp_bytes.h"

namespace chorus::inertial_device {
namespace {

using chorus::testing::IsOk;
namespace bytes = suit::testing;

/// A person in T-pose; every segment is turned by `turn` about the vertical.
std::string mxtp_pose(double turn, std::uint32_t sample, std::uint32_t character) {
  bytes::Head head;
  head.sample = sample;
  head.character = character;
  const Eigen::Quaterniond q(Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ()));
  bytes::Bytes payload;
  for (std::size_t i = 0; i < bytes::t_pose().size(); ++i) {
    bytes::add(payload, static_cast<std::uint32_t>(i + 1), 4);
    const Eigen::Vector3d place = q * bytes::t_pose()[i];
    for (int axis = 0; axis < 3; ++axis) bytes::add(payload, place[axis]);
    for (const double part : {q.w(), q.x(), q.y(), q.z()}) bytes::add(payload, part);
  }
  const auto out = bytes::datagram(head, payload);
  return {out.begin(), out.end()};
}

TEST(MxtpOrientations, GivesEveryLimbAndFollowsItsTurns) {
  const auto reader = make_mxtp_reader();
  ASSERT_THAT(reader->take(mxtp_pose(0.0, 1, 0), chorus::testing::kStart), IsOk());
  const auto rest = reader->instant(chorus::testing::kStart);
  ASSERT_THAT(reader->take(mxtp_pose(0.5, 2, 0), chorus::testing::kStart), IsOk());
  const auto turned = reader->instant(chorus::testing::kStart);
  ASSERT_TRUE(rest && turned);
  ASSERT_GE(rest->readings.size(), 13u);
  EXPECT_THAT(inertial::checked(*rest), IsOk());
  const Eigen::Quaterniond by(Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitY()));
  for (std::size_t i = 0; i < rest->readings.size(); ++i) {
    ASSERT_EQ(rest->readings[i].limb, turned->readings[i].limb);
    EXPECT_LT((by * *rest->readings[i].inertial_from_sensor)
                  .angularDistance(*turned->readings[i].inertial_from_sensor),
              1e-4)
        << rest->readings[i].sensor;
  }
  EXPECT_FALSE(reader->instant(chorus::testing::kStart)) << "nothing new";
}

TEST(MxtpOrientations, LosesNoneOfAStreamThatIsFasterThanItIsAsked) {
  using std::chrono::milliseconds;
  const auto reader = make_mxtp_reader();
  const Timestamp start = chorus::testing::kStart;
  for (std::uint32_t i = 1; i <= 10; ++i)
    ASSERT_THAT(reader->take(mxtp_pose(0.01 * i, i, 0), start + milliseconds(i)), IsOk());
  for (std::uint64_t i = 1; i <= 10; ++i) {
    const auto one = reader->instant(start + milliseconds(11));
    ASSERT_TRUE(one) << i;
    EXPECT_EQ(one->sequence, i);
    EXPECT_EQ(one->readings[0].captured, start + milliseconds(i));
  }
  EXPECT_FALSE(reader->instant(start + milliseconds(12)));
}

TEST(MxtpOrientations, LeavesOutOtherPeopleAndRefusesNonsense) {
  const auto reader = make_mxtp_reader(1);
  ASSERT_THAT(reader->take(mxtp_pose(0.0, 1, 0), chorus::testing::kStart), IsOk());
  EXPECT_FALSE(reader->instant(chorus::testing::kStart));
  EXPECT_FALSE(reader->take("MXTP02 but no more", chorus::testing::kStart));
  ASSERT_THAT(reader->take(mxtp_pose(0.0, 1, 1), chorus::testing::kStart), IsOk());
  EXPECT_TRUE(reader->instant(chorus::testing::kStart));
}

}  // namespace
}  // namespace chorus::inertial_device
