#include "fusion-server/fusion/learned_errors.h"

#include <gmock/gmock.h>

#include <limits>
#include <numbers>

#include "fusion-server/fusion/methods.h"

namespace chorus::fusion {
namespace {

using enum JointId;
using ::testing::DoubleNear;

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

/// A sensor at the origin of the floor plan, 1 m up, that looks along +z at a person 3 m away.
SensorView view_named(const char* sensor) {
  SensorView view;
  view.sensor = SensorId::parse(sensor).value();
  view.eye = {0.0, 1.0, 0.0};
  view.facing = -0.5;
  view.bearing = 0.2;
  for (const JointId id : {Neck, Head, WristLeft}) view.skeleton[id].state = JointState::Tracked;
  view.skeleton[Neck].position = {0.0, 1.4, 3.0};
  view.skeleton[Head].position = {0.0, 1.0, 3.0};
  view.skeleton[WristLeft].position = {3.0, 1.0, 3.0};
  return view;
}

double& at(Features& features, Feature which) { return features[static_cast<std::size_t>(which)]; }

SharedPredictor predictor_of(const ErrorPredictor& predictor) {
  return {std::make_shared<const ErrorPredictor>(predictor)};
}

/// Says the same of the head, and of nothing else.
ErrorPredictor constant_of_head(double error, double rms = 1.0) {
  ErrorPredictor predictor;
  predictor.joints[index_of(Head)] = JointPredictor{rms, 0.001, 1.0, error};
  return predictor;
}

TEST(Features, AreThoseOfTheJointAndNotOfTheNeckAlone) {
  SensorView view = view_named("a");
  view.skeleton[WristLeft].state = JointState::Inferred;
  Features found = features_of(view, WristLeft);
  EXPECT_EQ(at(found, Feature::Inferred), 1.0);
  EXPECT_EQ(at(found, Feature::Turn), 0.5);
  EXPECT_NEAR(at(found, Feature::Side), std::sin(-0.5), 1e-12);
  EXPECT_NEAR(at(found, Feature::Distance), 3.0 * std::numbers::sqrt2, 1e-12);
  EXPECT_NEAR(at(found, Feature::Periphery), 0.2 + std::numbers::pi / 4, 1e-12);
  EXPECT_NEAR(at(found, Feature::Elevation), 0.0, 1e-12);
  EXPECT_NEAR(at(found, Feature::Untracked), 23.0 / 25.0, 1e-12);
  view.bearing = -0.2;
  found = features_of(view, WristLeft);
  EXPECT_NEAR(at(found, Feature::Periphery), std::numbers::pi / 4 - 0.2, 1e-12);
}

TEST(Features, AreUnknownWhereTheViewIsSilent) {
  SensorView view = view_named("a");
  view.facing = kUnknown;
  view.skeleton[Neck].state = JointState::NotTracked;
  Features found = features_of(view, Head);
  EXPECT_TRUE(std::isnan(at(found, Feature::Turn)));
  EXPECT_TRUE(std::isnan(at(found, Feature::Periphery)));
  EXPECT_EQ(at(found, Feature::Distance), 3.0);
}

TEST(PredictedError, DoesNotExtrapolateAndReplacesWhatIsUnknown) {
  ErrorPredictor predictor;
  predictor.kind = PredictorKind::Linear;
  const auto distance = static_cast<std::size_t>(Feature::Distance);
  predictor.ranges[distance] = {2.0, 4.0, 2.5};
  JointPredictor joint;
  joint.constant = 0.01;
  joint.coefficients[distance] = 0.01;
  predictor.joints[index_of(Head)] = joint;
  Features features{};
  for (const auto& [value, expected] :
       {std::pair{3.0, 0.04}, {9.0, 0.05}, {0.1, 0.03}, {kUnknown, 0.035}}) {
    features[distance] = value;
    EXPECT_NEAR(predicted_error(predictor, Head, features).value(), expected, 1e-12) << value;
  }
  EXPECT_FALSE(predicted_error(predictor, Neck, features));
}

TEST(PredictedError, StaysBetweenOneMillimetreAndOneMetre) {
  EXPECT_EQ(predicted_error(constant_of_head(-3.0), Head, {}), 0.001);
  EXPECT_EQ(predicted_error(constant_of_head(3.0), Head, {}), 1.0);
  ErrorPredictor wild = constant_of_head(800.0);
  wild.kind = PredictorKind::Gamma;
  EXPECT_EQ(predicted_error(wild, Head, {}), 1.0);
}

TEST(PredictedError, FollowsTreesAndTheirUnknownBranch) {
  ErrorPredictor predictor;
  predictor.kind = PredictorKind::Boosting;
  JointPredictor joint;
  joint.constant = std::log(0.02);
  joint.trees = {{{1, 0.5, 1, 2, false}, {-1, 0.0}, {-1, std::log(2.0)}}, {{-1, std::log(1.5)}}};
  predictor.joints[index_of(Head)] = joint;
  Features features{};
  for (const auto& [turn, expected] : {std::pair{0.4, 0.03}, {0.5, 0.06}, {kUnknown, 0.06}}) {
    at(features, Feature::Turn) = turn;
    EXPECT_NEAR(predicted_error(predictor, Head, features).value(), expected, 1e-9) << turn;
  }
}

TEST(LearnedErrors, AreTheUsualOnesWithoutAPredictor) {
  const SensorView view = view_named("a");
  const auto usual = line_of_sight_errors({.along = 0.03}, {});
  FusionConfig config;
  config.noise.along = 0.03;
  EXPECT_EQ(errors_of(config)->covariance(view, Head), usual->covariance(view, Head));
  EXPECT_FALSE(errors_of(config)->error(view, Head).whole);
}

TEST(LearnedErrors, KeepTheShapeAndTakeTheSizeOfThePrediction) {
  FusionConfig config;
  config.noise = {.along = 0.03, .across = 0.01};
  config.errors = predictor_of(constant_of_head(0.05, 1.2));
  const JointError found = errors_of(config)->error(view_named("a"), Head);
  EXPECT_TRUE(found.whole);
  EXPECT_NEAR(std::sqrt(found.covariance.trace()), 0.05 * 1.2, 1e-12);
  EXPECT_NEAR(found.covariance(2, 2) / found.covariance(0, 0), 9.0, 1e-9);
}

TEST(LearnedErrors, LeaveStatedAndUnknownErrorsAlone) {
  FusionConfig config;
  config.errors = predictor_of(constant_of_head(0.05));
  SensorView view = view_named("a");
  view.skeleton[Head].covariance = Covariance(4e-4 * Eigen::Matrix3d::Identity());
  const auto usual = line_of_sight_errors({}, {});
  for (const JointId id : {Head, Neck})
    EXPECT_EQ(errors_of(config)->covariance(view, id), usual->covariance(view, id));
  EXPECT_FALSE(errors_of(config)->error(view, Neck).whole);
}

TEST(LearnedErrors, OfASensorReplaceThoseOfAll) {
  FusionConfig config;
  config.errors = predictor_of(constant_of_head(0.05));
  config.sensor_errors[SensorId::parse("b").value()] = predictor_of(constant_of_head(0.01));
  config.sensor_errors[SensorId::parse("c").value()] = {};
  const auto rms = [&](const char* sensor) {
    return std::sqrt(errors_of(config)->covariance(view_named(sensor), Head).trace());
  };
  EXPECT_THAT(rms("a"), DoubleNear(0.05, 1e-12));
  EXPECT_THAT(rms("b"), DoubleNear(0.01, 1e-12));
  EXPECT_THAT(rms("c"), DoubleNear(0.015 * std::sqrt(3.0), 1e-12));
}

/// What the method states of the head that one sensor sees.
double stated_variance(const FusionConfig& config) {
  Person person;
  person.views = {view_named("a")};
  const std::vector<SensorId> sensors{SensorId::parse("a").value()};
  return begin(config.method, config)->fuse(person, {{}, sensors}).variance[index_of(Head)];
}

TEST(LearnedErrors, ContainThePoseError) {
  for (const Method method : {Method::InverseVariance, Method::BodyFilter}) {
    FusionConfig config;
    config.method = method;
    config.common_sigma = 0.0;
    config.errors = predictor_of(constant_of_head(0.05));
    const double before = stated_variance(config);
    config.pose_error.trunk = 0.3;
    EXPECT_EQ(stated_variance(config), before) << name_of(method);
    config.errors = {};
    EXPECT_GT(stated_variance(config), 0.03) << name_of(method);
  }
}

TEST(SharedPredictor, IsComparedByItsValue) {
  EXPECT_EQ(predictor_of(constant_of_head(0.05)), predictor_of(constant_of_head(0.05)));
  EXPECT_FALSE(predictor_of(constant_of_head(0.05)) == predictor_of(constant_of_head(0.06)));
  EXPECT_FALSE(predictor_of(constant_of_head(0.05)) == SharedPredictor{});
}

}  // namespace
}  // namespace chorus::fusion
