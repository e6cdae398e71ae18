// Orientation filters on a simulated rigid body: bias, rest, tilt and disturbed fields.
#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "common/geometry/rotation.h"
#include "common/inertial/low_pass.h"
#include "common/inertial/reference_filters.h"
#include "common/inertial/vqf.h"
#include "common/inertial/vqf_offline.h"

namespace chorus::inertial {
namespace {

constexpr double kPeriod = 0.01;
const Eigen::Vector3d kField(0.0, 20.0, -40.0);  // north and down
const Eigen::Vector3d kBias(deg(0.5), deg(-0.3), deg(0.2));

struct Take {
  std::vector<ImuSample> samples;
  std::vector<Eigen::Quaterniond> truth;
};

/// Turns about changing axes at up to 100 deg/s without moving away; at rest before `start` [s].
Take take(double length, double start) {
  Take out;
  Eigen::Quaterniond q = exp_map({0.4, -0.3, 1.2});
  for (double t = 0.0; t < length; t += kPeriod) {
    Eigen::Vector3d rate(1.2 * std::sin(0.9 * t), 1.4 * std::cos(1.3 * t), std::sin(0.5 * t + 1.0));
    if (t < start) rate.setZero();
    q = (q * exp_map(rate * kPeriod)).normalized();
    out.truth.push_back(q);
    out.samples.push_back({rate + kBias, q.conjugate() * Eigen::Vector3d(0, 0, 9.81),
                           Eigen::Vector3d(q.conjugate() * kField)});
  }
  return out;
}

double end_error(const Take& take, Vqf& filter) {
  for (const ImuSample& sample : take.samples) filter.update(sample);
  return angular_distance(filter.state().nine_axis, take.truth.back());
}

TEST(Vqf, FindsOrientationAndBiasInMotion) {
  const Take moved = take(120.0, 0.0);
  Vqf filter(kPeriod);
  EXPECT_LT(end_error(moved, filter), deg(1.0));
  EXPECT_LT((filter.state().bias - kBias).norm(), deg(0.15));
  EXPECT_FALSE(filter.state().field_disturbed);
  EXPECT_FALSE(filter.state().at_rest);
}

TEST(Vqf, FindsTheBiasAtRestWithinSeconds) {
  const Take still = take(6.0, 6.0);
  Vqf filter(kPeriod);
  end_error(still, filter);
  EXPECT_TRUE(filter.state().at_rest);
  EXPECT_LT((filter.state().bias - kBias).norm(), deg(0.05));
}

TEST(Vqf, DoesNotFollowADisturbedField) {
  Take moved = take(120.0, 0.0);
  for (std::size_t i = 9000; i < 11000; ++i)  // twenty seconds beside a magnet
    *moved.samples[i].field += moved.truth[i].conjugate() * Eigen::Vector3d(40.0, 0.0, 0.0);
  moved.samples.resize(11000);
  moved.truth.resize(11000);
  Vqf careful(kPeriod);
  VqfOptions careless_options;
  careless_options.rejects_disturbed_fields = false;
  Vqf careless(kPeriod, careless_options);
  EXPECT_LT(end_error(moved, careful), deg(2.0));
  EXPECT_TRUE(careful.state().field_disturbed);
  EXPECT_GT(end_error(moved, careless), deg(30.0));
}

TEST(Vqf, IgnoresWhatIsNotFinite) {
  Vqf filter(kPeriod);
  filter.update({{NAN, 0, 0}, {0, 0, NAN}, {{NAN, 0, 0}}});
  filter.update({{0, 0, 0}, {0, 0, 0}, {{0, 0, 0}}});
  EXPECT_TRUE(filter.state().nine_axis.coeffs().allFinite());
  EXPECT_TRUE(vqf_offline({}, kPeriod).empty());
}

TEST(VqfOffline, KnowsFromTheStartWhatTheLiveFilterLearns) {
  const Take moved = take(60.0, 0.0);
  const auto found = vqf_offline(moved.samples, kPeriod);
  ASSERT_EQ(found.size(), moved.truth.size());
  double worst = 0.0;
  for (std::size_t i = 500; i < found.size(); ++i)
    worst = std::max(worst, angular_distance(found[i], moved.truth[i]));
  EXPECT_LT(worst, deg(3.0));
}

TEST(ReferenceFilters, ConvergeToTheTruth) {
  const Take moved = take(30.0, 0.0);
  Madgwick madgwick(kPeriod, started_by(moved.samples.front()));
  Mahony mahony(kPeriod, Eigen::Quaterniond::Identity());
  EXPECT_LT(angular_distance(to_enu(madgwick.nwu_from_sensor()), moved.truth.front()), deg(3.0));
  for (const ImuSample& sample : moved.samples) {
    madgwick.update(sample);
    mahony.update(sample);
  }
  EXPECT_LT(angular_distance(to_enu(madgwick.nwu_from_sensor()), moved.truth.back()), deg(4.0));
  EXPECT_LT(angular_distance(to_enu(mahony.nwu_from_sensor()), moved.truth.back()), deg(4.0));
}

TEST(LowPass, StartsWithTheMeanAndKeepsALevel) {
  LowPass<1> filter(low_pass_gains(0.1, kPeriod));
  for (int i = 0; i < 100; ++i) EXPECT_NEAR(filter(Eigen::Matrix<double, 1, 1>(5.0))(0), 5.0, 1e-9);
  double after = 0.0;
  for (int i = 0; i < 100; ++i) after = filter(Eigen::Matrix<double, 1, 1>(7.0))(0);
  EXPECT_NEAR(after, 7.0, 1e-3);
}

}  // namespace
}  // namespace chorus::inertial
