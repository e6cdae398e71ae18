#include "fusion-server/facing/labels.h"

#include <gtest/gtest.h>

#include "common/base/units.h"

namespace chorus::facing {
namespace {

/// The labels of one sensor for a person who faces it.
struct LabelWatch {
  std::optional<Exchanged> exchanged = {};

  /// Sum of the passages in a second in which the labels agree with the held sides, or oppose them.
  Passage for_a_second(bool agree) {
    Passage sum;
    for (int i = 0; i < 30; ++i) {
      const Labels now{agree ? 4.0 : -4.0, deg(20), 1.0 / 30};
      const LabelStep step = step_labels(exchanged, now, {}, {});
      exchanged = step.exchanged;
      sum.out += step.passage.out;
      sum.back += step.passage.back;
    }
    return sum;
  }
};

TEST(Labels, ThatChangeAreCountedOnceAndThatStayAreNot) {
  LabelWatch watch;
  const auto expect = [&](bool agree, double out, double back) {
    const Passage sum = watch.for_a_second(agree);
    EXPECT_NEAR(sum.out, out, 0.05);
    EXPECT_NEAR(sum.back, back, 0.05);
  };
  expect(true, 0.0, 0.0);
  expect(false, 1.0, 0.0);
  expect(false, 0.0, 0.0);
  expect(true, 0.0, 1.0);
}

}  // namespace
}  // namespace chorus::facing
