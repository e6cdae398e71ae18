// The laws of the rotation group, and the header's promise that every input is accepted.
#include "common/geometry/rotation.h"

#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "common/base/units.h"
#include "tests/support/matchers.h"

namespace chorus {
namespace {

using testing::RotationNear;
using testing::VectorNear;

constexpr double kRotationNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr int kDraws = 300;
constexpr double kExact = 1e-7;  // formulas without acos: close to double precision

Eigen::Quaterniond random_rotation(std::mt19937& random) {
  std::normal_distribution<double> normal;
  return Eigen::Quaterniond(normal(random), normal(random), normal(random), normal(random))
      .normalized();
}

Eigen::Quaterniond negated(const Eigen::Quaterniond& q) {
  return Eigen::Quaterniond(-q.w(), -q.x(), -q.y(), -q.z());
}

const std::array kNoRotations{
    Eigen::Quaterniond(0, 0, 0, 0), Eigen::Quaterniond(kRotationNaN, 0, 0, 0),
    Eigen::Quaterniond(0, kInfinity, 0, 0),
    Eigen::Quaterniond(kRotationNaN, kRotationNaN, kRotationNaN, kRotationNaN)};

TEST(LogAndExp, AreInverse) {
  std::mt19937 random(1);
  for (int i = 0; i < kDraws; ++i) {
    const Eigen::Quaterniond q = random_rotation(random);
    EXPECT_THAT(exp_map(log_map(q)), RotationNear(q, kExact));
    EXPECT_LE(log_map(q).norm(), std::numbers::pi + kExact);
    EXPECT_THAT(log_map(negated(q)), VectorNear(log_map(q), kExact));
  }
}

TEST(LogAndExp, HoldForTheTiniestAndTheLargestAngle) {
  for (const double angle : {1e-300, 1e-12, 1e-9, 1e-6, 1.0, std::numbers::pi - 1e-9}) {
    const Eigen::Vector3d omega = angle * Eigen::Vector3d(2, -1, 2) / 3.0;
    EXPECT_THAT(log_map(exp_map(omega)), VectorNear(omega, 1e-12 + 1e-9 * angle)) << angle;
    EXPECT_GE(exp_map(omega).w(), 0.0);
  }
  EXPECT_NEAR(log_map(exp_map({0, std::numbers::pi, 0})).norm(), std::numbers::pi, kExact);
  EXPECT_THAT(exp_map({kRotationNaN, 0, 0}), RotationNear(Eigen::Quaterniond::Identity(), kExact));
  EXPECT_THAT(exp_map({kInfinity, 0, 0}), RotationNear(Eigen::Quaterniond::Identity(), kExact));
}

TEST(AngularDistance, IsAMetricThatTurnsDoNotChange) {
  std::mt19937 random(2);
  for (int i = 0; i < kDraws; ++i) {
    const auto a = random_rotation(random);
    const auto b = random_rotation(random);
    const auto c = random_rotation(random);
    EXPECT_NEAR(angular_distance(a, a), 0.0, kExact);
    EXPECT_NEAR(angular_distance(a, negated(a)), 0.0, kExact);
    EXPECT_NEAR(angular_distance(a, b), angular_distance(b, a), kExact);
    EXPECT_LE(angular_distance(a, c), angular_distance(a, b) + angular_distance(b, c) + kExact);
    EXPECT_NEAR(angular_distance(c * a, c * b), angular_distance(a, b), kExact);
    EXPECT_NEAR(angular_distance(a * c, b * c), angular_distance(a, b), kExact);
  }
}

TEST(Lerp, MeetsItsEndsAndHalvesTheWay) {
  std::mt19937 random(3);
  for (int i = 0; i < kDraws; ++i) {
    const auto a = random_rotation(random);
    const auto b = random_rotation(random);
    EXPECT_THAT(lerp(a, b, 0.0), RotationNear(a, kExact));
    EXPECT_THAT(lerp(a, b, 1.0), RotationNear(b, kExact));
    EXPECT_THAT(lerp(a, b, -3.0), RotationNear(a, kExact));
    EXPECT_THAT(lerp(a, b, 0.5), RotationNear(a.slerp(0.5, b), kExact));
    EXPECT_THAT(lerp(a, negated(b), 0.3), RotationNear(lerp(a, b, 0.3), kExact));
    EXPECT_THAT(lerp(a, b, 0.3), RotationNear(lerp(b, a, 0.7), kExact));
  }
}

TEST(WeightedLerp, IgnoresOrderSignAndScaleOfWeights) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> weight(0.1, 1.0);
  for (int i = 0; i < kDraws; ++i) {
    const Eigen::Quaterniond middle = random_rotation(random);
    std::array<Eigen::Quaterniond, 4> turns;
    std::array<double, 4> weights{};
    for (std::size_t k = 0; k < turns.size(); ++k) {
      turns[k] = middle * exp_map(0.5 * log_map(random_rotation(random)) / std::numbers::pi);
      weights[k] = weight(random);
    }
    const auto mean = weighted_lerp(turns, weights);
    std::array shuffled{turns[2], negated(turns[0]), turns[3], negated(turns[1])};
    const std::array scaled{5 * weights[2], 5 * weights[0], 5 * weights[3], 5 * weights[1]};
    EXPECT_THAT(weighted_lerp(shuffled, scaled), RotationNear(mean, kExact));
    EXPECT_LT(angular_distance(mean, middle), 0.5);
  }
}

TEST(WeightedLerp, OfTwoIsLerp) {
  const std::array turns{about_y(0.2), about_y(1.0)};
  EXPECT_THAT(weighted_lerp(turns, std::array{0.75, 0.25}),
              RotationNear(lerp(turns[0], turns[1], 0.25), kExact));
}

TEST(WeightedLerp, SkipsWhatIsNoRotationOrHasNoWeight) {
  const auto good = about_y(1.0);
  const std::array turns{kNoRotations[0], good, kNoRotations[1], about_y(2.0), about_y(3.0)};
  EXPECT_THAT(weighted_lerp(turns, std::array{9.0, 1.0, 9.0, 0.0, kRotationNaN}),
              RotationNear(good, kExact));
  EXPECT_THAT(weighted_lerp(turns, std::array{1.0, -1.0, 1.0, 0.0, kInfinity}),
              RotationNear(Eigen::Quaterniond::Identity(), kExact));
  EXPECT_THAT(weighted_lerp({}, {}), RotationNear(Eigen::Quaterniond::Identity(), kExact));
}

TEST(Totality, NoRotationIsIdentityEverywhere) {
  const Eigen::Quaterniond identity = Eigen::Quaterniond::Identity();
  for (const Eigen::Quaterniond& none : kNoRotations) {
    EXPECT_FALSE(is_unit(none));
    EXPECT_THAT(normalised_or_identity(none), RotationNear(identity, 0.0));
    EXPECT_EQ(log_map(none).norm(), 0.0);
    EXPECT_NEAR(angular_distance(none, about_y(0.5)), 0.5, kExact);
    EXPECT_THAT(lerp(none, about_y(1.0), 0.5), RotationNear(about_y(0.5), kExact));
  }
  EXPECT_TRUE(is_unit(Eigen::Quaterniond(1.0005, 0, 0, 0)));
  EXPECT_FALSE(is_unit(Eigen::Quaterniond(1.01, 0, 0, 0)));
}

TEST(Yaw, IsTheAngleOfAboutYAndOfWhereZIsSent) {
  for (double yaw = -3.1; yaw < 3.2; yaw += 0.31) {
    EXPECT_NEAR(wrap_angle(yaw_of(about_y(yaw).toRotationMatrix()) - yaw), 0.0, 1e-12);
    const Eigen::Vector3d ahead = about_y(yaw) * Eigen::Vector3d::UnitZ();
    EXPECT_NEAR(std::atan2(ahead.x(), ahead.z()), wrap_angle(yaw), 1e-12);
    // Tilting the camera about its own x axis first does not change its heading.
    const Eigen::Quaterniond tilted =
        about_y(yaw) * Eigen::Quaterniond(Eigen::AngleAxisd(0.4, Eigen::Vector3d::UnitX()));
    EXPECT_NEAR(wrap_angle(yaw_of(tilted.toRotationMatrix()) - yaw), 0.0, 1e-12);
  }
}

TEST(WrapAngle, LandsInTheHalfOpenTurn) {
  constexpr double kPi = std::numbers::pi;
  EXPECT_DOUBLE_EQ(wrap_angle(kPi), kPi);
  EXPECT_DOUBLE_EQ(wrap_angle(-kPi), kPi);
  EXPECT_NEAR(wrap_angle(3 * kPi + 0.1), -kPi + 0.1, 1e-12);
  for (double angle = -50; angle < 50; angle += 0.7) {
    const double wrapped = wrap_angle(angle);
    EXPECT_GT(wrapped, -kPi);
    EXPECT_LE(wrapped, kPi);
    EXPECT_NEAR(std::sin(wrapped), std::sin(angle), 1e-9);
    EXPECT_NEAR(std::cos(wrapped), std::cos(angle), 1e-9);
  }
}

}  // namespace
}  // namespace chorus
