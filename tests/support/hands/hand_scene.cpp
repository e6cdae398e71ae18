#include "tests/support/hands/hand_scene.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "common/base/units.h"
#include "common/synthetic/draw.h"

namespace chorus::testing {
namespace {

using hand::hand_joint;
using hand::Pixel;
using synthetic::Draw;
using Contour = std::vector<cv::Point>;

constexpr int kFine = 2;   // Drawn this much finer, then scaled down.
constexpr int kShift = 4;  // Fractional bits of coordinates.
constexpr double kSheetMm = 297.0;

// A right hand on its palm's side [mm]: x towards the thumb, y towards the fingers, from the wrist.
struct DrawnFinger {
  double x, y, angle_deg;       // Knuckle (the thumb: CMC), and its direction from +y.
  std::array<double, 3> bones;  // As long as some people's.
  double width;
};
constexpr std::array<DrawnFinger, 5> kDrawn{{{23, 24, 52, {43, 34, 29}, 21},
                                             {25, 88, 11, {43, 25, 22}, 18},
                                             {4, 92, 1, {47, 30, 23}, 18.5},
                                             {-15, 87, -8, {43, 28, 23}, 17},
                                             {-31, 77, -19, {34, 20, 20}, 15}}};

struct Figure {
  std::array<Pixel, hand::kHandJoints> joints{};
  std::array<std::vector<Pixel>, 5> outlines;
  std::vector<Pixel> palm;
  std::vector<Pixel> forearm;
};

Pixel turned(double degrees) { return {std::sin(deg(degrees)), std::cos(deg(degrees))}; }

/// Half the width along a finger, 0 at its knuckle, 1 at its tip: bulges at both joints, blunt at
/// the end.
double half_width(double s, double width) {
  const double bulge = 0.05 * std::exp(-std::pow((s - 0.45) / 0.06, 2)) +
                       0.04 * std::exp(-std::pow((s - 0.74) / 0.05, 2));
  const double taper = 1.12 - 0.22 * s;
  const double end =
      s > 0.88 ? std::pow(std::max(0.0, 1.0 - std::pow((s - 0.88) / 0.12, 2.4)), 1.0 / 2.4) : 1.0;
  return 0.5 * width * (taper + bulge) * end;
}

/// The outline of a finger along its bent bones.
std::vector<Pixel> finger_outline(const std::array<Pixel, 4>& chain, double width) {
  std::array<double, 4> at{};
  for (std::size_t i = 1; i < 4; ++i) at[i] = at[i - 1] + (chain[i] - chain[i - 1]).norm();
  std::vector<Pixel> left, right;
  constexpr int kSteps = 160;
  for (int k = 0; k <= kSteps; ++k) {
    const double s = static_cast<double>(k) / kSteps, length = s * at[3];
    std::size_t i = 1;
    while (i < 3 && at[i] < length) ++i;
    const Pixel along = (chain[i] - chain[i - 1]).normalized(), across(-along.y(), along.x());
    const Pixel middle = chain[i - 1] + (length - at[i - 1]) * along;
    left.push_back(middle + half_width(s, width) * across);
    right.push_back(middle - half_width(s, width) * across);
  }
  left.insert(left.end(), right.rbegin(), right.rend());
  return left;
}

double spread_of(Thing thing, Draw& draw) {
  if (thing == Thing::ClosedFingers || thing == Thing::Mitten) return -1.0;
  return draw.uniform(0.95, 1.9);
}

Figure figure_of(const HandScene& scene) {
  // Without a person each picture shows another hand: body and pose then come from one stream.
  Draw body({scene.person == 0 ? scene.seed : scene.person, 71});
  Draw shot({scene.seed, 75});
  Draw& pose = scene.person == 0 ? body : shot;
  Figure out;
  const double spread = spread_of(scene.thing, pose);
  const double size = body.uniform(0.86, 1.12);
  const double thumb = scene.thing == Thing::HiddenThumb ? -60.0 : pose.uniform(-12.0, 18.0);
  for (std::size_t f = 0; f < 5; ++f) {
    const DrawnFinger& drawn = kDrawn[f];
    double angle = f == 0 ? drawn.angle_deg + thumb
                          : drawn.angle_deg * std::max(0.0, spread) + pose.uniform(-1.5, 1.5);
    std::array<Pixel, 4> chain;
    chain[0] = size * Pixel(drawn.x, drawn.y);
    const double bones = scene.thing == Thing::Fist ? 0.25 : 1.0;
    for (std::size_t i = 0; i < 3; ++i) {
      chain[i + 1] =
          chain[i] + size * bones * drawn.bones[i] * body.uniform(0.92, 1.08) * turned(angle);
      angle += (f == 0 ? -1.0 : 1.0) * pose.uniform(-1.0, 4.0) * (f == 0 || f > 2 ? 1.0 : -0.5);
    }
    for (std::size_t i = 0; i < 4; ++i) out.joints[hand_joint(f, i)] = chain[i];
    double width = size * drawn.width * body.uniform(0.92, 1.1);
    if (spread < 0.0) width *= 1.35;
    out.outlines[f] = finger_outline(chain, width);
  }
  for (const auto& [x, y] : {std::pair{27.0, 0.0},
                             {31.0, 14.0},
                             {40.0, 40.0},
                             {33.0, 70.0},
                             {33.0, 90.0},
                             {22.0, 99.0},
                             {4.0, 103.0},
                             {-16.0, 98.0},
                             {-33.0, 88.0},
                             {-40.0, 74.0},
                             {-42.0, 45.0},
                             {-34.0, 14.0},
                             {-29.0, 0.0}})
    out.palm.emplace_back(size * x, size * y);
  for (const auto& [x, y] : {std::pair{27.0, 2.0},
                             {-29.0, 2.0},
                             {-30.0, -20.0},
                             {-36.0, -260.0},
                             {34.0, -260.0},
                             {28.0, -20.0}})
    out.forearm.emplace_back(size * x, size * y);
  return out;
}

/// Five toes on a sole.
Figure foot_of(const HandScene& scene) {
  Draw draw({scene.seed, 72});
  Figure out;
  constexpr std::array kX{28.0, 6.0, -11.0, -26.0, -39.0}, kY{205.0, 210.0, 200.0, 186.0, 170.0};
  constexpr std::array kLong{48.0, 38.0, 34.0, 30.0, 26.0}, kWide{31.0, 18.0, 16.0, 15.0, 15.0};
  for (std::size_t f = 0; f < 5; ++f) {
    const Pixel root(kX[f], kY[f]),
        along = turned(draw.uniform(-4.0, 4.0) + 3.0 * (1.0 - static_cast<double>(f)));
    out.outlines[f] = finger_outline({root, root + 0.4 * kLong[f] * along,
                                      root + 0.7 * kLong[f] * along, root + kLong[f] * along},
                                     kWide[f]);
  }
  for (const auto& [x, y] : {std::pair{20.0, 0.0},
                             {30.0, 30.0},
                             {26.0, 90.0},
                             {44.0, 170.0},
                             {40.0, 222.0},
                             {10.0, 226.0},
                             {-30.0, 200.0},
                             {-47.0, 178.0},
                             {-46.0, 140.0},
                             {-36.0, 60.0},
                             {-30.0, 20.0},
                             {-12.0, -6.0}})
    out.palm.emplace_back(x, y);
  return out;
}

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

/// The web beside the thumb is wide: its deepest point, seen from the line between both tips.
Pixel web_of_thumb(const Figure& figure, const cv::Mat& fine, const Placed& placed) {
  constexpr int kSteps = 400;
  const Pixel from = placed(figure.joints[hand_joint(0, 3)]),
              to = placed(figure.joints[hand_joint(1, 3)]);
  Pixel down = Pixel(from.y() - to.y(), to.x() - from.x()).normalized();
  if (down.dot(placed(figure.joints[0]) - from) < 0.0) down = -down;
  Pixel deepest = from;
  double most = 0.0;
  for (int k = 1; k < kSteps; ++k) {
    const Pixel begin = from + (to - from) * k / kSteps;
    Pixel at = begin;
    const cv::Rect2d picture(1, 1, fine.cols / kFine - 2, fine.rows / kFine - 2);
    while (picture.contains({at.x(), at.y()}) && !is_hand(fine, at)) at += 0.25 * down;
    const double depth = (at - begin).norm();
    if (picture.contains({at.x(), at.y()}) && depth > most) most = depth, deepest = at;
  }
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
  const double off = scene.thing == Thing::Cut ? 75.0 : 0.0;
  const Pixel centre(0.5 * size.width, 0.5 * size.height);
  Placed turn = out;
  turn.origin = Pixel::Zero();
  out.origin = centre - turn(Pixel(0.0, middle - off));
  return out;
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
  const Placed placed = placed_on(size, scene, draw, mirrored);
  out.pixels_per_mm = placed.scale;
  cv::Mat picture = ground_of(size, scene.dark_ground, draw);
  const cv::Scalar tone(draw.uniform(95.0, 140.0), draw.uniform(125.0, 160.0),
                        draw.uniform(175.0, 215.0));
  if (scene.thing != Thing::Nothing) {
    const Figure figure = scene.thing == Thing::Foot ? foot_of(scene) : figure_of(scene);
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
