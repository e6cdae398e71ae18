// The methods behind the tracker's one interface, with pictures that say what the test says.
#include <gtest/gtest.h>

#include "common/positioning/paper_smoothing.h"
#include "tests/support/matchers.h"
#include "tests/unit/positioning/scenes.h"

namespace chorus::positioning {
namespace {

using chorus::testing::VectorNear;

/// A picture that shows the person at a place, as far as somebody looks for him near it.
class ToldSight final : public PictureSight {
 public:
  ToldSight(Eigen::Vector3d place, double reach) : place_(std::move(place)), reach_(reach) {}

  [[nodiscard]] std::optional<SightedPlace> searched(const ExpectedBody& last) const override {
    // A step of at most 0.3 m over the floor.
    Eigen::Vector3d by = place_ - last.place;
    by.y() = 0.0;
    if (by.norm() > 0.3) by *= 0.3 / by.norm();
    return SightedPlace{last.place + by, 0.01 * Eigen::Matrix3d::Identity(), last.heading};
  }
  [[nodiscard]] std::optional<SightedPlace> outlined(const ExpectedBody& expected) const override {
    if ((expected.place - place_).norm() > reach_) return std::nullopt;
    return SightedPlace{place_, 4e-4 * Eigen::Matrix3d::Identity(), expected.heading};
  }
  [[nodiscard]] std::optional<SightedPlace> anywhere(const suit::SuitPose& /*pose*/,
                                                     std::optional<double> heading,
                                                     double /*height*/) const override {
    return SightedPlace{place_, 4e-4 * Eigen::Matrix3d::Identity(), heading.value_or(0.0)};
  }

 private:
  Eigen::Vector3d place_;
  double reach_;
};

const Eigen::Isometry3d kSightEye = testing::camera_at({0, 2, 5}, {0, 1, 0});

/// Somebody who slides along x without moving a limb; the suit sees a stand.
Eigen::Vector3d slid(double t) { return {0.4 * t, 0, 0}; }

struct Slide {
  Skeleton<WorldSpace> body = chorus::testing::standing_person();
  Eigen::Vector3d hips = body[JointId::SpineBase].position;

  [[nodiscard]] Instant at(double t, double reach = 0.8) const {
    Instant out{suit::pose_of(body, from_seconds(t)), {}};
    Look look{0, kSightEye, {}, std::make_shared<ToldSight>(hips + slid(t), reach)};
    std::mt19937 random(static_cast<unsigned>(1000 * t));
    Skeleton<WorldSpace> moved = body;
    for (Joint& joint : moved.joints) joint.position += slid(t);
    look.people.push_back(testing::rays_of(moved, kSightEye, 0.004, random));
    out.looks.push_back(std::move(look));
    return out;
  }
  [[nodiscard]] std::optional<Tracked> after(Method method, double length) const {
    TrackerSettings settings;
    settings.method = method;
    settings.heading = 0.0;
    Tracker tracker(settings);
    std::optional<Tracked> out;
    for (int i = 0; i <= static_cast<int>(30.0 * length); ++i) out = tracker.next(at(i / 30.0));
    return out;
  }
};

TEST(Methods, HaveNamesThatReadBack) {
  for (const std::string_view name : method_names()) {
    const auto method = method_named(name);
    ASSERT_TRUE(method) << name;
    EXPECT_EQ(name_of(*method), name);
  }
  EXPECT_FALSE(method_named("magic"));
  EXPECT_EQ(method_names().front(), "both");
}

TEST(Methods, ThatLookSeeASlideWhichTheSuitTakesForAStand) {
  const Slide slide;
  for (const Method method :
       {Method::Silhouettes, Method::Outline, Method::Landmarks, Method::Both}) {
    const auto end = slide.after(method, 3.0);
    ASSERT_TRUE(end) << name_of(method);
    EXPECT_NEAR(end->position.place.x(), slide.hips.x() + 1.2, 0.12) << name_of(method);
    EXPECT_EQ(end->hidden, Duration{0}) << name_of(method);
  }
  const auto suit = slide.after(Method::Suit, 3.0);
  ASSERT_TRUE(suit);
  EXPECT_NEAR(suit->position.place.x(), 0.0, 0.05);
}

TEST(Methods, BothAreSurerThanEach) {
  const Slide slide;
  const auto sigma = [&](Method method) {
    return slide.after(method, 2.0)->position.covariance.trace();
  };
  EXPECT_LT(sigma(Method::Both), sigma(Method::Landmarks));
  EXPECT_LT(sigma(Method::Both), sigma(Method::Outline));
}

TEST(Methods, TheOutlineIsFoundAgainAnywhereAfterItWasLost) {
  const Slide slide;
  TrackerSettings settings;
  settings.method = Method::Outline;
  settings.heading = 0.0;
  Tracker tracker(settings);
  std::optional<Tracked> out;
  for (int i = 0; i <= 30; ++i) out = tracker.next(slide.at(i / 30.0));
  // The person vanishes for three seconds and comes back a metre farther on.
  for (int i = 31; i <= 120; ++i) {
    Instant instant = slide.at(i / 30.0);
    instant.looks.clear();
    out = tracker.next(instant);
  }
  EXPECT_GT(out->hidden, from_seconds(2.8));
  for (int i = 121; i <= 135; ++i) out = tracker.next(slide.at(i / 30.0));
  EXPECT_NEAR(out->position.place.x(), slide.hips.x() + 0.4 * 4.5, 0.15);
}

TEST(Methods, BeginWhereTheBoardIsIfThatIsStated) {
  const Slide slide;
  TrackerSettings settings;
  settings.method = Method::Silhouettes;
  settings.heading = 0.0;
  settings.start = Eigen::Vector3d(-0.9, 0, 0);
  Tracker tracker(settings);
  const auto first = tracker.next(slide.at(0.0));
  ASSERT_TRUE(first);
  EXPECT_NEAR(first->position.place.x(), -0.6, 1e-9) << "one search reaches 0.3 m";
}

TEST(PaperSmoothing, KeepsALineAndTakesAwayJitter) {
  std::vector<Eigen::Vector3d> line;
  std::vector<Eigen::Vector3d> jitter;
  for (int i = 0; i < 120; ++i) {
    line.emplace_back(0.02 * i, 1.0, 0.0);
    jitter.emplace_back(0.02 * i + (i % 2 == 0 ? 0.05 : -0.05), 1.0, 0.0);
  }
  EXPECT_THAT(gauss_smoothed(line)[60], VectorNear(line[60], 1e-9));
  EXPECT_NEAR(gauss_smoothed(jitter)[60].x(), 1.2, 0.005);
  // A causal filter follows a steady walk without lag once it knows the speed.
  EXPECT_THAT(kalman_smoothed(line).back(), VectorNear(line.back(), 0.01));
  EXPECT_NEAR(kalman_smoothed(jitter).back().x(), line.back().x(), 0.04);
}

TEST(PaperSmoothing, OfNothingOrOneIsThat) {
  EXPECT_TRUE(gauss_smoothed({}).empty());
  EXPECT_TRUE(kalman_smoothed({}).empty());
  const std::vector<Eigen::Vector3d> one{{1, 2, 3}};
  EXPECT_THAT(gauss_smoothed(one, 0)[0], VectorNear(one[0], 1e-12));
  EXPECT_THAT(kalman_smoothed(one)[0], VectorNear(one[0], 1e-12));
}

}  // namespace
}  // namespace chorus::positioning
