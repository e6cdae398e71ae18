// A body as later instants show it, against the batch solution of the same linear model.
#include "fusion-server/fusion/smoothing.h"

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Dense>

#include "fusion-server/fusion/fuse.h"
#include "fusion-server/fusion/motion_filter.h"
#include "tests/unit/fusion/views.h"

namespace chorus::fusion {
namespace {

using std::chrono::milliseconds;

constexpr JointId kJoint = JointId::Neck;
constexpr std::size_t kAt = index_of(kJoint);
constexpr double kInstant = 0.04;    // [s]
constexpr double kNoise = 1e-4;      // of a measurement [m^2]
constexpr double kSlow = 9e-4;       // what views err by for long [m^2]
constexpr double kRestless = 2.0;    // [m^2 / s^3]
constexpr double kSpeedPrior = 1.0;  // [m^2 / s^2]
const Timestamp kBegin = from_unix_ns(1'790'000'000'000'000'000);

using Matrix = Eigen::MatrixXd;

Eigen::Matrix2d forwards() { return (Eigen::Matrix2d() << 1, kInstant, 0, 1).finished(); }
Eigen::Matrix2d driven() {
  const double t = kInstant;
  return kRestless * (Eigen::Matrix2d() << t * t * t / 3, t * t / 2, t * t / 2, t).finished();
}

/// Bodies of one joint, as a plain Kalman filter gives them along the x axis; NaN: not measured.
std::vector<FusedBody> filtered(const std::vector<double>& measured) {
  std::vector<FusedBody> bodies;
  Eigen::Vector2d mean(measured.front(), 0.0);
  Eigen::Matrix2d covariance = Eigen::Vector2d(kNoise, kSpeedPrior).asDiagonal();
  for (std::size_t i = 0; i < measured.size(); ++i) {
    const bool seen = !std::isnan(measured[i]);
    if (i > 0) {
      mean = forwards() * mean;
      covariance = forwards() * covariance * forwards().transpose() + driven();
      const Eigen::Vector2d gain = covariance.col(0) / (covariance(0, 0) + kNoise);
      if (seen) {
        mean += gain * (measured[i] - mean(0));
        covariance -= (gain * covariance.row(0)).eval();
      }
    }
    FusedBody body;
    Joint& joint = body.skeleton[kJoint];
    joint.state = seen ? JointState::Tracked : JointState::Inferred;
    joint.position = {mean(0), 0.0, 0.0};
    body.variance[kAt] = covariance(0, 0) + kSlow;
    joint.covariance =
        Covariance(Eigen::Matrix3d(body.variance[kAt] * Eigen::Matrix3d::Identity()));
    body.motion.emplace();
    (*body.motion)[kAt] = {{mean(1), 0, 0},
                           covariance(1, 1),
                           covariance(0, 1),
                           kRestless,
                           kRestless,
                           covariance(0, 0),
                           seen};
    bodies.push_back(body);
  }
  return bodies;
}

std::vector<BodyAt> course_of(const std::vector<FusedBody>& bodies, std::size_t from = 0) {
  std::vector<BodyAt> course;
  for (std::size_t i = from; i < bodies.size(); ++i)
    course.push_back({kBegin + from_seconds(kInstant * static_cast<double>(i)), &bodies[i]});
  return course;
}

struct Batch {
  Eigen::VectorXd mean;
  Matrix covariance;
};

/// All positions and velocities at once, from all measurements.
Batch batch(const std::vector<double>& measured) {
  const auto count = static_cast<Eigen::Index>(measured.size());
  Matrix information = Matrix::Zero(2 * count, 2 * count);
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(2 * count);
  information(1, 1) = 1.0 / kSpeedPrior;
  for (Eigen::Index i = 0; i < count; ++i) {
    const double value = measured[static_cast<std::size_t>(i)];
    if (!std::isnan(value)) {
      information(2 * i, 2 * i) += 1.0 / kNoise;
      sum(2 * i) += value / kNoise;
    }
    if (i == 0) continue;
    Matrix link = Matrix::Zero(2, 2 * count);
    link.block<2, 2>(0, 2 * i) = Eigen::Matrix2d::Identity();
    link.block<2, 2>(0, 2 * i - 2) = -forwards();
    information += link.transpose() * driven().inverse() * link;
  }
  const Matrix covariance = information.inverse();
  return {covariance * sum, covariance};
}

std::vector<double> wandering(int count) {
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0.0, std::sqrt(kNoise));
  std::vector<double> all;
  for (int i = 0; i < count; ++i) all.push_back(0.3 * std::sin(0.2 * i) + noise(random));
  return all;
}

void expect_batch(const std::vector<double>& measured) {
  const auto bodies = filtered(measured);
  const Batch exact = batch(measured);
  for (std::size_t i = 0; i < measured.size(); ++i) {
    const FusedBody body = smoothed(course_of(bodies, i));
    const auto at = static_cast<Eigen::Index>(2 * i);
    EXPECT_NEAR(body.skeleton[kJoint].position.x(), exact.mean(at), 1e-9) << i;
    EXPECT_NEAR(body.variance[kAt], exact.covariance(at, at) + kSlow, 1e-9) << i;
  }
}

TEST(Smoothing, AgreesWithTheBatchSolution) { expect_batch(wandering(30)); }

TEST(Smoothing, PlacesWhatNobodySawWhereTheBatchSolutionDoes) {
  std::vector<double> measured = wandering(30);
  for (std::size_t i = 12; i < 18; ++i) measured[i] = std::nan("");
  expect_batch(measured);
}

TEST(Smoothing, LeavesTheNewestAsItIs) {
  const auto bodies = filtered(wandering(5));
  const FusedBody last = smoothed(course_of(bodies, 4));
  EXPECT_EQ(last.skeleton[kJoint].position, bodies[4].skeleton[kJoint].position);
  EXPECT_EQ(last.variance, bodies[4].variance);
}

TEST(Smoothing, LeavesBodiesWithoutMotionAsTheyAre) {
  auto bodies = filtered(wandering(5));
  for (FusedBody& body : bodies) body.motion.reset();
  EXPECT_EQ(smoothed(course_of(bodies)).skeleton[kJoint].position,
            bodies[0].skeleton[kJoint].position);
}

TEST(Smoothing, ExpectsNothingFromWhatIsOnlyExpected) {
  std::vector<double> measured = wandering(20);
  for (std::size_t i = 10; i < 20; ++i) measured[i] = std::nan("");
  const auto bodies = filtered(measured);
  EXPECT_EQ(smoothed(course_of(bodies, 9)).skeleton[kJoint].position,
            bodies[9].skeleton[kJoint].position);
  EXPECT_EQ(smoothed(course_of(bodies, 12)).variance[kAt], bodies[12].variance[kAt]);
}

TEST(Smoothing, DoesNotReachAcrossAGap) {
  auto bodies = filtered(wandering(10));
  bodies[5].skeleton[kJoint] = Joint{};
  auto rest = bodies;
  rest.resize(5);
  EXPECT_EQ(smoothed(course_of(bodies)).skeleton[kJoint].position,
            smoothed(course_of(rest)).skeleton[kJoint].position);
}

/// Everything that the body filter published of somebody who sways, and its smoothed version: how
/// far each sways, of the true amplitude, and how late it is [s].
struct Sway {
  double amplitude = 0.0;
  double late = 0.0;
};

Sway sway_of(const std::vector<double>& places, double amplitude, double frequency) {
  double sine = 0.0;
  double cosine = 0.0;
  const double turn = 2.0 * std::numbers::pi * frequency;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const double phase = turn * static_cast<double>(i) / 30.0;
    sine += places[i] * std::sin(phase);
    cosine += places[i] * std::cos(phase);
  }
  return {2.0 * std::hypot(sine, cosine) / (amplitude * static_cast<double>(places.size())),
          -std::atan2(cosine, sine) / turn};
}

