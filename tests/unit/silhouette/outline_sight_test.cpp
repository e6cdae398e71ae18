// The outline in a region of interest, against the outline in the whole picture.
#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "common/positioning/outline_sight.h"
#include "tests/support/builders.h"

namespace chorus::positioning {
namespace {

const Intrinsics kSightLens{640, 480, 600.0, 600.0, 319.5, 239.5, {}};

/// A camera 2 m high, 4.5 m before the origin, looking at it.
Eigen::Isometry3d sight_camera() {
  const Eigen::Vector3d place(0.0, 2.0, 4.5);
  const Eigen::Vector3d z = (Eigen::Vector3d(0.0, 0.9, 0.0) - place).normalized();
  const Eigen::Vector3d x = Eigen::Vector3d::UnitY().cross(z).normalized();
  Eigen::Isometry3d out = Eigen::Isometry3d::Identity();
  out.linear() << x, z.cross(x), z;
  out.translation() = place;
  return out;
}

struct MaskedPerson {
  Skeleton<WorldSpace> body = chorus::testing::standing_person();
  suit::SuitPose pose = suit::pose_of(body, Duration{0});
  Eigen::Vector3d hips = body[JointId::SpineBase].position;
  SightCamera camera{sight_camera(), kSightLens, silhouette::usual_shape(1.75)};

  [[nodiscard]] std::shared_ptr<const PictureSight> sight(bool regions) const {
    constexpr double kScale = 0.5;
    cv::Mat mask = cv::Mat::zeros(240, 320, CV_8U);
    // The judge's person is a tenth thicker.
    const auto capsules = silhouette::flat_capsules(body, silhouette::usual_shape(1.75, 1.1),
                                                    camera.world_from_sensor, kSightLens);
    mask.forEach<std::uint8_t>([&](std::uint8_t& cell, const int* at) {
      const Eigen::Vector2d pixel((at[1] + 0.5) / kScale - 0.5, (at[0] + 0.5) / kScale - 0.5);
      for (const auto& capsule : capsules)
        if (silhouette::distance(capsule, pixel) < 0.0) cell = 255;
    });
    SightSettings settings;
    settings.regions = regions;
    return outline_sight(camera, silhouette::evidence_of_mask(mask, kScale), settings);
  }
};

TEST(OutlineSight, SeesTheSameInARegionAsInTheWholePicture) {
  const MaskedPerson person;
  const auto part = person.sight(true);
  const auto whole = person.sight(false);
  // Near, at the edge of the region, beyond it, and where nobody is.
  for (const Eigen::Vector3d& off : {Eigen::Vector3d(0.05, 0, -0.1), Eigen::Vector3d(0.2, 0, 0.1),
                                     Eigen::Vector3d(-0.45, 0, 0.2), Eigen::Vector3d(1.4, 0, -1.0),
                                     Eigen::Vector3d(0, 0, 30.0)}) {
    const ExpectedBody expected{person.pose, 0.0, person.hips + off};
    const auto a = part->outlined(expected);
    const auto b = whole->outlined(expected);
    ASSERT_EQ(a.has_value(), b.has_value()) << off.transpose();
    if (a) {
      EXPECT_LT((a->place - b->place).norm(), 1e-6) << off.transpose();
      EXPECT_NEAR(a->misfit_px, b->misfit_px, 1e-6);
    }
    const auto c = part->searched(expected);
    const auto d = whole->searched(expected);
    ASSERT_EQ(c.has_value(), d.has_value()) << off.transpose();
    if (c) {
      EXPECT_LT((c->place - d->place).norm(), 1e-9) << off.transpose();
    }
  }
}

TEST(OutlineSight, FindsThePersonAgainInTheWholePicture) {
  const MaskedPerson person;
  const Eigen::Vector3d off(-0.45, 0, 0.3);
  const auto seen = person.sight(true)->outlined({person.pose, 0.0, person.hips + off});
  ASSERT_TRUE(seen);
  EXPECT_LT((seen->place - person.hips).norm(), 0.1);
}

}  // namespace
}  // namespace chorus::positioning
