#include "common/evaluation/scores.h"

#include <gtest/gtest.h>

#include "common/evaluation/limb_error.h"
#include "common/geometry/rotation.h"

namespace chorus::evaluation {
namespace {

ErrorTrack angles(const std::vector<double>& degrees) {
  ErrorTrack out;
  for (std::size_t i = 0; i < degrees.size(); ++i) {
    LimbError error;
    error.angle = deg(degrees[i]);
    out.push_back({0.1 * static_cast<double>(i), error});
  }
  return out;
}

TEST(LimbError, PartsSwingFromTwist) {
  inertial::SensorCalibration calibration;
  OrientationPair pair;
  pair.inertial_from_sensor = about_y(0.8);
  EXPECT_NEAR(limb_error(calibration, pair).twist, 0.8, 1e-12);
  EXPECT_NEAR(limb_error(calibration, pair).swing, 0.0, 1e-7);
  pair.inertial_from_sensor = exp_map({0.6, 0, 0});
  EXPECT_NEAR(limb_error(calibration, pair).swing, 0.6, 1e-12);
  EXPECT_NEAR(limb_error(calibration, pair).twist, 0.0, 1e-12);
  EXPECT_NEAR(limb_error(calibration, pair).angle, 0.6, 1e-12);
  pair.inertial_from_sensor = exp_map({0.6, 0, 0}) * about_y(1.0);
  pair.tracked.twist_seen = false;
  EXPECT_NEAR(limb_error(calibration, pair).angle, 0.6, 1e-9);
}

TEST(Detection, HasHysteresisAndALeastLength) {
  // On at 46, still on at 40 (above 35), off at 30; a single 60 is too short.
  const auto found = detected_errors(angles({10, 46, 40, 36, 30, 10, 60, 10, 44, 44, 44}));
  ASSERT_EQ(found.size(), 1u);
  EXPECT_NEAR(found[0].begin, 0.1, 1e-12);
  EXPECT_NEAR(found[0].end, 0.3, 1e-12);
  EXPECT_TRUE(detected_errors({}).empty());
}

TEST(Detection, LimbTauIsBoundedByThePapers) {
  EXPECT_DOUBLE_EQ(limb_tau(angles({1, 1, 1, 1})), deg(15));
  EXPECT_DOUBLE_EQ(limb_tau(angles({0, 50, 100, 150})), kPaperTau);
  EXPECT_DOUBLE_EQ(limb_tau({}), kPaperTau);
  const auto floor = noise_floor(angles({10, 20, 170}));
  EXPECT_NEAR(to_deg(floor.mean), 15, 1e-9);
  EXPECT_NEAR(to_deg(floor.spread), 5, 1e-9);
}

TEST(Scores, CountFramesAndSegments) {
  const std::vector<Segment> truth{{1, 2}, {5, 6}};
  const std::vector<Segment> found{{1.5, 2}, {8, 9}};
  std::vector<double> times;
  for (int i = 0; i < 100; ++i) times.push_back(0.1 * i + 0.05);
  const Counts frames = frame_counts(times, found, truth);
  EXPECT_DOUBLE_EQ(frames.true_positives, 5);
  EXPECT_DOUBLE_EQ(frames.false_positives, 10);
  EXPECT_DOUBLE_EQ(frames.false_negatives, 15);
  EXPECT_DOUBLE_EQ(frames.true_negatives, 70);
  EXPECT_DOUBLE_EQ(*frames.precision(), 5.0 / 15.0);
  EXPECT_DOUBLE_EQ(*frames.recall(), 0.25);
  const Counts segments = segment_counts(found, truth);
  EXPECT_DOUBLE_EQ(segments.true_positives, 1);
  EXPECT_DOUBLE_EQ(segments.false_positives, 1);
  EXPECT_DOUBLE_EQ(segments.false_negatives, 1);
  EXPECT_FALSE(Counts{}.precision());
  EXPECT_NEAR(*kappa(times, truth, truth), 1.0, 1e-12);
  EXPECT_LT(*kappa(times, truth, found), 0.4);
  EXPECT_FALSE(kappa(times, {}, {}));
}

TEST(Scores, RocAreaIsTheChanceOfBeingLarger) {
  const std::vector<Timed<double>> values{{0, 1}, {1, 2}, {2, 3}, {3, 2}};
  EXPECT_DOUBLE_EQ(*roc_area(values, {{2, 2}}), 1.0);
  EXPECT_DOUBLE_EQ(*roc_area(values, {{1, 1}}), 0.5);  // beaten once, beats once, ties once
  EXPECT_FALSE(roc_area(values, {}));
}

TEST(Annotations, AreReadAndRefusedByLine) {
  const auto fine =
      parse_annotations("limb,begin_s,end_s\nShankLeft,4.6,6.6\r\n\nleft hand, 1, 2\n", "a1.csv");
  ASSERT_TRUE(fine) << to_string(fine.error());
  EXPECT_EQ(segments_of(*fine, inertial::Limb::HandLeft).size(), 1u);
  EXPECT_DOUBLE_EQ(segments_of(*fine, inertial::Limb::ShankLeft)[0].end, 6.6);
  EXPECT_EQ(parse_annotations("h\nTail,1,2\n", "a1.csv").error().context, "a1.csv:2");
  EXPECT_FALSE(parse_annotations("h\nHead,2,1\n", "a"));
  EXPECT_FALSE(parse_annotations("h\nHead,2\n", "a"));
}

}  // namespace
}  // namespace chorus::evaluation
