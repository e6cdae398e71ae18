#include "tests/support/hands/hand_scene.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "common/base/units.h"
#include "common/synthetic/draw.h"
#include "tests/support/hands/hand_figure.h"

namespace chorus::testing {
namespace {

using hand::hand_joint;
using hand::Pixel;
using synthetic::Draw;
using Contour = std::vector<cv::Point>;

constexpr int kFine = 2;   // Drawn this much finer, then scaled down.
constexpr int kShift = 4;  // Fractional bits of coordinates.
constexpr double kSheetMm = 297.0;

/// Where the figure lies on the sheet: pixels of the picture from millimetres of the hand.
struct Placed {
  Pixel origin;
  double angle = 0.0;
  double scale = 1.0;
  double mirror = 1.0;

  [[nodiscard]] Pixel operator()(const Pixel& p) const {
    const double x = mirror * p.x() * scale, y = -p.y() * scale;
    return origin + Pixel(x * std::cos(angle) - y * std::sin(angle),
                          x * std::sin(angle) + y * std::cos(angle));
  }
};

void fill(cv::Mat& mask, const std::vector<Pixel>& shape, const Placed& placed) {
  if (shape.empty()) return;
  Contour points;
  for (const Pixel& p : shape) {
    const Pixel at = kFine * (placed(p) + Pixel(0.5, 0.5)) - Pixel(0.5, 0.5);
    points.emplace_back(cvRound(at.x() * (1 << kShift)), cvRound(at.y() * (1 << kShift)));
  }
  const std::vector<Contour> one{points};
  cv::fillPoly(mask, one, 255, cv::LINE_8, kShift);
}

/// The hand's fine mask: webs rounded by closing; a fist's knuckles, too.
cv::Mat mask_of(const Figure& figure, const HandScene& scene, const Placed& placed, cv::Size size) {
  cv::Mat mask(size * kFine, CV_8U, cv::Scalar(0));
  fill(mask, figure.palm, placed);
  for (std::size_t f = 0; f < 5; ++f) fill(mask, figure.outlines[f], placed);
  const double web =
      scene.thing == Thing::Mitten ? 12.0 : (scene.thing == Thing::Fist ? 8.0 : 2.5);  // [mm]
  const int side = 2 * cvRound(web * placed.scale * kFine) + 1;
  cv::morphologyEx(mask, mask, cv::MORPH_CLOSE,
                   cv::getStructuringElement(cv::MORPH_ELLIPSE, {side, side}));
  fill(mask, figure.forearm, placed);
  return mask;
}

cv::Mat ground_of(cv::Size size, bool dark, Draw& draw) {
  const double level = dark ? draw.uniform(18.0, 45.0) : draw.uniform(215.0, 248.0);
  const double slope = draw.uniform(-0.02, 0.02);
  cv::Mat out(size, CV_32FC3);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      const auto v = static_cast<float>(level + slope * (x - y));
      out.at<cv::Vec3f>(y, x) = {v + 2.0F, v, v - (dark ? 0.0F : 3.0F)};
    }
  }
  return out;
}

void noise(cv::Mat& picture, double sigma, std::uint64_t seed) {
  cv::RNG rng(seed * 7919 + 3);
  cv::Mat grain(picture.size(), picture.type());
  rng.fill(grain, cv::RNG::NORMAL, 0.0, sigma);
  picture += grain;
}

cv::Point pixel_of(const Pixel& p) { return {cvRound(p.x()), cvRound(p.y())}; }

/// Creases of the joints, lines of the palm, or nails.
void crease(cv::Mat& skin, const Figure& figure, const Placed& placed, bool back) {
  cv::Mat marks(skin.size(), CV_32FC3, cv::Scalar(0, 0, 0));
  const auto line = [&](const Pixel& from, const Pixel& to) {
    cv::line(marks, pixel_of(placed(from)), pixel_of(placed(to)), cv::Scalar(-24, -26, -26), 2);
  };
  for (std::size_t f = 0; f < 5; ++f) {
    for (std::size_t i = 1; i < 3; ++i) {
      const Pixel& a = figure.joints[hand_joint(f, i)];
      const Pixel along = (figure.joints[hand_joint(f, i + 1)] - a).normalized();
      const Pixel across(-along.y(), along.x());
      line(a + 6.0 * across, a - 6.0 * across);
    }
    const Pixel& tip = figure.joints[hand_joint(f, 3)];
    const Pixel along = (tip - figure.joints[hand_joint(f, 2)]).normalized();
    if (back)
      cv::circle(marks, pixel_of(placed(tip - 8.0 * along)), cvRound(5.0 * placed.scale),
                 cv::Scalar(22, 16, 22), cv::FILLED);
  }
  if (!back) line({30.0, 55.0}, {-30.0, 70.0});
  cv::GaussianBlur(marks, marks, {}, 0.8);
  skin += marks;
}

