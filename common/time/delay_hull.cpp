#include "common/time/delay_hull.h"

#include <algorithm>
#include <limits>

namespace chorus {
namespace {

/// True if b is on or above the line from a to c.
bool above(const DelayHull::Point& a, const DelayHull::Point& b, const DelayHull::Point& c) {
  return (b.value - a.value) * (c.time - a.time) >= (c.value - a.value) * (b.time - a.time);
}

}  // namespace

void DelayHull::add(Point point) {
  if (!points_.empty()) point.time = std::max(point.time, points_.back().time);
  if (!points_.empty() && point.time == points_.back().time) {
    point.value = std::min(point.value, points_.back().value);
    points_.pop_back();
  }
  while (points_.size() >= 2 && above(points_[points_.size() - 2], points_.back(), point))
    points_.pop_back();
  points_.push_back(point);
}

void DelayHull::forget_before(double time) {
  while (points_.size() > 1 && points_.front().time < time) points_.pop_front();
}

void DelayHull::forget_half() {
  if (points_.empty()) return;
  const double middle = 0.5 * (points_.front().time + points_.back().time);
  do {
    points_.pop_front();
  } while (!points_.empty() && points_.front().time < middle);
}

double DelayHull::least(double rate) const {
  double least = std::numeric_limits<double>::infinity();
  for (const Point& point : points_) least = std::min(least, point.value - rate * point.time);
  return least;
}

}  // namespace chorus
