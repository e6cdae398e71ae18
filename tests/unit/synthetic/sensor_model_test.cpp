#include "common/synthetic/sensor_model.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <ctime>
#include <numbers>

#include "common/body/bones.h"
#include "common/body/facing.h"
#include "common/synthetic/gauss_sensor.h"

namespace chorus::synthetic {
namespace {

constexpr Timestamp kStart = from_unix_ns(1'795'000'000'000'000'000);

Scene six_around_one(std::uint64_t seed = 1) {
  WalkerScript script;
  script.seed = seed;
  return Scene{Timestamp{}, make_people(script, 1), ring_places(Ring{})};
}

SimulatedSensor sensor(std::size_t index = 0) {
  return {SensorId::parse("s" + std::to_string(index + 1)).value(), index, {}};
}

std::vector<SensorFrame> frames_of(const Scene& scene, const SimulatedSensor& one, Timestamp begin,
                                   Timestamp end) {
  GaussSensor gauss(scene, one, begin);
  return record(gauss, end);
}

TEST(Ring, EverySensorLooksAtTheCentreFromItsHeight) {
  const Ring ring;
  for (const Eigen::Isometry3d& world_from_sensor : ring_places(ring)) {
    const Eigen::Vector3d centre = world_from_sensor.inverse() * Eigen::Vector3d(0, 0.9, 0);
    EXPECT_NEAR(centre.x(), 0, 1e-12) << "on the optical axis";
    EXPECT_LT(std::abs(std::atan2(centre.y(), centre.z())), deg(1));
    EXPECT_GT((world_from_sensor.linear() * Eigen::Vector3d::UnitY()).y(), 0.9) << "upright";
    EXPECT_NEAR(floor_in_sensor(world_from_sensor)
                    .distance(world_from_sensor.inverse() * Eigen::Vector3d(0.3, 0, -2)),
                0, 1e-12);
    EXPECT_NEAR(floor_in_sensor(world_from_sensor).offset, ring.height, 1e-12);
  }
}

TEST(Observe, IsDeterministicByFrameNumber) {
  const Scene scene = six_around_one();
  const std::uint64_t number = first_frame_from(sensor(), kStart);
  const auto once = observe(scene, sensor(), number).value();
  (void)observe(scene, sensor(), number + 1);
  const auto again = observe(six_around_one(), sensor(), number).value();
  ASSERT_EQ(once.bodies.size(), 1u);
  EXPECT_EQ(once.captured, again.captured);
  for (std::size_t j = 0; j < kJointCount; ++j) {
    EXPECT_EQ(once.bodies[0].skeleton.joints[j].position,
              again.bodies[0].skeleton.joints[j].position);
  }
  const auto other = observe(scene, sensor(1), number).value();
  EXPECT_NE(once.captured, other.captured) << "each sensor has its own phase";
}

TEST(Observe, NoiseHasTheStatedSizeAlongAndAcrossTheRay) {
  const Scene scene = six_around_one();
  const auto frames = frames_of(scene, sensor(), kStart, kStart + std::chrono::seconds(60));
  double along = 0, across = 0;
  int count = 0;
  for (const SensorFrame& frame : frames) {
    const auto exact =
        to_sensor(scene.world_from_sensor[0].inverse(), truth(scene, 0, frame.captured));
    for (const BodyFrame& body : frame.bodies) {
      for (std::size_t j = 0; j < kJointCount; ++j) {
        const Joint& joint = body.skeleton.joints[j];
        if (joint.state != JointState::Tracked) continue;
        const Eigen::Vector3d error = joint.position - exact.joints[j].position;
        const Eigen::Vector3d ray = exact.joints[j].position.normalized();
        along += std::pow(error.dot(ray), 2);
        across += (error - error.dot(ray) * ray).squaredNorm() / 2;
        ++count;
      }
    }
  }
  ASSERT_GT(count, 20'000);
  EXPECT_NEAR(std::sqrt(along / count), 0.025, 0.001);
  EXPECT_NEAR(std::sqrt(across / count), 0.010, 0.0004);
}

TEST(Observe, LabelsAreAnatomicallyRightFromAllSides) {
  const Scene scene = six_around_one();
  int behind = 0;
  for (std::size_t s = 0; s < 6; ++s) {
    for (const auto& frame :
         frames_of(scene, sensor(s), kStart, kStart + std::chrono::seconds(20))) {
      for (const BodyFrame& body : frame.bodies) {
        const auto exact =
            to_sensor(scene.world_from_sensor[s].inverse(), truth(scene, 0, frame.captured));
        const auto facing = facing_angle(body.skeleton);
        const auto true_facing = facing_angle(exact);
        if (!facing || !true_facing) continue;
        behind += std::abs(*facing) > deg(120);
        EXPECT_LT(std::abs(std::remainder(*facing - *true_facing, 2 * std::numbers::pi)), deg(60));
      }
    }
  }
  EXPECT_GT(behind, 300) << "the test must have seen backs";
}

TEST(Sampling, ThirtyHertzWithJitterWithinItsBound) {
  const SimulatedSensor one = sensor();
  const std::uint64_t first = first_frame_from(one, kStart);
  EXPECT_GE(capture_time(one, first), kStart);
  EXPECT_LT(capture_time(one, first) - kStart, std::chrono::milliseconds(38));
  Duration least = std::chrono::hours(1), most{};
  for (std::uint64_t n = first; n < first + 1000; ++n) {
    const Duration step = capture_time(one, n + 1) - capture_time(one, n);
    least = std::min(least, step);
    most = std::max(most, step);
  }
  EXPECT_GT(least, std::chrono::milliseconds(29));
  EXPECT_LT(least, std::chrono::milliseconds(31)) << "jitter is there";
  EXPECT_LT(most, std::chrono::microseconds(37400));
  const double mean = seconds(capture_time(one, first + 1000) - capture_time(one, first)) / 1000;
  EXPECT_NEAR(mean, 1.0 / 30, 1e-5);
}

TEST(Sampling, DropsTheStatedShare) {
  const Scene scene = six_around_one();
  SimulatedSensor lossy = sensor();
  lossy.model.sampling.drop_share = 0.2;
  const auto frames = frames_of(scene, lossy, kStart, kStart + std::chrono::seconds(60));
  EXPECT_NEAR(static_cast<double>(frames.size()) / 1800.0, 0.8, 0.04);
}

Skeleton<SensorSpace> one_joint(const Eigen::Vector3d& where) {
  Skeleton<SensorSpace> body;
  body[JointId::Head].position = where;
  body[JointId::Head].state = JointState::Tracked;
  return body;
}

JointState state_of(const Eigen::Vector3d& where) {
  auto body = one_joint(where);
  limit_view(body, FieldOfView{});
  return body[JointId::Head].state;
}

TEST(LimitView, InsideAtTheEdgeAndOutside) {
  EXPECT_EQ(state_of({0, 0, 2.5}), JointState::Tracked);
  EXPECT_EQ(state_of({2.5 * std::tan(deg(34)), 0, 2.5}), JointState::Tracked);
  EXPECT_EQ(state_of({2.5 * std::tan(deg(36)), 0, 2.5}), JointState::Inferred);
  EXPECT_EQ(state_of({2.5 * std::tan(deg(44)), 0, 2.5}), JointState::NotTracked);
  EXPECT_EQ(state_of({0, 2.5 * std::tan(deg(-31)), 2.5}), JointState::Inferred);
  EXPECT_EQ(state_of({0, 0, 0.4}), JointState::NotTracked);
  EXPECT_EQ(state_of({0, 0, 4.6}), JointState::NotTracked);
  EXPECT_EQ(state_of({0, 0, -2}), JointState::NotTracked) << "behind the sensor";
  EXPECT_EQ(state_of({0, 0, 0}), JointState::NotTracked);
  EXPECT_EQ(state_of({std::nan(""), 0, 2}), JointState::NotTracked);
}

TEST(Floor, IsSeenWithASmallErrorThatDiffersBySensor) {
  const Scene scene = six_around_one();
  for (std::size_t s = 0; s < 6; ++s) {
    const auto frame = observe(scene, sensor(s), first_frame_from(sensor(s), kStart)).value();
    ASSERT_TRUE(frame.floor);
    const Plane exact = floor_in_sensor(scene.world_from_sensor[s]);
    EXPECT_LT(std::acos(std::min(1.0, frame.floor->normal.dot(exact.normal))), deg(1.2));
    EXPECT_NEAR(frame.floor->offset, exact.offset, 0.02);
    EXPECT_NE(frame.floor->offset, exact.offset);
    EXPECT_NEAR(frame.floor->normal.norm(), 1, 1e-9);
  }
}

TEST(Observe, SeveralPeopleAreKeptApartAndNobodyIsFine) {
  WalkerScript script;
  Scene scene{Timestamp{}, make_people(script, 3), ring_places(Ring{})};
  const auto frame = observe(scene, sensor(), first_frame_from(sensor(), kStart)).value();
  for (std::size_t i = 1; i < frame.bodies.size(); ++i) {
    EXPECT_NE(frame.bodies[i].id, frame.bodies[0].id);
  }
  scene.people.clear();
  EXPECT_TRUE(observe(scene, sensor(), 5)->bodies.empty());
  EXPECT_FALSE(observe(scene, sensor(99), 5)) << "no such sensor";
  EXPECT_FALSE(truth(scene, 7, kStart)[JointId::Head].seen());
}

TEST(Speed, SixSensorsRunFarFasterThanRealTime) {
  // The ceiling is generous; chorus-bench reports the value itself.  The test measures CPU time, so
  // that other load does not count.
  const Scene scene = six_around_one();
  const std::clock_t begin = std::clock();
  std::size_t frames = 0;
  for (std::size_t s = 0; s < 6; ++s) {
    frames += frames_of(scene, sensor(s), kStart, kStart + std::chrono::seconds(30)).size();
  }
  const double cpu = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
  EXPECT_NEAR(static_cast<double>(frames), 5400, 12);
  EXPECT_LT(cpu, 30.0 / 5) << "sanitizers and unoptimised builds included";
}

}  // namespace
}  // namespace chorus::synthetic
