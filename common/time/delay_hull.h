// The smallest of one-sided delays relative to a clock that drifts.
//
// A delay is never below the network's minimum, so all points (time, delay + clock difference) lie
// above a line whose slope is the rate of the clocks.  Whatever the rate, only their lower convex
// hull can touch such a line (Zhang, Liu and Xia 2002).
#pragma once

#include <deque>

namespace chorus {

class DelayHull {
 public:
  struct Point {
    double time = 0.0;   ///< [s]
    double value = 0.0;  ///< [s]
  };

  /// Times should not decrease; an earlier time counts as equal to the last.
  void add(Point point);
  /// Forgets the points before `time`, except the last point.  Points above an edge of the hull
  /// were not kept, so those between a forgotten point and the next one are lost, too.
  void forget_before(double time);
  /// Forgets the first half of the time that the hull spans, at least one point.
  void forget_half();

  [[nodiscard]] bool empty() const noexcept { return points_.empty(); }
  /// Oldest first; slopes increase.
  [[nodiscard]] const std::deque<Point>& points() const noexcept { return points_; }
  /// The smallest value - rate * time, that is, the intercept of the highest line of this slope
  /// below all points.  Infinite when there are none.
  [[nodiscard]] double least(double rate) const;

 private:
  std::deque<Point> points_;
};

}  // namespace chorus