void blend(cv::Mat& picture, const cv::Mat& colour, const cv::Mat& fine) {
  cv::Mat alpha;
  cv::resize(fine, alpha, picture.size(), 0.0, 0.0, cv::INTER_AREA);
  for (int y = 0; y < picture.rows; ++y) {
    for (int x = 0; x < picture.cols; ++x) {
      const float a = static_cast<float>(alpha.at<unsigned char>(y, x)) / 255.0F;
      auto& p = picture.at<cv::Vec3f>(y, x);
      p = p * (1.0F - a) + colour.at<cv::Vec3f>(y, x) * a;
    }
  }
}

/// A band across the ring finger, as bright as a scanner's lamp makes it; or a sleeve.
void band(cv::Mat& picture, const std::vector<Pixel>& shape, const Placed& placed,
          const cv::Scalar& colour) {
  cv::Mat fine(picture.size() * kFine, CV_8U, cv::Scalar(0));
  fill(fine, shape, placed);
  blend(picture, cv::Mat(picture.size(), CV_32FC3, colour), fine);
}

void dress(cv::Mat& picture, const Figure& figure, const HandScene& scene, const Placed& placed) {
  if (scene.ring) {
    const Pixel& a = figure.joints[hand_joint(3, 0)];
    const Pixel& b = figure.joints[hand_joint(3, 1)];
    const Pixel along = (b - a).normalized(), across(-along.y(), along.x()),
                middle = a + 0.62 * (b - a);
    const double grey = scene.dark_ground ? 60.0 : 205.0;
    band(picture,
         {middle + 11.0 * across, middle - 11.0 * across, middle - 11.0 * across + 4.5 * along,
          middle + 11.0 * across + 4.5 * along},
         placed, {grey, grey, grey});
  }
  if (scene.sleeve)
    band(picture, {{-52, -38}, {52, -38}, {60, -280}, {-60, -280}}, placed, {120, 60, 40});
}

bool is_hand(const cv::Mat& fine, const Pixel& at) {
  return fine.at<unsigned char>(cvRound(kFine * at.y()), cvRound(kFine * at.x())) > 0;
}

/// Where the way from the middle of two knuckles to the middle of the tips leaves the hand.
Pixel web_between(const Figure& figure, const cv::Mat& fine, const Placed& placed,
                  std::pair<std::size_t, std::size_t> pair) {
  const auto middle = [&](std::size_t joint) {
    return Pixel(0.5 * (placed(figure.joints[hand_joint(pair.first, joint)]) +
                        placed(figure.joints[hand_joint(pair.second, joint)])));
  };
  Pixel at = middle(0);
  const Pixel way = (middle(3) - at).normalized();
  while (is_hand(fine, at)) at += 0.25 * way;
  return at;
}

/// The deepest point of the outline between the tips of thumb and index finger, seen from the line
/// through both.  That line ends at the tips, but the web may lie below its continuation.
Pixel web_of_thumb(const Figure& figure, const cv::Mat& fine, const Placed& placed) {
  const Pixel thumb = placed(figure.joints[hand_joint(0, 3)]),
              index = placed(figure.joints[hand_joint(1, 3)]);
  Pixel down = Pixel(thumb.y() - index.y(), index.x() - thumb.x()).normalized();
  if (down.dot(placed(figure.joints[0]) - thumb) < 0.0) down = -down;
  std::vector<Contour> contours;
  cv::findContours(fine, contours, cv::RETR_EXTERNAL, cv::CHAIN_APPROX_NONE);
  if (contours.empty()) return thumb;
  const Contour& hand = *std::ranges::max_element(
      contours, {}, [](const Contour& each) { return cv::contourArea(each); });
  const auto at = [&](std::size_t i) {
    const cv::Point& p = hand[i % hand.size()];
    return Pixel((Pixel(p.x, p.y) + Pixel(0.5, 0.5)) / kFine - Pixel(0.5, 0.5));
  };
  const auto nearest = [&](const Pixel& to) {
    std::size_t best = 0;
    for (std::size_t i = 1; i < hand.size(); ++i)
      if ((at(i) - to).norm() < (at(best) - to).norm()) best = i;
    return best;
  };
  // The way that does not go around the wrist is the shorter one.
  std::size_t from = nearest(thumb), to = nearest(index);
  if ((to + hand.size() - from) % hand.size() > hand.size() / 2) std::swap(from, to);
  Pixel deepest = at(from);
  for (std::size_t i = from; i % hand.size() != to; ++i)
    if ((at(i) - deepest).dot(down) > 0.0) deepest = at(i);
  return deepest;
}

