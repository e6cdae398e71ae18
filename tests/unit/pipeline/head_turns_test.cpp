// What is said of how sure a head's orientation is.
#include "fusion-server/pipeline/head_turns.h"

#include <gtest/gtest.h>

#include "common/posture/spread.h"
#include "tests/unit/pipeline/ring.h"

namespace chorus::pipeline {
namespace {

constexpr double kMarks = posture::kHeadTurn * posture::kHeadTurn;

Person seen_by(std::initializer_list<double> yaws) {
  Person person{PersonId{3}, {}};
  for (const double yaw : yaws) {
    SensorView& view = person.views.emplace_back();
    view.skeleton = body_at(0, 0);
    view.skeleton[JointId::Head].orientation = about_y(yaw);
  }
  return person;
}

FusedBody fused_as(double yaw) {
  FusedBody body;
  body.id = PersonId{3};
  body.skeleton = body_at(0, 0);
  body.skeleton[JointId::Head].orientation = about_y(yaw);
  return body;
}

const Covariance& doubt_of(const FusedBody& body) {
  return body.orientation_covariance[index_of(JointId::Head)];
}

TEST(HeadTurns, OfOneViewAreAsSureAsItsMarks) {
  std::vector<FusedBody> bodies{fused_as(0.3)};
  state_head_turns({seen_by({0.3})}, bodies);
  ASSERT_TRUE(doubt_of(bodies[0]).known());
  EXPECT_LT((doubt_of(bodies[0]).matrix() - kMarks * Eigen::Matrix3d::Identity()).norm(), 1e-6);
}

TEST(HeadTurns, OfViewsThatDifferAreLessSureAboutTheAxisOfTheDifference) {
  std::vector<FusedBody> bodies{fused_as(0.0)};
  state_head_turns({seen_by({0.5, -0.5})}, bodies);
  const Eigen::Matrix3d doubt = doubt_of(bodies[0]).matrix();
  EXPECT_NEAR(doubt(1, 1), kMarks + 0.25, 1e-6);
  EXPECT_NEAR(doubt(0, 0), kMarks, 1e-6);
}

TEST(HeadTurns, ThatNobodyTellsHaveNone) {
  Person person = seen_by({0.0});
  person.views[0].skeleton[JointId::Head].orientation = Eigen::Quaterniond(0, 0, 0, 0);
  std::vector<FusedBody> bodies{fused_as(0.0), fused_as(0.0)};
  bodies[1].id = PersonId{9};
  state_head_turns({person}, bodies);
  EXPECT_FALSE(doubt_of(bodies[0]).known());
  EXPECT_FALSE(doubt_of(bodies[1]).known());
}

TEST(HeadTurns, ThatASensorOnTheHeadStatesStay) {
  std::vector<FusedBody> bodies{fused_as(0.0)};
  const Covariance worn(Eigen::Matrix3d(1e-3 * Eigen::Matrix3d::Identity()));
  bodies[0].orientation_covariance[index_of(JointId::Head)] = worn;
  state_head_turns({seen_by({0.4})}, bodies);
  EXPECT_EQ(doubt_of(bodies[0]), worn);
}

TEST(HeadTurns, AreStatedOfWhatIsFused) {
  const Histories histories = ring_histories({});
  const Registration registration = ring_registration(6);
  PipelineConfig config;
  config.fusion.method = fusion::Method::InverseVariance;
  Step last;
  for (int i = 0; i < 10; ++i) {
    const Timestamp instant = pipeline::kStart + std::chrono::milliseconds(200 + 33 * i);
    last = step({instant, instant + std::chrono::milliseconds(80), static_cast<std::uint64_t>(i)},
                histories, registration, last.memory, config);
  }
  ASSERT_EQ(last.snapshot.bodies.size(), 1u);
  ASSERT_TRUE(doubt_of(last.snapshot.bodies[0]).known());
  EXPECT_NEAR(doubt_of(last.snapshot.bodies[0]).matrix()(0, 0), kMarks, 1e-3);
}

}  // namespace
}  // namespace chorus::pipeline
