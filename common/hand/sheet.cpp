#include "common/hand/sheet.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <opencv2/imgproc.hpp>

namespace chorus::hand {
namespace {

using Contour = std::vector<cv::Point>;

constexpr double kSidesOfA4 = 1.41421356;
constexpr double kSidesOfCard = kCardLong / kCardShort;

cv::Point2f float_of(const Pixel& p) {
  return {static_cast<float>(p.x()), static_cast<float>(p.y())};
}

/// Clockwise, beginning with the corner whose next side is a long one.
std::array<Pixel, 4> ordered(const Contour& quad) {
  std::array<Pixel, 4> corners;
  for (std::size_t i = 0; i < 4; ++i) corners[i] = Pixel(quad[i].x, quad[i].y);
  if (cv::contourArea(quad, true) < 0.0) std::reverse(corners.begin(), corners.end());
  const auto side = [&](std::size_t i) { return (corners[(i + 1) % 4] - corners[i]).norm(); };
  if (side(0) + side(2) < side(1) + side(3))
    std::rotate(corners.begin(), corners.begin() + 1, corners.end());
  return corners;
}

}  // namespace

bool has_sides_of_a4(int width, int height) {
  constexpr double kOff = 0.02;
  if (width < 1 || height < 1) return false;
  const double ratio = static_cast<double>(std::max(width, height)) / std::min(width, height);
  return std::abs(ratio / kSidesOfA4 - 1.0) < kOff;
}

std::optional<std::array<Pixel, 4>> find_sheet(const cv::Mat& bgr) {
  constexpr double kLeastArea = 0.15;  // of the picture
  constexpr double kLeastFull = 0.9;  // of the quadrilateral that the sheet and the hand on it fill
  // The darkest of the three channels tells white paper from bright skin.
  std::vector<cv::Mat> channels;
  cv::Mat white, bright;
  cv::split(bgr, channels);
  cv::min(channels[0], channels[1], white);
  cv::min(white, channels[2], white);
  cv::GaussianBlur(white, white, {5, 5}, 0.0);
  cv::threshold(white, bright, 0, 255, cv::THRESH_BINARY | cv::THRESH_OTSU);
  std::vector<Contour> contours;
  cv::findContours(bright, contours, cv::RETR_EXTERNAL, cv::CHAIN_APPROX_NONE);
  for (const Contour& contour : contours) {
    Contour hull, quad;
    cv::convexHull(contour, hull);
    const double area = cv::contourArea(hull);
    if (area < kLeastArea * static_cast<double>(bgr.total())) continue;
    cv::approxPolyDP(hull, quad, 0.02 * cv::arcLength(hull, true), true);
    if (quad.size() != 4 || area < kLeastFull * cv::contourArea(quad)) continue;
    const bool whole = std::ranges::all_of(quad, [&](const cv::Point& p) {
      return p.x > 1 && p.y > 1 && p.x < bgr.cols - 2 && p.y < bgr.rows - 2;
    });
    if (whole) return ordered(quad);
  }
  return std::nullopt;
}

cv::Mat flattened(const cv::Mat& bgr, const std::array<Pixel, 4>& sheet, int side) {
  const int other = cvRound(side / kSidesOfA4);
  const auto w = static_cast<float>(side), h = static_cast<float>(other);
  const std::array<cv::Point2f, 4> from{float_of(sheet[0]), float_of(sheet[1]), float_of(sheet[2]),
                                        float_of(sheet[3])};
  const std::array<cv::Point2f, 4> to{cv::Point2f{0, 0}, {w, 0}, {w, h}, {0, h}};
  cv::Mat out;
  cv::warpPerspective(bgr, out, cv::getPerspectiveTransform(from.data(), to.data()), {side, other},
                      cv::INTER_AREA);
  // The sheet's own edge, blurred, is no part of what lies on it.
  const int edge = std::max(2, side / 200);
  const cv::Scalar ground = cv::mean(out(cv::Rect(edge, edge, side / 30, other / 30)));
  cv::rectangle(out, {0, 0, side, other}, ground, edge);
  return out;
}

std::optional<Card> find_card(const cv::Mat& bgr) {
  constexpr double kLeast = 0.004, kMost = 0.2;  // of the picture
  constexpr double kOffSides = 0.06, kLeastFull = 0.93;
  std::vector<cv::Mat> channels;
  cv::Mat lab, edges;
  cv::cvtColor(bgr, lab, cv::COLOR_BGR2Lab);
  cv::split(lab, channels);
  std::optional<Card> best;
  double largest = 0.0;
  for (const cv::Mat& channel : channels) {
    cv::Canny(channel, edges, 30, 90);
    cv::morphologyEx(edges, edges, cv::MORPH_CLOSE, cv::Mat::ones(3, 3, CV_8U));
    std::vector<Contour> contours;
    cv::findContours(edges, contours, cv::RETR_EXTERNAL, cv::CHAIN_APPROX_NONE);
    for (const Contour& contour : contours) {
      const double area = cv::contourArea(contour);
      const double all = static_cast<double>(bgr.total());
      if (area < std::max(largest, kLeast * all) || area > kMost * all) continue;
      const cv::RotatedRect box = cv::minAreaRect(contour);
      const double longer = std::max(box.size.width, box.size.height) - 1.0;
      const double shorter = std::min(box.size.width, box.size.height) - 1.0;
      if (area < kLeastFull * longer * shorter) continue;
      if (std::abs(longer / shorter / kSidesOfCard - 1.0) > kOffSides) continue;
      largest = area;
      Card card;
      card.mm_per_pixel = 0.5 * (kCardLong / longer + kCardShort / shorter);
      std::array<cv::Point2f, 4> corners;
      box.points(corners.data());
      for (std::size_t i = 0; i < 4; ++i) card.corners[i] = Pixel(corners[i].x, corners[i].y);
      best = card;
    }
  }
  return best;
}

cv::Mat without_card(const cv::Mat& bgr, const Card& card) {
  Pixel middle = Pixel::Zero();
  for (const Pixel& corner : card.corners) middle += 0.25 * corner;
  const auto grown = [&](double factor) {
    Contour out;
    for (const Pixel& corner : card.corners) {
      const Pixel at = middle + factor * (corner - middle);
      out.emplace_back(cvRound(at.x()), cvRound(at.y()));
    }
    return out;
  };
  cv::Mat around(bgr.size(), CV_8U, cv::Scalar(0));
  cv::fillConvexPoly(around, grown(1.25), 255);
  cv::fillConvexPoly(around, grown(1.12), 0);
  cv::Mat out = bgr.clone();
  cv::fillConvexPoly(out, grown(1.12), cv::mean(bgr, around));
  return out;
}

}  // namespace chorus::hand