/// Somebody whose neck sways at up to 20 mm/s, through the product's filter.
std::vector<FusedBody> swaying(double amplitude, double frequency) {
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0.0, 0.001);
  Memory memory;
  std::vector<FusedBody> bodies;
  for (int i = 0; i < 600; ++i) {
    const double x = amplitude * std::sin(2.0 * std::numbers::pi * frequency * i / 30.0);
    Person person;
    person.id = {1};
    for (int view = 0; view < 3; ++view)
      person.views.push_back(neck_view(view, {x + noise(random), 1.5, 0}, 1.0));
    const Timestamp at = kBegin + from_seconds(i / 30.0);
    bodies.push_back(memory.fuse({person}, {at, {}}, {}).front());
  }
  return bodies;
}

TEST(Smoothing, KeepsSlowMotionAndItsTime) {
  constexpr double kAmplitude = 0.008;
  constexpr double kFrequency = 0.4;
  const auto bodies = swaying(kAmplitude, kFrequency);
  std::vector<double> now;
  std::vector<double> later;
  for (std::size_t i = 0; i + 15 < bodies.size(); ++i) {
    std::vector<BodyAt> course;
    for (std::size_t k = i; k <= i + 15; ++k)
      course.push_back({kBegin + from_seconds(static_cast<double>(k) / 30.0), &bodies[k]});
    now.push_back(bodies[i].skeleton[kJoint].position.x());
    later.push_back(smoothed(course).skeleton[kJoint].position.x());
  }
  now.resize(525);  // whole periods
  later.resize(525);
  const Sway causal = sway_of(now, kAmplitude, kFrequency);
  const Sway exact = sway_of(later, kAmplitude, kFrequency);
  EXPECT_GT(exact.amplitude, 0.9);
  EXPECT_LT(exact.amplitude, 1.02);
  EXPECT_LT(std::abs(exact.late), 0.006);
  EXPECT_LT(std::abs(exact.late), 0.8 * std::abs(causal.late));
}

}  // namespace
}  // namespace chorus::fusion
