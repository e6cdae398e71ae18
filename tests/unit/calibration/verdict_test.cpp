#include "common/calibration/verdict.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/calibration/lens_scenes.h"

namespace chorus::calibration {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

std::vector<std::string> weak(const std::vector<View>& views) {
  return weaknesses(calibrate(views, kSize).value());
}

/// The views without the corners that `drop` selects, and without views that then have hardly any
/// left.
template <class Drop>
std::vector<View> without(std::vector<View> views, Drop drop) {
  for (View& view : views)
    std::erase_if(view.corners, [&](const Corner& corner) { return drop(corner.pixel); });
  std::erase_if(views, [](const View& view) { return view.corners.size() < 12; });
  return views;
}

TEST(Weaknesses, AGoodSetHasNone) { EXPECT_THAT(weak(views_of({.count = 20})), IsEmpty()); }

TEST(Weaknesses, AnEmptyThirdIsNamed) {
  const auto views = views_of({.count = 40});
  EXPECT_THAT(weak(without(views, [](const Eigen::Vector2d& p) { return p.x() < 215; })),
              Contains(HasSubstr("no board in the left third")));
  EXPECT_THAT(weak(without(views, [](const Eigen::Vector2d& p) { return p.y() > 318; })),
              Contains(HasSubstr("no board in the lower third")));
}

TEST(Weaknesses, FewViewsAreCounted) {
  EXPECT_THAT(weak(views_of({.count = 6})), Contains(HasSubstr("only 6 different views")));
  EXPECT_THAT(missing_views({}, kSize), ElementsAre(HasSubstr("--squares counts squares")))
      << "to hold it still does not help";
  EXPECT_THAT(missing_views(views_of({.count = 1}), kSize),
              Contains(HasSubstr("only 1 different view of")));
}

TEST(Weaknesses, WithoutTiltTheFocalLengthIsUnknown) {
  const auto said = weak(views_of({.count = 15, .tilt = 0.02, .reach = 0.36}));
  EXPECT_THAT(said, Contains(HasSubstr("tilt the board by 30 deg in at least 3 views, each another "
                                       "way: none is tilted")));
}

TEST(Weaknesses, CornersOfAnotherBoardAreNotSolvedFor) {
  auto views = views_of({.count = 20});
  for (View& view : views) {  // as if the rows were one corner shorter
    for (std::size_t i = 0; i < view.corners.size(); ++i)
      view.corners[i].on_board =
          0.03 * Eigen::Vector2d(static_cast<double>(i % 6), static_cast<double>(i / 6));
  }
  const Calibration wrong = calibrate(views, kSize).value();
  EXPECT_EQ(wrong.intrinsics.fx, 0.0) << "it would take a minute";
  EXPECT_THAT(weaknesses(wrong), ElementsAre(HasSubstr("another board than --squares says")));
}

TEST(Weaknesses, AnotherBoardIsSaidAndNothingElseOfTheFit) {
  Calibration wrong = calibrate(views_of({.count = 20}), kSize).value();
  wrong.error_px = 60.0;
  wrong.intrinsics.fx = 0.0;
  wrong.sigma[0] = std::nan("");
  EXPECT_THAT(weaknesses(wrong), ElementsAre(HasSubstr("another board than --squares says")));
}

TEST(Weaknesses, CornersThatMissTheirPlacesAreSaid) {
  EXPECT_THAT(weak(views_of({.count = 20}, 1.5)), Contains(HasSubstr("is the board flat")));
}

TEST(Weaknesses, AFocalLengthThatIsHardlyKnownIsSaid) {
  Calibration poor = calibrate(views_of({.count = 20}), kSize).value();
  poor.sigma[0] = 0.03 * poor.intrinsics.fx;
  EXPECT_THAT(weaknesses(poor), ::testing::ElementsAre(HasSubstr("known to 3.0 % only")));
}

}  // namespace
}  // namespace chorus::calibration
