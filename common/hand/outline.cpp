#include "common/hand/outline.h"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

namespace chorus::hand {
namespace {

using Contour = std::vector<cv::Point>;

// A piece that a ring cut off is at least this share of the palm's circle; specks are smaller.
constexpr double kLeastPiece = 0.08;
// A ring is at most this wide, as a share of the palm's radius (40 mm): 10 mm.
constexpr double kWidestRing = 0.25;
constexpr double kSecondHand = 0.67;
// Gap between the pieces in 4.1, whose limit is an area: 1/300 of the picture.
constexpr double kPaperPiece = 1.0 / 300.0;

struct Piece {
  Contour contour;
  cv::Point centre;
  double radius = 0.0;
  double area = 0.0;
};

std::vector<Piece> pieces_of(const cv::Mat& mask) {
  std::vector<Contour> contours;
  cv::findContours(mask, contours, cv::RETR_EXTERNAL, cv::CHAIN_APPROX_NONE);
  std::vector<Piece> out;
  for (Contour& contour : contours) {
    const double area = cv::contourArea(contour);
    if (area >= 30.0) out.push_back({std::move(contour), {}, 0.0, area});
  }
  std::ranges::sort(out, {}, [](const Piece& piece) { return -piece.area; });
  if (out.size() > 12) out.resize(12);
  return out;
}

/// The picture's border bounds the hand, too.
void inscribe(Piece& piece) {
  const cv::Rect box = cv::boundingRect(piece.contour);
  cv::Mat fill(box.height + 2, box.width + 2, CV_8U, cv::Scalar(0)), distance;
  const cv::Point shift(1 - box.x, 1 - box.y);
  const std::vector<Contour> one{piece.contour};
  cv::drawContours(fill, one, 0, 255, cv::FILLED, cv::LINE_8, {}, 0, shift);
  cv::distanceTransform(fill, distance, cv::DIST_L2, cv::DIST_MASK_PRECISE);
  cv::minMaxLoc(distance, nullptr, &piece.radius, nullptr, &piece.centre);
  piece.centre -= shift;
}

double squared(const cv::Point& p) { return 1.0 * p.x * p.x + 1.0 * p.y * p.y; }

/// The nearest two points of two contours.
std::pair<cv::Point, cv::Point> nearest(const Contour& a, const Contour& b) {
  std::pair<cv::Point, cv::Point> best{a.front(), b.front()};
  double least = squared(a.front() - b.front());
  for (std::size_t i = 0; i < a.size(); i += 2) {
    for (std::size_t j = 0; j < b.size(); j += 2) {
      const double d = squared(a[i] - b[j]);
      if (d < least) least = d, best = {a[i], b[j]};
    }
  }
  return best;
}

/// The end of a finger is as wide as one, and solid; grain and shadows are not.
bool is_finger_end(const Piece& piece, const Piece& hand) {
  constexpr double kThinnest = 0.12, kThickest = 0.4, kSolid = 0.85;
  const double circle = 3.14159265 * hand.radius * hand.radius;
  if (piece.area < kLeastPiece * circle) return false;
  if (piece.radius < kThinnest * hand.radius || piece.radius > kThickest * hand.radius)
    return false;
  Contour hull;
  cv::convexHull(piece.contour, hull);
  return piece.area > kSolid * cv::contourArea(hull);
}

/// How far points lie beside the long axis of a piece [px].
struct LongAxis {
  Pixel middle = Pixel::Zero();
  Pixel across = Pixel::UnitX();

