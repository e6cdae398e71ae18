#include "common/hand/webs.h"

#include <algorithm>

#include <opencv2/imgproc.hpp>

namespace chorus::hand {

std::vector<Defect> defects_of(const Outline& outline) {
  std::vector<cv::Point> contour;
  for (const Pixel& p : outline.points) contour.emplace_back(cvRound(p.x()), cvRound(p.y()));
  if (contour.size() < 4) return {};
  std::vector<int> hull;
  std::vector<cv::Vec4i> found;
  try {
    cv::convexHull(contour, hull, false, false);
    if (hull.size() < 3) return {};
    cv::convexityDefects(contour, hull, found);
  } catch (const cv::Exception&) {
    return {};  // an outline that touches itself
  }
  std::vector<Defect> out;
  for (const cv::Vec4i& each : found) {
    out.push_back({static_cast<std::size_t>(each[0]), static_cast<std::size_t>(each[1]),
                   static_cast<std::size_t>(each[2]), each[3] / 256.0});
  }
  std::ranges::sort(out, {}, &Defect::far);
  return out;
}

}  // namespace chorus::hand
