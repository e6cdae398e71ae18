// Worn sensors of a thousand hertz, from the device to who follows them; time is an argument.
#include <gtest/gtest.h>

#include "common/geometry/rotation.h"
#include "common/inertial/orientation_history.h"
#include "common/resource/orientations_resource.h"
#include "services/sensor/sensor_service.h"
#include "tests/support/builders.h"

namespace chorus::sensor_service {
namespace {

using chorus::testing::kStart;

/// Thirteen sensors that turn at rates of their own.
inertial::InertialFrame thirteen(std::uint64_t sequence, Timestamp at) {
  inertial::InertialFrame instant{chorus::testing::sensor_id("suit"), sequence, at, {}, {}};
  for (int i = 0; i < 13; ++i) {
    inertial::InertialReading& one = instant.readings.emplace_back();
    one.sensor = "sensor-" + std::to_string(i);
    one.captured = at;
    one.limb = static_cast<inertial::Limb>(i);
    one.inertial_from_sensor = about_y((0.5 + 0.2 * i) * seconds(at - kStart));
    one.covariance = Eigen::Matrix3d::Identity() * 1e-3;
    one.acceleration = Eigen::Vector3d(0.1 * i, 9.81, -0.2);
    one.rate = Eigen::Vector3d(0.0, 0.5 + 0.2 * i, 0.0);
  }
  return instant;
}

TEST(FastSuit, OfAThousandHertzLoseNothingOnTheirWayToWhoFollows) {
  std::chrono::steady_clock::time_point now{std::chrono::hours(1)};
  std::vector<std::string> served;
  ServiceOptions options;
  options.id = chorus::testing::sensor_id("suit");
  options.device = {"inertial", "a suit", {}, 1000.0};
  options.device.bodies = false;
  options.device.orientations = true;
  options.steady_now = [&] { return now; };
  options.record_orientations = [&](const service::OrientationsPtr& one) {
    served.push_back(resource::write(*one, resource::Format::Json));
  };
  SensorService fast(std::move(options));
  for (int i = 1; i <= 2000; ++i) {
    now += std::chrono::milliseconds(1);
    fast.on_orientations(
        thirteen(static_cast<std::uint64_t>(i), kStart + std::chrono::milliseconds(i)));
  }
  EXPECT_EQ(fast.counters().instants, 2000u);
  EXPECT_EQ(fast.counters().refused, 0u);
  EXPECT_LE(served.size(), 100u) << "fifty documents a second";
  inertial::OrientationHistory history;
  std::uint64_t next = 1;
  for (const std::string& text : served) {
    EXPECT_LT(text.size(), 200'000u);
    auto read = resource::read_orientations(text, resource::Format::Json);
    ASSERT_TRUE(read) << to_string(read.error());
    for (auto& instant : read->instants) {
      ASSERT_EQ(instant.sequence, next++);
      ASSERT_TRUE(history.push(std::move(instant)));
    }
  }
  EXPECT_GE(next, 1980u) << "at most a fiftieth of a second waits";
  for (int i = 1; i < 59; ++i) {
    const Duration after = std::chrono::microseconds(33'333 * i);
    const auto said = history.at(kStart + after);
    ASSERT_EQ(said.size(), 13u) << i;
    for (const auto& one : said) {
      const double rate = 0.5 + 0.2 * std::stoi(one.sensor.substr(7));
      EXPECT_LT(angular_distance(*one.inertial_from_sensor, about_y(rate * seconds(after))), 1e-5);
    }
  }
}

}  // namespace
}  // namespace chorus::sensor_service
