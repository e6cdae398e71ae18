#include "fusion-server/learn/fit_errors.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "fusion-server/learn/boosting.h"

namespace chorus::learn {
namespace {

using enum JointId;
using fusion::Feature;
using fusion::PredictorKind;
using ::testing::HasSubstr;

struct Truth {
  double inferred;
  double turn;
  double distance;
};

/// Samples of the head whose errors are `of` the features, times `noise`.
template <class Of, class Noise>
std::vector<ErrorSample> samples_of(std::size_t count, const Of& of, Noise noise) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> even(0.0, 1.0);
  std::vector<ErrorSample> samples;
  for (std::size_t i = 0; i < count; ++i) {
    const Truth truth{even(random) < 0.3 ? 1.0 : 0.0, 3.0 * even(random), 1.0 + 3.0 * even(random)};
    ErrorSample sample{Head, {}, of(truth) * noise(random)};
    sample.features[static_cast<std::size_t>(Feature::Inferred)] = truth.inferred;
    sample.features[static_cast<std::size_t>(Feature::Turn)] = truth.turn;
    sample.features[static_cast<std::size_t>(Feature::Distance)] = truth.distance;
    samples.push_back(sample);
  }
  return samples;
}

double exactly(std::mt19937&) { return 1.0; }

double coefficient(const fusion::ErrorPredictor& predictor, Feature feature) {
  return predictor.joints[index_of(Head)]->coefficients[static_cast<std::size_t>(feature)];
}

TEST(FitErrors, FindsTheLineThatIsThere) {
  const auto samples = samples_of(
      1000,
      [](const Truth& t) { return 0.01 + 0.02 * t.inferred + 0.005 * t.turn + 0.003 * t.distance; },
      exactly);
  const auto linear = fit_errors(samples, {.kind = PredictorKind::Linear});
  ASSERT_TRUE(linear) << to_string(linear.error());
  EXPECT_NEAR(coefficient(*linear, Feature::Inferred), 0.02, 1e-6);
  EXPECT_NEAR(coefficient(*linear, Feature::Turn), 0.005, 1e-6);
  EXPECT_NEAR(coefficient(*linear, Feature::Distance), 0.003, 1e-6);
  EXPECT_NEAR(coefficient(*linear, Feature::Elevation), 0.0, 1e-6);
  // Predictions end at the 5th percentile of the errors, so a few samples are off.
  EXPECT_LT(prediction_error(*linear, samples), 1e-4);
  EXPECT_NEAR(linear->joints[index_of(Head)]->rms, 1.0, 0.01);
  std::vector<double> errors;
  for (const ErrorSample& sample : samples) errors.push_back(sample.error);
  std::ranges::sort(errors);
  EXPECT_EQ(linear->joints[index_of(Head)]->least, errors[50]);
  EXPECT_EQ(linear->joints[index_of(Head)]->most, errors.back());
}

TEST(FitErrors, FindsTheMeansOfTheStatesAlone) {
  const auto samples = samples_of(
      2000, [](const Truth& t) { return 0.01 + 0.02 * t.inferred + 0.001 * t.turn; }, exactly);
  const auto states = fit_errors(samples, {.kind = PredictorKind::States});
  const auto constant = fit_errors(samples, {.kind = PredictorKind::Constant});
  ASSERT_TRUE(states && constant);
  EXPECT_NEAR(coefficient(*states, Feature::Inferred), 0.02, 2e-4);
  EXPECT_EQ(coefficient(*states, Feature::Turn), 0.0);
  EXPECT_EQ(coefficient(*constant, Feature::Inferred), 0.0);
  EXPECT_LT(prediction_error(*states, samples), 0.2 * prediction_error(*constant, samples));
}

/// Gamma-distributed errors with mean exp(line): regression of the logarithm would be too low by
/// the mean of the noise's logarithm, 0.27 here.
TEST(FitErrors, GammaFindsTheMeanOfSkewedErrors) {
  std::gamma_distribution<double> gamma(2.0, 0.5);
  const auto samples = samples_of(
      20'000, [](const Truth& t) { return std::exp(-4.0 + 0.5 * t.turn); },
      [&gamma](std::mt19937& random) { return gamma(random); });
  const auto fitted = fit_errors(samples, {.kind = PredictorKind::Gamma});
  ASSERT_TRUE(fitted);
  EXPECT_NEAR(coefficient(*fitted, Feature::Turn), 0.5, 0.02);
  EXPECT_NEAR(fitted->joints[index_of(Head)]->constant, -4.0, 0.06);
  // The mean square of a gamma variable of shape 2 is 1.5 times the square of its mean.
  EXPECT_NEAR(fitted->joints[index_of(Head)]->rms, std::sqrt(1.5), 0.02);
}

TEST(FitErrors, BoostingFindsWhatAddsUpInNoLine) {
  if (!can_boost()) GTEST_SKIP() << "runs where libxgboost0 is installed";
  const auto samples = samples_of(
      3000, [](const Truth& t) { return t.turn > 1.5 && t.distance > 2.5 ? 0.08 : 0.01; }, exactly);
  const auto gamma = fit_errors(samples, {.kind = PredictorKind::Gamma});
  const auto boosted = fit_errors(samples, {.kind = PredictorKind::Boosting});
  ASSERT_TRUE(boosted) << to_string(boosted.error());
  EXPECT_LT(prediction_error(*boosted, samples), 0.2 * prediction_error(*gamma, samples));
  EXPECT_EQ(*fit_errors(samples, {.kind = PredictorKind::Boosting}), *boosted);
}

TEST(FitErrors, SaysWhenItsLibraryIsMissing) {
  if (can_boost()) GTEST_SKIP() << "runs where libxgboost0 is not installed";
  const auto samples = samples_of(
      400, [](const Truth&) { return 0.01; }, exactly);
  const auto refused = fit_errors(samples, {.kind = PredictorKind::Boosting});
  ASSERT_FALSE(refused);
  EXPECT_THAT(to_string(refused.error()), HasSubstr("apt install libxgboost0"));
}

TEST(FitErrors, RefusesTooFewSamplesAndLeavesRareJointsOut) {
  auto samples = samples_of(
      299, [](const Truth&) { return 0.02; }, exactly);
  const auto refused = fit_errors(samples, {});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::InvalidArgument);
  EXPECT_THAT(refused.error().message, HasSubstr("299"));
  samples.push_back(samples.front());
  samples.push_back(samples.front());
  samples.back().joint = Neck;
  const auto fitted = fit_errors(samples, {});
  ASSERT_TRUE(fitted);
  EXPECT_TRUE(fitted->joints[index_of(Head)]);
  EXPECT_FALSE(fitted->joints[index_of(Neck)]);
  EXPECT_FALSE(fit_errors({}, {}));
}

