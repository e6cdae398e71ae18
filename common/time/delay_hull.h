// The least of one-sided delays against a clock that drifts.
//
// A delay is never less than the network's own, so all points (time, delay + clock difference) lie
// above a line whose slope is the rate of the clocks.  Only their lower convex hull can touch such
// a line, whatever the rate (Zhang, Liu and Xia 2002).
#pragma once

#include <deque>

namespace chorus {

class DelayHull {
 public:
  struct Point {
    double time = 0.0;   ///< [s]
    double value = 0.0;  ///< [s]
  };

  /// Times must not decrease; an earlier one counts as the last.
  void add(Point point);
  /// What lay above a forgotten point's edge stays forgotten: the hull loses at most that.
  void forget_before(double time);
  /// Forgets the first half of the time that the hull spans, at least one point.
  void forget_half();

  [[nodiscard]] bool empty() const noexcept { return points_.empty(); }
  /// Oldest first; slopes increase.
  [[nodiscard]] const std::deque<Point>& points() const noexcept { return points_; }
  /// The least value - rate * time: the line of this slope that all points are above.  Infinite
  /// when there are none.
  [[nodiscard]] double least(double rate) const;

 private:
  std::deque<Point> points_;
};

}  // namespace chorus
