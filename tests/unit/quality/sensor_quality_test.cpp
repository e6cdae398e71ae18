#include "common/quality/sensor_quality.h"

#include <gmock/gmock.h>

#include "common/body/bones.h"
#include "common/quality/sensor_tally.h"
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

TEST(Thinned, SpansTheWholeSeriesInItsOrder) {
  Thinned<int> all(10);
  Thinned<int> thinned(10);
  for (int i = 0; i < 10; ++i) all.add(i);
  for (int i = 0; i < 1'000; ++i) thinned.add(i);
  EXPECT_THAT(all.values(), ::testing::ElementsAre(0, 1, 2, 3, 4, 5, 6, 7, 8, 9));
  EXPECT_THAT(thinned.values(), ::testing::ElementsAre(0, 128, 256, 384, 512, 640, 768, 896));
}

SensorTally moved_in_the_last_third(int views) {
  SensorTally tally;
  for (int i = 0; i < views; ++i) {
    const double at = 300.0 * i / views;
    const Eigen::Vector3d off(at < 200.0 ? 0.0 : 0.1, 0.0, 0.0);
    tally.offsets.add({at, off, off});
    tally.clocks.add({at, off, Eigen::Vector3d::UnitZ()});
  }
  return tally;
}

TEST(SensorQuality, ShowsASensorThatWasMovedLateInALongRecording) {
  for (const int views : {900, 700'000}) {
    const SensorQuality found = moved_in_the_last_third(views).quality(0.0, 300.0);
    EXPECT_NEAR((found.offset_last - found.offset_first).x(), 0.1, 1e-9) << views;
    EXPECT_NEAR(found.clock_last, 0.0, 1e-9) << views;
  }
}

TEST(SensorQuality, KnowsNoPlaceOfATimeInWhichItSawNobody) {
  SensorTally tally;
  for (int i = 0; i < 100; ++i) tally.offsets.add({1.0 * i, {0.1, 0.0, 0.0}, {0.1, 0.0, 0.0}});
  const SensorQuality found = tally.quality(0.0, 300.0);
  EXPECT_NEAR(found.offset_first.x(), 0.1, 1e-9);
  EXPECT_TRUE(std::isnan(found.offset_last.x())) << "not 0: it was not moved by 0.1 m";
}

// The person of boxes looks along +z, wherever it walks.
TEST(SensorQuality, CountsExchangedSidesInViewsFromTheFrontAlone) {
  const std::map<SensorId, Eigen::Isometry3d> places{
      {testing::sensor_id("s1"), Eigen::Isometry3d(Eigen::Translation3d(0, 1, 6))},
      {testing::sensor_id("s2"), Eigen::Isometry3d(Eigen::Translation3d(0, 1, -6))}};
  SensorJudge judge;
  judge.place(places);
  for (int i = 0; i < 100; ++i) {
    for (const auto& [id, place] : places) {
      SensorFrame frame = view(id.str(), i, {});
      auto& skeleton = frame.bodies.front().skeleton;
      for (const auto& [left, right] : kMirrorPairs) std::swap(skeleton[left], skeleton[right]);
      for (Joint& joint : skeleton.joints) joint.position = place.inverse() * joint.position;
      judge.add(frame);
    }
    judge.add(frame_at(i, {body_at(1, path(i))}));
  }
  auto sensors = judge.finish();
  EXPECT_EQ(sensors.at(testing::sensor_id("s1")).exchanged, 1.0) << "its picture is mirrored";
  EXPECT_EQ(sensors.at(testing::sensor_id("s2")).exchanged, 0.0) << "it takes a back for a front";
  EXPECT_LT(sensors.at(testing::sensor_id("s2")).residual, 1e-6);
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
