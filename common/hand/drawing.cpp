#include "common/hand/drawing.h"

#include <opencv2/imgproc.hpp>

#include <fmt/format.h>

namespace chorus::hand {
namespace {

const std::array<cv::Scalar, kFingers> kColours{
    cv::Scalar(40, 40, 230), {30, 150, 250}, {40, 190, 40}, {230, 150, 30}, {200, 40, 200}};

cv::Point place_of(const Pixel& p) { return {cvRound(p.x()), cvRound(p.y())}; }

void write(cv::Mat& picture, const std::string& text, cv::Point where, double size) {
  const int thick = std::max(1, cvRound(1.6 * size));
  cv::putText(picture, text, where, cv::FONT_HERSHEY_SIMPLEX, size, {255, 255, 255}, 3 * thick,
              cv::LINE_AA);
  cv::putText(picture, text, where, cv::FONT_HERSHEY_SIMPLEX, size, {0, 0, 0}, thick, cv::LINE_AA);
}

}  // namespace

cv::Mat drawn(const cv::Mat& bgr, const HandShape& hand) {
  cv::Mat out = bgr.clone();
  const double size = std::max(bgr.cols, bgr.rows) / 1200.0;
  const int thick = std::max(1, cvRound(2.0 * size));
  std::vector<cv::Point> contour;
  for (const Pixel& p : hand.outline.points) contour.push_back(place_of(p));
  if (!contour.empty()) cv::polylines(out, contour, true, {255, 200, 0}, thick, cv::LINE_AA);
  cv::circle(out, place_of(hand.outline.palm), cvRound(hand.outline.palm_radius), {200, 200, 0},
             thick, cv::LINE_AA);
  for (std::size_t f = 0; f < kFingers; ++f) {
    const FingerShape& finger = hand.fingers[f];
    cv::line(out, place_of(finger.base[0]), place_of(finger.base[1]), kColours[f], thick,
             cv::LINE_AA);
    for (std::size_t i = 0; i < kFingerJoints; ++i) {
      const std::size_t joint = hand_joint(f, i);
      cv::line(out, place_of(hand.joints[layout::kHandTable[joint].parent]),
               place_of(hand.joints[joint]), kColours[f], thick + 1, cv::LINE_AA);
      cv::circle(out, place_of(hand.joints[joint]), 2 * thick + 1, kColours[f], cv::FILLED,
                 cv::LINE_AA);
    }
    write(out, std::string(kFingerNames[f]), place_of(finger.tip) + cv::Point(6, 0), 0.7 * size);
  }
  const std::string title =
      fmt::format("{} hand, {}{}", name_of(hand.side), hand.back_seen ? "back" : "palm",
                  hand.side_seen ? "" : " (assumed)");
  write(out, title, {cvRound(16 * size), out.rows - cvRound(16 * size)}, size);
  return out;
}

}  // namespace chorus::hand
