// Calibration and time alignment on made-up pairs with known mount and heading.
#include "common/evaluation/calibrate.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "common/evaluation/limb_frame.h"
#include "common/evaluation/park.h"
#include "common/evaluation/time_shift.h"
#include "common/geometry/rotation.h"

namespace chorus::evaluation {
namespace {

constexpr double kHeading = 2.1;
const Eigen::Quaterniond kMount = exp_map({0.9, -1.4, 0.6});

Eigen::Quaterniond limb_at(double t) {
  return exp_map({0.8 * std::sin(1.1 * t), 0.9 * std::sin(0.7 * t + 1), 0.7 * std::cos(1.7 * t)});
}

struct Errors {
  double tracker = 0.0, sensor = 0.0;  ///< About each axis [rad]
  double gross = 0.0;                  ///< Share of bursts of half a second anywhere
};

OrientationPairs take(double length, const Errors& errors,
                      Eigen::Quaterniond (*limb)(double) = limb_at) {
  std::mt19937 draw(7);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> any;
  const auto noise = [&](double sigma) {
    return exp_map(sigma * Eigen::Vector3d(normal(draw), normal(draw), normal(draw)));
  };
  OrientationPairs out;
  bool bad = false;
  Eigen::Quaterniond off = Eigen::Quaterniond::Identity();
  for (int i = 0; i < length * 40; ++i) {
    const double t = i / 40.0;
    if (i % 20 == 0) {
      bad = any(draw) < errors.gross;
      off = exp_map(2.0 * Eigen::Vector3d(normal(draw), normal(draw), normal(draw)));
    }
    OrientationPair pair;
    pair.time = t;
    pair.inertial_from_sensor = about_y(-kHeading) * limb(t) * kMount * noise(errors.sensor);
    pair.tracked.world_from_limb = limb(t) * noise(errors.tracker);
    if (bad) pair.tracked.world_from_limb = pair.tracked.world_from_limb * off;
    out.push_back(pair);
  }
  return out;
}

double mount_error(const inertial::SensorCalibration& found) {
  return angular_distance(found.limb_from_sensor, kMount);
}

TEST(Calibrate, FindsHeadingAndMountExactly) {
  const auto fit = calibrate_sensor(take(10, {}), "a", inertial::Limb::ShankLeft);
  ASSERT_TRUE(fit) << to_string(fit.error());
  EXPECT_LT(mount_error(fit->calibration), 1e-5);
  EXPECT_NEAR(wrap_angle(fit->calibration.heading - kHeading), 0.0, 1e-5);
  EXPECT_NEAR(fit->inliers, 1.0, 1e-12);
}

TEST(Calibrate, SurvivesAThirdOfGrossErrors) {
  const OrientationPairs pairs = take(30, {deg(5), deg(2), 0.3});
  const auto fit = fit_calibration(pairs);
  ASSERT_TRUE(fit);
  EXPECT_LT(mount_error(fit->calibration), deg(1.5));
  const auto park = park_calibration(pairs);
  ASSERT_TRUE(park);
  EXPECT_GT(angular_distance(park->limb_from_sensor, kMount), mount_error(fit->calibration));
}

TEST(Calibrate, GoesOnFromAnEarlierOneToTheSamePlace) {
  const OrientationPairs pairs = take(30, {deg(5), deg(2), 0.2});
  CalibrateOptions options;
  const auto whole = fit_calibration(pairs, options);
  const auto first = fit_calibration({pairs.begin(), pairs.begin() + 200}, options);
  ASSERT_TRUE(whole && first);
  options.begin = first->calibration;
  const auto further = fit_calibration(pairs, options);
  ASSERT_TRUE(further);
  EXPECT_LT(
      angular_distance(further->calibration.limb_from_sensor, whole->calibration.limb_from_sensor),
      deg(0.1));
  EXPECT_NEAR(further->inliers, whole->inliers, 0.01);
}

TEST(Calibrate, CountsNoTwistThatIsNotSeen) {
  OrientationPairs pairs = take(20, {deg(3), deg(1), 0.0});
  std::mt19937 draw(3);
  std::uniform_real_distribution<double> any(-3.0, 3.0);
  for (auto& pair : pairs) {  // a straight limb: any twist
    pair.tracked.twist_seen = false;
    pair.tracked.world_from_limb = pair.tracked.world_from_limb * about_y(any(draw));
  }
  const auto fit = fit_calibration(pairs);
  ASSERT_TRUE(fit);
  // The bone in sensor axes is found; the mount about the bone is not.
  const Eigen::Vector3d bone =
      fit->calibration.limb_from_sensor.conjugate() * Eigen::Vector3d::UnitY();
  EXPECT_GT(bone.dot(kMount.conjugate() * Eigen::Vector3d::UnitY()), std::cos(deg(4)));
  EXPECT_GT(fit->calibration.covariance(2, 2), 100 * fit->calibration.covariance(1, 1));
}

TEST(Calibrate, OfALimbThatNeverShowsItsTwistPredictsTheBone) {
  auto pairs = take(12.0, {deg(3.0), deg(2.0), 0.0});
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    pairs[i].tracked.twist_seen = false;  // A forearm whose plane is any.
    pairs[i].tracked.world_from_limb =
        pairs[i].tracked.world_from_limb * about_y(0.7 * static_cast<double>(i));
  }
  const auto fit = calibrate_sensor(pairs, "7", inertial::Limb::ForearmLeft);
  ASSERT_TRUE(fit) << to_string(fit.error());
  EXPECT_LT(to_deg(fit->calibration.prediction_sigma), 10.0);
  const Eigen::Quaterniond limb = limb_at(20.0);
  const Eigen::Quaterniond said =
      predicted_limb(fit->calibration, about_y(-kHeading) * limb * kMount);
  EXPECT_LT(
      to_deg(std::acos((said * Eigen::Vector3d::UnitY()).dot(limb * Eigen::Vector3d::UnitY()))),
      5.0);
}

TEST(Calibrate, RefusesAStillLimbByNameWithWhatToDo) {
  const auto still = [](double) { return exp_map({0.4, 0.1, 0.3}); };
  const auto fit = calibrate_sensor(take(10, {}, still), "DOT-3", inertial::Limb::ShankLeft);
  ASSERT_FALSE(fit);
  EXPECT_NE(fit.error().context.find("left shank (sensor DOT-3)"), std::string::npos);
  EXPECT_NE(fit.error().message.find("left knee"), std::string::npos);
  EXPECT_FALSE(fit_calibration({}));
}

TEST(Park, SolvesEquation11AndRefusesOneAxis) {
  const auto found = park_calibration(take(10, {}));
  ASSERT_TRUE(found);
  EXPECT_LT(angular_distance(found->limb_from_sensor, kMount), 1e-6);
  EXPECT_LT(angular_distance(found->world_from_inertial, about_y(kHeading)), 1e-6);
  const auto hinge = [](double t) { return exp_map({std::sin(t), 0, 0}); };
  EXPECT_FALSE(park_calibration(take(10, {}, hinge)));
  EXPECT_FALSE(park_martin({}));
}

TEST(TimeShift, IsFoundFromRatesAndStatesItsError) {
  OrientationTrack tracked, sensed;
  for (int i = 0; i < 40 * 20; ++i) tracked.push_back({i / 40.0, limb_at(i / 40.0)});
  for (int i = 0; i < 100 * 20; ++i) {
    const double t = i / 100.0;
    sensed.push_back({t - 0.123, about_y(1.0) * limb_at(t) * kMount});
  }
  const SignalPair pair{angular_rates(tracked, 0.025), angular_rates(sensed, 0.025)};
  const auto found = find_time_shift({pair});
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->shift, 0.123, 0.002);
  EXPECT_LT(found->sigma, 0.005);
  EXPECT_GT(found->correlation, 0.99);
  EXPECT_FALSE(find_time_shift({}));
  EXPECT_FALSE(find_time_shift({pair}, {0.1, 0.005, 0.5}));  // at the end of the search
}

