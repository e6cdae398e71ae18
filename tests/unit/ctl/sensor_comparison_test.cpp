// Sensors beside rigid bodies that another tracker sees on them.
#include "services/ctl/align/sensor_comparison.h"

#include <gtest/gtest.h>

#include "common/base/units.h"
#include "common/geometry/rotation.h"
#include "tests/support/builders.h"

namespace chorus::ctl {
namespace {

using testing::sensor_id;

Eigen::Isometry3d reference_from_ours() {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = about_y(deg(70)).toRotationMatrix();
  pose.translation() = Eigen::Vector3d(1, 0.05, 2);
  return pose;
}

Registration three() {
  Registration registration;
  registration.master = sensor_id("s1");
  for (int i = 0; i < 3; ++i)
    registration.sensors[sensor_id("s" + std::to_string(i + 1))].world_from_sensor =
        testing::ring_sensor(i, 3);
  return registration;
}

ReferenceSample seen(const Eigen::Isometry3d& place) {
  const Eigen::Isometry3d pose = reference_from_ours() * place;
  return {0.0, pose.translation(), Eigen::Quaterniond(pose.rotation())};
}

Reference bodies_of(const Registration& registration) {
  Reference reference;
  for (const auto& [sensor, place] : registration.sensors)
    reference.bodies[sensor.str()] = {seen(place.world_from_sensor)};
  reference.bodies["Cap"] = {seen(Eigen::Isometry3d::Identity())};
  return reference;
}

TEST(Sensors, AreComparedAfterTheBestFit) {
  const Registration registration = three();
  const auto marks = sensor_marks(bodies_of(registration), registration);
  EXPECT_EQ(marks.size(), 3u) << "Cap is no sensor";
  const auto fit = ours_from_marks(marks, registration);
  ASSERT_TRUE(fit);
  EXPECT_TRUE(fit->isApprox(reference_from_ours().inverse(), 1e-9));
  for (const auto& each : deviations(marks, registration, *fit, true)) {
    EXPECT_NEAR(each.horizontal, 0.0, 1e-9);
    EXPECT_NEAR(*each.pitch, 0.0, 1e-9);
  }
}

TEST(Sensors, OneThatIsLowerAndLooksHigherIsSaid) {
  Registration registration = three();
  const auto marks = sensor_marks(bodies_of(registration), registration);
  Eigen::Isometry3d& place = registration.sensors[sensor_id("s3")].world_from_sensor;
  place.translation().y() -= 0.03;
  place.rotate(Eigen::AngleAxisd(deg(-2), Eigen::Vector3d::UnitX()));
  const auto fit = by_master(marks, registration);
  ASSERT_TRUE(fit);
  const auto told = deviations(marks, registration, *fit, true);
  EXPECT_NEAR(told[1].vertical, 0.0, 1e-9);
  EXPECT_NEAR(told[2].vertical, -0.03, 1e-9);
  EXPECT_NEAR(to_deg(*told[2].pitch), -2.0, 1e-6);
  EXPECT_FALSE(deviations(marks, registration, *fit, false)[2].pitch) << "axes of the bodies' own";
}

TEST(Sensors, OutliersOfABodyAtRestDoNotCount) {
  const Registration registration = three();
  Reference reference = bodies_of(registration);
  auto& samples = reference.bodies["s2"];
  samples = {samples[0], samples[0], samples[0]};
  samples[1].place.x() += 1.0;
  const auto marks = sensor_marks(reference, registration);
  EXPECT_TRUE(marks.at(sensor_id("s2")).place.isApprox(samples[0].place));
}

TEST(Sensors, OneAloneTellsNoFront) {
  const Registration registration = three();
  Reference reference = bodies_of(registration);
  reference.bodies.erase("s2");
  reference.bodies.erase("s3");
  EXPECT_EQ(ours_from_marks(sensor_marks(reference, registration), registration).error().code,
            ErrorCode::NotFound);
  EXPECT_EQ(ours_from_marks({}, registration).error().code, ErrorCode::NotFound);
}

}  // namespace
}  // namespace chorus::ctl
