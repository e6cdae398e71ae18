#include "common/hand/paper.h"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

#include "common/hand/outline.h"
#include "common/hand/ring.h"
#include "common/hand/segment.h"
#include "common/hand/webs.h"

namespace chorus::hand {
namespace {

using Webs = std::array<Defect, 4>;

double edge_length(const Outline& outline, const Defect& defect) {
  return (outline.points[defect.start] - outline.points[defect.end]).norm();
}

/// Steps 2 to 4: d0 first, then by distance from it.
Result<Webs> sorted_webs(const Outline& outline) {
  auto all = defects_of(outline);
  if (all.size() < 4)
    return fail(ErrorCode::NotFound, "hand", "has fewer than four convexity defects");
  std::ranges::sort(all, std::greater(), &Defect::depth);
  all.resize(4);
  const auto thumb =
      std::ranges::max_element(all, {}, [&](const Defect& d) { return edge_length(outline, d); });
  std::iter_swap(all.begin(), thumb);
  const Pixel& d0 = outline.points[all[0].far];
  std::sort(all.begin() + 1, all.end(), [&](const Defect& a, const Defect& b) {
    return (outline.points[a.far] - d0).norm() < (outline.points[b.far] - d0).norm();
  });
  return Webs{all[0], all[1], all[2], all[3]};
}

/// Step 6, for the points of the contour from `from` to `to`: the line through them, and where it
/// leaves the contour.
Pixel tip_of(const Outline& outline, std::size_t from, std::size_t to, const cv::Mat& fill) {
  std::vector<cv::Point2f> part;
  const std::size_t n = outline.points.size();
  for (std::size_t i = from;; i = (i + 1) % n) {
    part.emplace_back(static_cast<float>(outline.points[i].x()),
                      static_cast<float>(outline.points[i].y()));
    if (i == to) break;
  }
  cv::Vec4f line;
  cv::fitLine(part, line, cv::DIST_L2, 0, 0.01, 0.01);
  Pixel direction(line[0], line[1]);
  const Pixel through(line[2], line[3]);
  const Pixel root = 0.5 * (outline.points[from] + outline.points[to]);
  if (direction.dot(through - root) < 0.0) direction = -direction;
  return through + distance_inside(fill, through, direction) * direction;
}

/// Step 5.  A finger lies between two webs; the paper's list leaves the outer sides of thumb and
/// little finger open: there the finger ends as far from its tip as its web.
FingerShape finger_between(const Outline& outline, std::size_t from, std::size_t to,
                           const cv::Mat& fill) {
  const std::size_t n = outline.points.size();
  const bool forward = steps(outline, from, to) <= n / 2;
  FingerShape out;
  out.base = {outline.points[from], outline.points[to]};
  out.tip = forward ? tip_of(outline, from, to, fill) : tip_of(outline, to, from, fill);
  out.width = (out.base[1] - out.base[0]).norm();
  return out;
}

FingerShape outer_finger(const Outline& outline, const Defect& web, bool forward,
                         const cv::Mat& fill) {
  const std::size_t tip = forward ? web.end : web.start;
  const double length = (outline.points[tip] - outline.points[web.far]).norm();
  const std::size_t other = opposite_base(outline, tip, length, forward ? +1 : -1);
  FingerShape out;
  out.base = {outline.points[web.far], outline.points[other]};
  out.tip = forward ? tip_of(outline, web.far, other, fill) : tip_of(outline, other, web.far, fill);
  out.width = (out.base[1] - out.base[0]).norm();
  return out;
}

/// Root: the palm's circle and the weighted directions of ring and middle finger.  Bones from the
/// tip: 2, 3, 5 and 8.
Joints fibonacci_joints(const Outline& outline, const Fingers& fingers) {
  Joints out;
  const auto direction = [&](std::size_t f) {
    return Pixel((fingers[f].tip - fingers[f].root()).normalized());
  };
  const Pixel up = (0.5 * direction(2) + 0.5 * direction(3)).normalized();
  out[0] = outline.palm - outline.palm_radius * up;
  for (std::size_t f = 0; f < kFingers; ++f) {
    const double length = fingers[f].length();
    out[hand_joint(f, 3)] = fingers[f].tip;
    out[hand_joint(f, 2)] = fingers[f].tip - 0.2 * length * direction(f);
    out[hand_joint(f, 1)] = fingers[f].tip - 0.5 * length * direction(f);
    out[hand_joint(f, 0)] = fingers[f].root();
  }
  return out;
}

}  // namespace

Result<HandShape> paper_shape(const cv::Mat& bgr) {
  auto outline = paper_outline(paper_mask(bgr));
  if (!outline) return pass(outline);
  const auto webs = sorted_webs(*outline);
  if (!webs) return pass(webs);
  const cv::Mat fill = filled(*outline);
  const Webs& d = *webs;
  HandShape out;
  out.origin = Origin::Paper;
  const bool thumb_first = steps(*outline, d[0].far, d[1].far) <= outline->points.size() / 2;
  out.fingers[0] = outer_finger(*outline, d[0], !thumb_first, fill);
  for (std::size_t i = 1; i < 4; ++i)
    out.fingers[i] = finger_between(*outline, d[i - 1].far, d[i].far, fill);
  out.fingers[4] = outer_finger(*outline, d[3], thumb_first, fill);
  out.joints = fibonacci_joints(*outline, out.fingers);
  out.side = thumb_first ? Side::Left : Side::Right;
  out.outline = std::move(*outline);
  return out;
}

}  // namespace chorus::hand
