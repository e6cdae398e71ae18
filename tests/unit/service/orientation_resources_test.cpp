// Samples travel in batches, and /orientations is served like /frame.
#include "common/service/orientation_resources.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/builders.h"
#include "tests/support/served.h"

namespace chorus::service {
namespace {

using std::chrono::milliseconds;
using testing::kStart;

inertial::InertialFrame instant(std::uint64_t sequence, Duration after) {
  inertial::InertialFrame frame{testing::sensor_id("suit"), sequence, kStart + after, {}, {}};
  inertial::InertialReading& one = frame.readings.emplace_back();
  one.sensor = "pelvis";
  one.captured = frame.captured;
  one.inertial_from_sensor = Eigen::Quaterniond::Identity();
  return frame;
}

/// The documents made of a second of samples at this rate, which come when they are due.
std::vector<OrientationsPtr> second_at(int rate_hz) {
  OrientationBatch batch;
  std::vector<OrientationsPtr> documents;
  for (int i = 0; i < rate_hz; ++i) {
    const Duration at = Duration(std::chrono::seconds(1)) * i / rate_hz;
    if (auto one = batch.add(instant(static_cast<std::uint64_t>(i), at), at))
      documents.push_back(std::move(one));
  }
  return documents;
}

TEST(OrientationBatch, ASlowSourceIsServedAtItsOwnRate) {
  const auto documents = second_at(30);
  ASSERT_EQ(documents.size(), 30u);
  for (const auto& one : documents) EXPECT_EQ(one->instants.size(), 1u);
}

TEST(OrientationBatch, AFastSourceMakesNoMoreThanFiftyDocumentsAndLosesNothing) {
  for (const int rate : {100, 240, 1000}) {
    const auto documents = second_at(rate);
    EXPECT_LE(documents.size(), 50u) << rate;
    std::uint64_t next = 0;
    std::uint64_t number = 0;
    for (const auto& one : documents) {
      EXPECT_EQ(one->sequence, ++number);
      EXPECT_EQ(one->captured, one->instants.back().captured);
      for (const auto& each : one->instants) EXPECT_EQ(each.sequence, next++);
    }
    EXPECT_GE(next + static_cast<std::uint64_t>(rate) / 40, static_cast<std::uint64_t>(rate));
  }
}

TEST(OrientationBatch, ABurstIsNoDocumentBeyondWhatReadersTake) {
  OrientationBatch batch;
  std::size_t most = 0;
  for (std::uint64_t i = 0; i < 1000; ++i) {
    const auto one = batch.add(instant(i, milliseconds(static_cast<int>(i))), Duration{0});
    if (one) most = std::max(most, one->instants.size());
  }
  EXPECT_EQ(most, resource::kMaxInstants);
}

TEST(OrientationBatch, ABurstOfManySensorsIsNoLongerThanReadersTake) {
  OrientationBatch batch;
  std::size_t documents = 0;
  for (std::uint64_t i = 0; i < 300; ++i) {
    inertial::InertialFrame many = instant(i + 1, milliseconds(static_cast<int>(i)));
    inertial::InertialReading full = many.readings.front();
    full.limb = inertial::Limb::UpperArmRight;
    full.covariance = Eigen::Matrix3d::Constant(-0.123456789);
    full.covariance->diagonal().setConstant(0.123456789);
    for (auto* vector : {&full.acceleration, &full.free_acceleration, &full.rate, &full.field})
      *vector = Eigen::Vector3d::Constant(-123.45678);
    full.magnetic = inertial::MagneticState::Undisturbed;
    full.battery = 0.123;
    many.readings.clear();
    for (std::size_t s = 0; s < inertial::kMaxInertialSensors; ++s) {
      full.sensor = std::string(inertial::kMaxSensorName - 2, 'n') + std::to_string(10 + s);
      many.readings.push_back(full);
    }
    const auto one = batch.add(std::move(many), Duration{0});
    if (!one) continue;
    ++documents;
    const auto read = resource::read_orientations(resource::write(*one, resource::Format::Json),
                                                  resource::Format::Json);
    ASSERT_TRUE(read) << to_string(read.error());
  }
  EXPECT_GE(documents, 7u);
}

TEST(OrientationResources, ServeTheLatestAndThoseBeforeIt) {
  OrientationResources resources({"a"}, {std::chrono::seconds(3)});
  http::Router router;
  resources.add_routes(router);
  EXPECT_EQ(testing::get(router, "/orientations").status, 503);
  OrientationBatch batch;
  for (std::uint64_t i = 1; i <= 3; ++i) {
    const Duration at = milliseconds(25) * static_cast<int>(i);
    resources.publish(batch.add(instant(i, at), at));
  }
  EXPECT_THAT(testing::get(router, "/orientations").body, ::testing::HasSubstr("pelvis"));
  EXPECT_EQ(testing::get(router, "/orientations/2").status, 200);
  EXPECT_EQ(testing::get(router, "/orientations/4").status, 404);
}

}  // namespace
}  // namespace chorus::service
