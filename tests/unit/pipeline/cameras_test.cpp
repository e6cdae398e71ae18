// Cameras without depth in the whole pipeline: two to eight of them, at known positions, rays only.
#include <algorithm>
#include <random>

#include <gtest/gtest.h>

#include "common/base/units.h"
#include "fusion-server/pipeline/pipeline.h"
#include "tests/support/builders.h"

namespace chorus::pipeline {
namespace {

using testing::kFrameInterval;
using testing::kStart;

/// One of two people who walk on one circle, opposite each other.
Skeleton<WorldSpace> seen_walker(int person, double t) {
  const double angle = 0.8 * t + std::numbers::pi * person;
  return testing::standing_person({0.9 * std::sin(angle), 0, 0.9 * std::cos(angle)},
                                  angle + deg(90));
}

struct Cell {
  int cameras = 4;
  int people = 1;
  double noise = deg(0.3);
  Duration lone_after =
      std::chrono::hours(1);  ///< from this time on only the first camera sees anybody
};

SensorId camera_id(int i) { return testing::sensor_id("cam" + std::to_string(i)); }

/// Pose of camera `i` on a ring; neighbours are at most 90 deg apart.
Eigen::Isometry3d place_of(const Cell& cell, int i) {
  return testing::ring_sensor(i, std::max(4, cell.cameras), 3.5, 1.5);
}

Registration registration_of(const Cell& cell) {
  Registration registration;
  registration.verdict = Verdict::Good;
  registration.master = camera_id(0);
  for (int i = 0; i < cell.cameras; ++i)
    registration.sensors[camera_id(i)].world_from_sensor = place_of(cell, i);
  return registration;
}

void make_rays(Skeleton<SensorSpace>& body, double sigma, std::mt19937& random) {
  std::normal_distribution<double> normal;
  for (Joint& joint : body.joints) {
    const Eigen::Vector3d off =
        sigma * Eigen::Vector3d(normal(random), normal(random), normal(random));
    joint.position = (joint.position.normalized() + off).normalized();
    joint.measurement = Measurement::Ray;
    joint.orientation.coeffs().setZero();
  }
}

class Pipeline {
 public:
  explicit Pipeline(const Cell& cell) : cell_(cell), registration_(registration_of(cell)) {
    config_.fusion.method = fusion::Method::PointsAndRays;
  }

  Snapshot next() {
    const Timestamp instant = kStart + frame_ * kFrameInterval;
    const int seeing = instant - kStart >= cell_.lone_after ? 1 : cell_.cameras;
    for (int i = 0; i < cell_.cameras; ++i) {
      std::vector<BodyFrame> bodies;
      for (int k = 0; k < (i < seeing ? cell_.people : 0); ++k) {
        BodyFrame body =
            testing::body_seen_from(place_of(cell_, i), seen_walker(k, seconds(instant - kStart)),
                                    instant, static_cast<std::uint64_t>((k + i) % 2 + 1));
        make_rays(body.skeleton, cell_.noise, random_);
        bodies.push_back(std::move(body));
      }
      histories_[camera_id(i)].push(
          testing::sensor_frame(camera_id(i).str(), instant, std::move(bodies)));
    }
    ++frame_;
    Step done = step({instant, instant, static_cast<std::uint64_t>(frame_)}, histories_,
                     registration_, memory_, config_);
    memory_ = std::move(done.memory);
    return std::move(done.snapshot);
  }

  PipelineConfig config_;

 private:
  Cell cell_;
  Registration registration_;
  Histories histories_;
  Memory memory_;
  std::mt19937 random_{7};
  int frame_ = 0;
};

/// Mean joint error against the person nearest to the body [m].
double error_of(const FusedBody& body, const Snapshot& snapshot, int people) {
  double least = 1e9;
  for (int k = 0; k < people; ++k) {
    const auto truth = seen_walker(k, seconds(snapshot.instant - kStart));
    double sum = 0.0;
    for (std::size_t j = 0; j < kJointCount; ++j)
      sum += (body.skeleton.joints[j].position - truth.joints[j].position).norm();
    least = std::min(least, sum / kJointCount);
  }
  return least;
}

TEST(CamerasAlone, TwoToEightGiveAWholeBody) {
  for (const int cameras : {2, 3, 4, 8}) {
    Pipeline pipeline({.cameras = cameras});
    double worst = 0.0;
    for (int i = 0; i < 150; ++i) {
      const Snapshot snapshot = pipeline.next();
      if (i < 3) continue;
      ASSERT_EQ(snapshot.bodies.size(), 1u) << cameras << " cameras, frame " << i;
      EXPECT_EQ(snapshot.bodies[0].id, PersonId{1});
      for (const Joint& joint : snapshot.bodies[0].skeleton.joints) {
        ASSERT_TRUE(joint.seen());
        ASSERT_TRUE(joint.covariance.known());
      }
      worst = std::max(worst, error_of(snapshot.bodies[0], snapshot, 1));
    }
    EXPECT_LT(worst, cameras < 4 ? 0.05 : 0.03) << cameras << " cameras";
  }
}

TEST(CamerasAlone, SeveralPeopleKeepTheirBodiesApart) {
  for (const int cameras : {3, 4, 8}) {
    Pipeline pipeline({.cameras = cameras, .people = 2});
    for (int i = 0; i < 240; ++i) {
      const Snapshot snapshot = pipeline.next();
      if (i < 3) continue;
      ASSERT_EQ(snapshot.bodies.size(), 2u) << cameras << " cameras, frame " << i;
      EXPECT_EQ(snapshot.bodies[0].id, PersonId{1});
      EXPECT_EQ(snapshot.bodies[1].id, PersonId{2});
      for (const FusedBody& body : snapshot.bodies)
        ASSERT_LT(error_of(body, snapshot, 2), 0.05) << cameras << " cameras, frame " << i;
    }
  }
}

TEST(CamerasAlone, SomebodyWhomOneCameraSeesIsHeld) {
  Pipeline pipeline({.cameras = 3, .lone_after = std::chrono::seconds(2)});
  for (int i = 0; i < 120; ++i) {
    const Snapshot snapshot = pipeline.next();
    const Duration alone = snapshot.instant - kStart - std::chrono::seconds(2);
    if (i < 4 || alone > std::chrono::milliseconds(1900)) continue;
    ASSERT_EQ(snapshot.bodies.size(), 1u) << i;
    EXPECT_EQ(snapshot.bodies[0].id, PersonId{1});
    for (const Joint& joint : snapshot.bodies[0].skeleton.joints) {
      if (alone > std::chrono::milliseconds(150) || !joint.seen()) continue;
      EXPECT_LT(joint.covariance.matrix().trace(), 0.1);
    }
  }
}

TEST(CamerasAlone, MakeTheSameBodiesWhateverTheMethod) {
  Pipeline chosen({.cameras = 3});
  Pipeline other({.cameras = 3});
  other.config_.fusion.method = fusion::Method::InverseVariance;
  for (int i = 0; i < 10; ++i) {
    const Snapshot expected = chosen.next();
    const Snapshot found = other.next();
    ASSERT_EQ(found.bodies.size(), expected.bodies.size()) << i;
    if (found.bodies.empty()) continue;
    EXPECT_EQ(found.bodies[0].skeleton[JointId::Neck].position,
              expected.bodies[0].skeleton[JointId::Neck].position);
  }
}

}  // namespace
}  // namespace chorus::pipeline
