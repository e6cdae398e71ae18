#include "common/quality/sensor_quality.h"

#include <gmock/gmock.h>

#include "tests/support/builders.h"
#include "tests/unit/quality/standing_person.h"

namespace chorus::quality {
namespace {

struct Fault {
  Eigen::Vector3d offset_late = Eigen::Vector3d::Zero();  ///< In the second half [m].
  int late_by = 0;                                        ///< Frames: its clock is slow or fast.
};

Eigen::Vector3d path(int i) { return {1.5 * std::sin(0.05 * i), 0.0, 1.5 * std::cos(0.03 * i)}; }

SensorFrame view(const std::string& id, int i, const Fault& fault) {
  SensorFrame frame;
  frame.sensor = testing::sensor_id(id);
  frame.captured = at_frame(i);
  frame.received = frame.captured + std::chrono::milliseconds(20);
  BodyFrame body;
  body.captured = frame.captured;
  const auto truth =
      body_at(1, path(i - fault.late_by) + (i > 450 ? fault.offset_late : Eigen::Vector3d::Zero()));
  for (std::size_t j = 0; j < kJointCount; ++j) body.skeleton.joints[j] = truth.joints[j];
  frame.bodies = {body};
  return frame;
}

std::map<SensorId, SensorQuality> judged(const Fault& of_s2) {
  SensorJudge judge;
  judge.place({{testing::sensor_id("s1"), Eigen::Isometry3d::Identity()},
               {testing::sensor_id("s2"), Eigen::Isometry3d::Identity()}});
  for (int i = 0; i < 900; ++i) {
    judge.add(view("s1", i, {}));
    judge.add(view("s2", i, of_s2));
    if (i >= 3) judge.add(frame_at(i - 3, {body_at(1, path(i - 3))}));
  }
  return judge.finish();
}

TEST(SensorQuality, OfSensorsThatAgreeHasNoResidualAndNoClockError) {
  const auto sensors = judged({});
  const SensorQuality& s2 = sensors.at(testing::sensor_id("s2"));
  EXPECT_LT(s2.residual, 1e-6);
  EXPECT_NEAR(s2.clock, 0.0, 1e-6);
  EXPECT_NEAR(s2.rate, 30.0, 0.1);
  EXPECT_NEAR(s2.lateness, 0.02, 1e-6);
  EXPECT_GT(s2.compared, 20'000U);
}

TEST(SensorQuality, ShowsASensorThatWasMoved) {
  const auto sensors = judged({{0.1, 0.0, -0.05}, 0});
  const SensorQuality& s2 = sensors.at(testing::sensor_id("s2"));
  EXPECT_NEAR((s2.offset_last - s2.offset_first - Eigen::Vector3d(0.1, 0.0, -0.05)).norm(), 0.0,
              1e-3);
  EXPECT_LT((sensors.at(testing::sensor_id("s1")).offset_last).norm(), 1e-6);
}

TEST(SensorQuality, TellsAClockErrorFromMotion) {
  EXPECT_NEAR(judged({Eigen::Vector3d::Zero(), 2}).at(testing::sensor_id("s2")).clock, 2 / 30.0,
              0.005);
}

TEST(SensorQuality, ComparesNothingWithoutPlaces) {
  SensorJudge judge;
  for (int i = 0; i < 30; ++i) {
    judge.add(view("s1", i, {}));
    judge.add(frame_at(i, {body_at(1, path(i))}));
  }
  EXPECT_EQ(judge.finish().at(testing::sensor_id("s1")).compared, 0U);
}

}  // namespace
}  // namespace chorus::quality