  explicit LongAxis(const Contour& piece) {
    const cv::Moments m = cv::moments(piece);
    const double angle = 0.5 * std::atan2(2.0 * m.mu11, m.mu20 - m.mu02);
    middle = {m.m10 / m.m00, m.m01 / m.m00};
    across = {-std::sin(angle), std::cos(angle)};
  }
  [[nodiscard]] double beside(const cv::Point& p) const {
    return std::abs((Pixel(p.x, p.y) - middle).dot(across));
  }
};

/// Fills the gap between a finger's end and the rest: the hull of what both show of the gap.  What
/// lies farther beside the finger's axis than its end does is a neighbour, or the web between them.
void bridge(cv::Mat& fill, const Contour& rest, const Piece& piece, double gap) {
  const auto [from, to] = nearest(rest, piece.contour);
  const double reach = 1.6 * std::sqrt(squared(to - from)) + gap;
  const auto near = [&, a = from, b = to](const cv::Point& p) {
    return squared(p - a) < reach * reach && squared(p - b) < reach * reach;
  };
  const LongAxis axis(piece.contour);
  Contour around;
  double half_width = 0.0;
  for (const cv::Point& p : piece.contour) {
    if (!near(p)) continue;
    around.push_back(p);
    half_width = std::max(half_width, axis.beside(p));
  }
  for (const cv::Point& p : rest) {
    if (near(p) && axis.beside(p) <= half_width) around.push_back(p);
  }
  if (around.size() < 3) return;
  Contour hull;
  cv::convexHull(around, hull);
  cv::fillConvexPoly(fill, hull, 255);
}

Result<Outline> outline_from(const cv::Mat& fill) {
  auto found = pieces_of(fill);
  if (found.empty()) return fail(ErrorCode::NotFound, "hand", "nothing stands out from the ground");
  Piece& piece = found.front();
  inscribe(piece);
  Outline out;
  out.width = fill.cols;
  out.height = fill.rows;
  out.palm = Pixel(piece.centre.x, piece.centre.y);
  out.palm_radius = piece.radius;
  const bool clockwise = cv::contourArea(piece.contour, true) > 0.0;
  if (!clockwise) std::ranges::reverse(piece.contour);
  for (const cv::Point& p : piece.contour) out.points.emplace_back(p.x, p.y);
  return out;
}

std::size_t chosen(const std::vector<Piece>& pieces, const Pixel* inside) {
  std::size_t best = 0;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    if (inside != nullptr) {
      const cv::Point2f at(static_cast<float>(inside->x()), static_cast<float>(inside->y()));
      if (cv::pointPolygonTest(pieces[i].contour, at, false) >= 0) return i;
    }
    if (pieces[i].radius > pieces[best].radius) best = i;
  }
  return best;
}

/// True if the piece is no corner or edge of the ground: those touch the border and lie far away.
bool is_second_hand(const Piece& piece, const Piece& hand, cv::Size size) {
  if (piece.radius < kSecondHand * hand.radius) return false;
  const cv::Rect box = cv::boundingRect(piece.contour);
  Contour points;
  cv::convexHull(piece.contour, points);
  const double solidity = piece.area / std::max(1.0, cv::contourArea(points));
  const bool along_border =
      box.x <= 1 || box.y <= 1 || box.br().x >= size.width - 1 || box.br().y >= size.height - 1;
  return solidity < 0.85 || !along_border;
}

}  // namespace

Result<Outline> outline_of(const cv::Mat& mask, const Pixel* inside) {
  auto pieces = pieces_of(mask);
  for (Piece& piece : pieces) inscribe(piece);
  if (pieces.empty())
    return fail(ErrorCode::NotFound, "hand", "nothing stands out from the ground");
  const std::size_t main = chosen(pieces, inside);
  const Piece& hand = pieces[main];
  cv::Mat fill(mask.size(), CV_8U, cv::Scalar(0));
  cv::drawContours(fill, std::vector<Contour>{hand.contour}, 0, 255, cv::FILLED);
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    if (i == main) continue;
    if (is_second_hand(pieces[i], hand, mask.size()))
      return fail(ErrorCode::Conflict, "hand",
                  "there are two hands in the picture; scan one at a time");
    if (!is_finger_end(pieces[i], hand)) continue;
    const auto [from, to] = nearest(hand.contour, pieces[i].contour);
    if (squared(to - from) > std::pow(kWidestRing * hand.radius, 2)) continue;
    cv::drawContours(fill, std::vector<Contour>{pieces[i].contour}, 0, 255, cv::FILLED);
    bridge(fill, hand.contour, pieces[i], 0.12 * hand.radius);
  }
  return outline_from(fill);
}

Result<Outline> paper_outline(const cv::Mat& mask) {
  const auto pieces = pieces_of(mask);
  if (pieces.empty())
    return fail(ErrorCode::NotFound, "hand", "nothing stands out from the ground");
  cv::Mat fill(mask.size(), CV_8U, cv::Scalar(0));
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    if (i > 0 && pieces[i].area < kPaperPiece * static_cast<double>(mask.total())) continue;
    cv::drawContours(fill, std::vector<Contour>{pieces[i].contour}, 0, 255, cv::FILLED);
    if (i > 0) {
      const auto [from, to] = nearest(pieces.front().contour, pieces[i].contour);
      cv::line(fill, from, to, 255, 5);
    }
  }
  return outline_from(fill);
}

cv::Mat filled(const Outline& outline) {
  Contour contour;
  for (const Pixel& p : outline.points) contour.emplace_back(cvRound(p.x()), cvRound(p.y()));
  cv::Mat fill(outline.height, outline.width, CV_8U, cv::Scalar(0));
  if (!contour.empty()) cv::drawContours(fill, std::vector<Contour>{contour}, 0, 255, cv::FILLED);
  return fill;
}

double distance_inside(const cv::Mat& fill, const Pixel& from, const Pixel& direction) {
  constexpr double kStep = 0.25;  // [px]
  double gone = 0.0;
  for (;; gone += kStep) {
    const Pixel at = from + gone * direction;
    const int x = cvRound(at.x()), y = cvRound(at.y());
    if (x < 0 || y < 0 || x >= fill.cols || y >= fill.rows) break;
    if (fill.at<unsigned char>(y, x) == 0) break;
  }
  return gone;
}

}  // namespace chorus::hand
