// Hands in drawn scans: fingers, tips and sides by their truth, and what is no hand.
#include "common/hand/scan.h"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <Eigen/Geometry>
#include <opencv2/imgproc.hpp>

#include "common/hand/segment.h"
#include "tests/support/hands/hand_scene.h"
#include "tests/support/matchers.h"

namespace chorus::hand {
namespace {

using testing::drawn_hand;
using testing::DrawnHand;
using testing::HandScene;
using ::testing::HasSubstr;
using testing::Thing;

constexpr int kSide = 700;  // Smaller pictures than real ones, so that the tests are quick.

HandScene scene(std::uint64_t seed, Thing thing = Thing::Hand) {
  HandScene out;
  out.seed = seed;
  out.thing = thing;
  out.long_side = kSide;
  out.dark_ground = seed % 2 == 1;
  return out;
}

Result<HandShape> scanned(const DrawnHand& drawn, bool paper = false) {
  ScanOptions options;
  options.back = drawn.back;
  options.paper = paper;
  return hand_in(drawn.picture, {}, options);
}

double farthest_tip_mm(const HandShape& hand, const DrawnHand& drawn) {
  double worst = 0.0;
  for (std::size_t f = 0; f < kFingers; ++f) {
    const Pixel& tip = drawn.joints[hand_joint(f, 3)];
    worst = std::max(worst, (hand.fingers[f].tip - tip).norm() / drawn.pixels_per_mm);
  }
  return worst;
}

/// The truth as a network would say it, with tips a few millimetres short.
SeenHand seen_in(const DrawnHand& drawn) {
  SeenHand out{0.99, drawn.side, 0.95, drawn.joints};
  for (std::size_t f = 0; f < kFingers; ++f) {
    Pixel& tip = out.joints[hand_joint(f, 3)];
    tip += 0.25 * (out.joints[hand_joint(f, 2)] - tip);
  }
  return out;
}

class OfADrawnHand : public ::testing::TestWithParam<std::uint64_t> {};

TEST_P(OfADrawnHand, FingersTipsAndSideAreRight) {
  const DrawnHand drawn = drawn_hand(scene(GetParam()));
  const auto hand = scanned(drawn);
  ASSERT_TRUE(hand) << to_string(hand.error());
  EXPECT_EQ(hand->side, drawn.side);
  EXPECT_LT(farthest_tip_mm(*hand, drawn), 3.0);
  for (std::size_t f = 1; f < kFingers; ++f)
    EXPECT_NEAR(hand->fingers[f].length() / drawn.free[f], 1.0, 0.08) << kFingerNames[f];
}

INSTANTIATE_TEST_SUITE_P(Seeds, OfADrawnHand, ::testing::Values(1, 2, 3, 4, 5, 6));

TEST(AScan, WithANetworkTakesSideAndJointsFromItAndTipsFromTheOutline) {
  const DrawnHand drawn = drawn_hand(scene(3));
  const auto hand = hand_in(drawn.picture, {seen_in(drawn)});
  ASSERT_TRUE(hand) << to_string(hand.error());
  EXPECT_EQ(hand->origin, Origin::Both);
  EXPECT_TRUE(hand->side_seen);
  EXPECT_EQ(hand->side, drawn.side);
  EXPECT_EQ(hand->back_seen, drawn.back);
  EXPECT_LT(farthest_tip_mm(*hand, drawn), 2.5) << "the network's own tips are 5 mm short";
  EXPECT_LT((hand->joints[hand_joint(2, 1)] - drawn.joints[hand_joint(2, 1)]).norm() /
                drawn.pixels_per_mm,
            2.0);
}

/// A hand that the frame cuts, as a network sees it: all joints in the picture, and the last bones
/// of what is cut off guessed wrong, so that they leave the finger at its side.
SeenHand guessed_in(const DrawnHand& drawn) {
  SeenHand out = seen_in(drawn);
  const auto inside = [&](const Pixel& p) {
    return Pixel(std::clamp(p.x(), 6.0, drawn.picture.cols - 7.0),
                 std::clamp(p.y(), 6.0, drawn.picture.rows - 7.0));
  };
  for (Pixel& joint : out.joints) joint = inside(joint);
  const Eigen::Rotation2Dd turn(0.7);
  for (std::size_t f = 0; f < kFingers; ++f) {
    const Pixel& tip = drawn.joints[hand_joint(f, 3)];
    const Pixel& last = out.joints[hand_joint(f, 2)];
    if (inside(tip) != tip)
      out.joints[hand_joint(f, 3)] = last + 20.0 * (turn * (tip - last).normalized());
  }
  return out;
}

TEST(AScan, WithANetworkRefusesAFingerThatTheFrameCuts) {
  for (const std::uint64_t seed : {3, 4, 10, 14}) {
    const DrawnHand drawn = drawn_hand(scene(seed, Thing::Cut));
    EXPECT_FALSE(hand_in(drawn.picture, {guessed_in(drawn)})) << "seed " << seed;
  }
}

TEST(AScan, WithANetworkFindsTheWebOfTheThumbWhereItIsDeepest) {
  for (const std::uint64_t seed : {1, 2, 3, 4}) {
    const DrawnHand drawn = drawn_hand(scene(seed));
    const auto hand = hand_in(drawn.picture, {seen_in(drawn)});
    ASSERT_TRUE(hand) << to_string(hand.error());
    EXPECT_NEAR(hand->fingers[0].length() / drawn.free[0], 1.0, 0.03) << "seed " << seed;
  }
}

TEST(AScan, JoinsAFingerThatARingCutsOffAndLeavesItsWebs) {
  HandScene with_ring = scene(11);
  with_ring.ring = true;
  const DrawnHand drawn = drawn_hand(with_ring);
  const auto hand = scanned(drawn);
  ASSERT_TRUE(hand) << to_string(hand.error());
  EXPECT_LT(farthest_tip_mm(*hand, drawn), 3.0);
  for (const std::size_t f : {2, 3})
    EXPECT_NEAR(hand->fingers[f].length() / drawn.free[f], 1.0, 0.03) << kFingerNames[f];
}

TEST(AScan, FindsAllOfTheFingersInGrain) {
  HandScene grainy = scene(1);
  grainy.long_side = 1200;
  grainy.grain = 2.0;
  const DrawnHand drawn = drawn_hand(grainy);
  const auto hand = scanned(drawn);
  ASSERT_TRUE(hand) << to_string(hand.error());
  EXPECT_LT(farthest_tip_mm(*hand, drawn), 3.0);
}

TEST(AScan, RefusesAFingerHalfWayAlongWhichThereIsNone) {
  DrawnHand drawn = drawn_hand(scene(2));
  const auto whole = scanned(drawn);
  ASSERT_TRUE(whole) << to_string(whole.error());
  // A stripe of the ground's colour from beside the index finger to beyond its middle.
  const FingerShape& index = whole->fingers[1];
  const Pixel along = (index.tip - index.root()).normalized(), across(-along.y(), along.x());
  const Pixel half = 0.5 * (index.tip + index.root());
  const auto at = [](const Pixel& p) { return cv::Point(cvRound(p.x()), cvRound(p.y())); };
  cv::line(drawn.picture, at(half - index.width * across), at(half + 0.2 * index.width * across),
           cv::Scalar(drawn.picture.at<cv::Vec3b>(2, 2)), cvRound(0.15 * index.width));
  const auto torn = scanned(drawn);
  ASSERT_FALSE(torn);
  EXPECT_THAT(torn.error().message, HasSubstr("the outline of the index is torn"));
}

/// A picture of black and white, as silhouettes are: it has no saturation.
DrawnHand silhouette(std::uint64_t seed) {
  DrawnHand drawn = drawn_hand(scene(seed));
  cv::Mat grey;
  cv::cvtColor(drawn.picture, grey, cv::COLOR_BGR2GRAY);
  cv::threshold(grey, grey, 90.0, 255.0, cv::THRESH_BINARY);
  cv::cvtColor(grey, drawn.picture, cv::COLOR_GRAY2BGR);
  return drawn;
}

TEST(AChannelWithoutContrast, IsDroppedBeforeTheConjunction) {
  const DrawnHand drawn = silhouette(3);
  EXPECT_TRUE(scanned(drawn));
  // The paper's channel of saturation is zero everywhere and empties the conjunction.
  EXPECT_EQ(cv::countNonZero(paper_mask(drawn.picture)), 0);
  EXPECT_FALSE(scanned(drawn, true));
}

struct Refused {
  Thing thing;
  const char* reason;
};
class WhatIsNoOpenHand : public ::testing::TestWithParam<Refused> {};

TEST_P(WhatIsNoOpenHand, IsRefusedWithItsReason) {
  for (const std::uint64_t seed : {1, 2}) {
    const auto hand = scanned(drawn_hand(scene(seed, GetParam().thing)));
    ASSERT_FALSE(hand) << "seed " << seed;
    EXPECT_THAT(hand.error().message, ::testing::ContainsRegex(GetParam().reason))
        << "seed " << seed;
  }
}

INSTANTIATE_TEST_SUITE_P(
    All, WhatIsNoOpenHand,
    ::testing::Values(Refused{Thing::Foot, "foot|fingers stand apart"},
                      Refused{Thing::Fist, "fist|fingers stand apart"},
                      Refused{Thing::Mitten, "fingers stand apart|proportions"},
                      Refused{Thing::TwoHands, "two hands"},
                      Refused{Thing::HiddenThumb, "the thumb does not stand apart"},
                      Refused{Thing::Cut, "cut by the frame|fingers stand apart|proportions"},
                      Refused{Thing::Blurred, "blurred|fingers stand apart"},
                      Refused{Thing::Nothing, "nothing stands out|fingers stand apart"}));

TEST(AScan, OfTwoHandsThatANetworkSeesIsRefused) {
  const DrawnHand drawn = drawn_hand(scene(1));
  const SeenHand one = seen_in(drawn);
  const auto hand = hand_in(drawn.picture, {one, one});
  ASSERT_FALSE(hand);
  EXPECT_THAT(hand.error().message, HasSubstr("two hands"));
}

TEST(AScan, DoesNotDependOnOpenCvsThreads) {
  const DrawnHand drawn = drawn_hand(scene(2));
  const int before = cv::getNumThreads();
  cv::setNumThreads(1);
  const auto one = scanned(drawn);
  cv::setNumThreads(4);
  const auto four = scanned(drawn);
  cv::setNumThreads(before);
  ASSERT_TRUE(one && four);
  EXPECT_EQ(one->joints, four->joints);
}

}  // namespace
}  // namespace chorus::hand