/// From the height of the webs to the tip, along the finger, in the true mask.  Index and thumb
/// share a web that only the thumb's length is measured from.
double free_length(const Figure& figure, const cv::Mat& fine, const Placed& placed, std::size_t f) {
  const Pixel tip = placed(figure.joints[hand_joint(f, 3)]);
  const Pixel along = (tip - placed(figure.joints[hand_joint(f, f == 0 ? 1 : 0)])).normalized();
  if (f == 0) return (tip - web_of_thumb(figure, fine, placed)).dot(along);
  double sum = 0.0, count = 0.0;
  for (std::size_t other : {f - 1, f + 1}) {
    if (other == 0 || other > 4) continue;
    sum += (tip - web_between(figure, fine, placed, {f, other})).dot(along);
    count += 1.0;
  }
  return sum / count;
}

Placed placed_on(cv::Size size, const HandScene& scene, Draw& draw, bool back) {
  Placed out;
  out.scale = std::max(size.width, size.height) / kSheetMm;
  out.angle = scene.upright ? deg(draw.uniform(-8.0, 8.0)) : deg(draw.uniform(0.0, 360.0));
  out.mirror = back ? -1.0 : 1.0;
  const double middle = scene.thing == Thing::Foot ? 115.0 : 88.0;
  const Pixel centre(0.5 * size.width, 0.5 * size.height);
  Placed turn = out;
  turn.origin = Pixel::Zero();
  out.origin = centre - turn(Pixel(0.0, middle));
  return out;
}

/// Moves a hand along its fingers until the frame cuts one off, at least by a few millimetres.
void cut_by_frame(Placed& placed, const Figure& figure, cv::Size size) {
  constexpr double kFirst = 75.0, kStep = 2.0, kBeyond = 3.0;  // [mm]
  const Pixel start = placed.origin;
  Placed turn = placed;
  turn.origin = Pixel::Zero();
  const double beyond = kBeyond * placed.scale;
  const cv::Rect2d inside(-beyond, -beyond, size.width + 2.0 * beyond, size.height + 2.0 * beyond);
  for (double off = kFirst;; off += kStep) {
    placed.origin = start + turn(Pixel(0.0, off));
    for (std::size_t f = 0; f < hand::kFingers; ++f) {
      const Pixel tip = placed(figure.joints[hand_joint(f, 3)]);
      if (!inside.contains({tip.x(), tip.y()})) return;
    }
  }
}

}  // namespace

DrawnHand drawn_hand(const HandScene& scene) {
  Draw draw({scene.seed, 73});
  DrawnHand out;
  out.side = draw.uniform() < 0.5 ? hand::Side::Left : hand::Side::Right;
  out.back = draw.uniform() < 0.3;
  // A square picture of a turned hand is as wide as the sheet is long, so that tips stay inside.
  const cv::Size size(scene.upright ? cvRound(scene.long_side / std::sqrt(2.0)) : scene.long_side,
                      scene.long_side);
  const bool mirrored = (out.side == hand::Side::Left) != out.back;
  Placed placed = placed_on(size, scene, draw, mirrored);
  out.pixels_per_mm = placed.scale;
  cv::Mat picture = ground_of(size, scene.dark_ground, draw);
  const cv::Scalar tone(draw.uniform(95.0, 140.0), draw.uniform(125.0, 160.0),
                        draw.uniform(175.0, 215.0));
  if (scene.thing != Thing::Nothing) {
    const Figure figure = scene.thing == Thing::Foot ? foot_of(scene) : figure_of(scene);
    if (scene.thing == Thing::Cut) cut_by_frame(placed, figure, size);
    cv::Mat skin(size, CV_32FC3, tone), fine = mask_of(figure, scene, placed, size);
    if (scene.thing == Thing::TwoHands) {
      Placed beside = placed, here = placed;
      beside.scale = here.scale = 0.55 * placed.scale;
      here.origin = Pixel(0.28 * size.width, 0.7 * size.height);
      beside.origin = Pixel(0.75 * size.width, 0.7 * size.height);
      here.angle = beside.angle = 0.0;
      beside.mirror = -beside.mirror;
      fine = mask_of(figure, scene, here, size) | mask_of(figure, scene, beside, size);
    } else if (scene.thing == Thing::Hand) {
      crease(skin, figure, placed, out.back);
      for (std::size_t f = 0; f < hand::kFingers; ++f)
        out.free[f] = free_length(figure, fine, placed, f);
    }
    for (std::size_t i = 0; i < hand::kHandJoints; ++i) out.joints[i] = placed(figure.joints[i]);
    noise(skin, 5.0 * scene.grain, scene.seed);
    blend(picture, skin, fine);
    dress(picture, figure, scene, placed);
  }
  if (scene.thing == Thing::Blurred) cv::GaussianBlur(picture, picture, {}, 3.2 * placed.scale);
  noise(picture, 2.0 * scene.grain, scene.seed + 1);
  picture.convertTo(out.picture, CV_8UC3);
  if (scene.jpeg) {
    std::vector<unsigned char> bytes;
    cv::imencode(".jpg", out.picture, bytes, {cv::IMWRITE_JPEG_QUALITY, 70});
    out.picture = cv::imdecode(bytes, cv::IMREAD_COLOR);
  }
  return out;
}

}  // namespace chorus::testing