Skeleton<WorldSpace> standing(double knee_bend) {
  Skeleton<WorldSpace> body;
  const auto put = [&](JointId id, double x, double y, double z) {
    body[id].position = {x, y, z};
    body[id].state = JointState::Tracked;
  };
  put(JointId::HipLeft, 0.1, 0.9, 0);
  put(JointId::KneeLeft, 0.1, 0.5, 0);
  put(JointId::AnkleLeft, 0.1, 0.5 - 0.4 * std::cos(knee_bend), -0.4 * std::sin(knee_bend));
  put(JointId::ShoulderLeft, 0.2, 1.4, 0);
  put(JointId::ElbowLeft, 0.2, 1.1, 0);
  put(JointId::WristLeft, 0.2, 1.1, 0.3);
  return body;
}

TEST(LimbFrame, SeesTwistOnlyAtABend) {
  const auto bent = limb_from_joints(standing(1.0), inertial::Limb::ShankLeft);
  const auto straight = limb_from_joints(standing(0.05), inertial::Limb::ShankLeft);
  ASSERT_TRUE(bent && straight);
  EXPECT_TRUE(bent->twist_seen);
  EXPECT_FALSE(straight->twist_seen);
  EXPECT_GT(straight->covariance(1, 1), 9.0);
  const auto thigh = limb_from_joints(standing(1.0), inertial::Limb::ThighLeft);
  ASSERT_TRUE(thigh);
  EXPECT_LT(angular_distance(thigh->world_from_limb, bent->world_from_limb), 1.01);
  const auto forearm = limb_from_joints(standing(1.0), inertial::Limb::ForearmLeft);
  ASSERT_TRUE(forearm);
  EXPECT_FALSE(forearm->twist_seen);  // pronation is not in the joints
  EXPECT_FALSE(limb_from_joints(standing(1.0), inertial::Limb::Head));
}

TEST(LimbFrame, RefusesCollinearPoints) {
  EXPECT_FALSE(frame_of_points({0, 0, 0}, {0, 1, 0}, {0, 2, 0}));
  EXPECT_FALSE(frame_of_points({0, 0, 0}, {0, 0, 0}, {1, 0, 0}));
  const auto frame = frame_of_points({0, 0, 0}, {0, 2, 0}, {0, 1, 1});
  ASSERT_TRUE(frame);
  EXPECT_LT(angular_distance(*frame, Eigen::Quaterniond::Identity()), 1e-12);
}

}  // namespace
}  // namespace chorus::evaluation