TEST(FitErrors, SurvivesUnknownFeaturesAndErrorsOfZero) {
  auto samples = samples_of(
      400, [](const Truth& t) { return t.inferred > 0 ? 0.0 : 0.02; }, exactly);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    samples[i].features[static_cast<std::size_t>(Feature::Elevation)] = std::nan("");
    if (i % 3 == 0) samples[i].features[static_cast<std::size_t>(Feature::Turn)] = std::nan("");
  }
  for (const PredictorKind kind : {PredictorKind::Linear, PredictorKind::Gamma}) {
    const auto fitted = fit_errors(samples, {.kind = kind});
    ASSERT_TRUE(fitted);
    EXPECT_TRUE(std::isfinite(prediction_error(*fitted, samples)));
    EXPECT_LT(prediction_error(*fitted, samples), 0.01);
  }
}

TEST(AddSamples, TakesEachPointOfEachViewThatHasATruth) {
  SensorView view;
  view.sensor = SensorId::parse("a").value();
  for (const JointId id : {Head, Neck, HandLeft}) view.skeleton[id].state = JointState::Tracked;
  view.skeleton[Head].position = {0.03, 1.7, 2.04};
  view.skeleton[HandLeft].measurement = Measurement::Ray;
  Skeleton<WorldSpace> exact;
  exact[Head].position = {0.0, 1.7, 2.0};
  exact[Head].state = exact[HandLeft].state = exact[HandRight].state = JointState::Tracked;
  std::vector<ErrorSample> samples;
  Person person;
  person.views = {view, view};
  add_samples(person, exact, samples);
  ASSERT_EQ(samples.size(), 2U);
  EXPECT_EQ(samples.front().joint, Head);
  EXPECT_NEAR(samples.front().error, 0.05, 1e-12);
}

}  // namespace
}  // namespace chorus::learn
