// Tests of the matchers: one that accepts everything would make all other tests worthless.
#include "tests/support/matchers.h"

#include <limits>

#include "common/base/units.h"
#include "tests/support/builders.h"

namespace chorus::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

template <class M, class T>
std::string explain(const M& matcher, const T& value) {
  ::testing::StringMatchResultListener listener;
  ::testing::SafeMatcherCast<const T&>(matcher).MatchAndExplain(value, &listener);
  return listener.str();
}

TEST(ResultMatchers, TellValuesFromErrorsAndNameTheCode) {
  const Result<int> value = 1;
  const Result<int> error = fail(ErrorCode::NotFound, "/frames/7", "there is no such frame");
  EXPECT_THAT(value, IsOk());
  EXPECT_THAT(error, Not(IsOk()));
  EXPECT_THAT(error, FailsWith(ErrorCode::NotFound));
  EXPECT_THAT(error, Not(FailsWith(ErrorCode::Gone)));
  EXPECT_THAT(value, Not(FailsWith(ErrorCode::NotFound)));
  EXPECT_THAT(explain(IsOk(), error), HasSubstr("there is no such frame"));
}

TEST(VectorNear, AcceptsUpToTheBoundAndRefusesNaN) {
  const Eigen::Vector3d at(1, 2, 3);
  EXPECT_THAT(Eigen::Vector3d(1, 2, 3.125), VectorNear(at, 0.125));
  EXPECT_THAT(Eigen::Vector3d(1, 2, 3.126), Not(VectorNear(at, 0.125)));
  EXPECT_THAT(Eigen::Vector3d(1, kNaN, 3), Not(VectorNear(at, 1e9)));
}

TEST(RotationNear, IgnoresTheSignAndRefusesZeroQuaternions) {
  const Eigen::Quaterniond turn = about_y(0.5);
  const Eigen::Quaterniond same(-turn.w(), -turn.x(), -turn.y(), -turn.z());
  EXPECT_THAT(same, RotationNear(turn, 1e-9));
  EXPECT_THAT(about_y(0.52), Not(RotationNear(turn, 0.01)));
  EXPECT_THAT(Eigen::Quaterniond(0, 0, 0, 0), Not(RotationNear(turn, 4.0)));
}

TEST(IsometryNear, ChecksTranslationAndRotationSeparately) {
  const Eigen::Isometry3d pose = sensor_pose({1, 1, 1}, deg(90), deg(20));
  EXPECT_THAT(pose, IsometryNear(pose, 0.0, 1e-7));
  EXPECT_THAT(sensor_pose({1, 1, 1.02}, deg(90), deg(20)), Not(IsometryNear(pose, mm(10), deg(1))));
  EXPECT_THAT(sensor_pose({1, 1, 1}, deg(92), deg(20)), Not(IsometryNear(pose, mm(10), deg(1))));
  Eigen::Isometry3d broken = pose;
  broken.translation().x() = kNaN;
  EXPECT_THAT(broken, Not(IsometryNear(pose, 1e9, 10.0)));
}

TEST(SkeletonNear, NamesTheJointThatIsWrong) {
  const Skeleton<WorldSpace> person = standing_person();
  Skeleton<WorldSpace> other = person;
  EXPECT_THAT(other, SkeletonNear(person, 0.0));
  other[JointId::KneeLeft].position.x() += 0.03;
  EXPECT_THAT(other, SkeletonNear(person, 0.031));
  EXPECT_THAT(other, Not(SkeletonNear(person, 0.029)));
  EXPECT_THAT(explain(SkeletonNear(person, 0.01), other), HasSubstr("KneeLeft"));
  EXPECT_NEAR(largest_distance(person, other), 0.03, 1e-12);
}

TEST(SkeletonNear, ComparesStatesAndSkipsWhatNeitherSaw) {
  Skeleton<WorldSpace> person = standing_person();
  Skeleton<WorldSpace> other = person;
  hide(other[JointId::Head]);
  EXPECT_THAT(other, Not(SkeletonNear(person, 10.0)));
  hide(person[JointId::Head]);
  person[JointId::Head].position.x() = kNaN;
  EXPECT_THAT(other, SkeletonNear(person, 0.0));
  other[JointId::Neck].position.x() = kNaN;
  EXPECT_THAT(other, Not(SkeletonNear(person, 1e9)));
}

}  // namespace
}  // namespace chorus::testing
