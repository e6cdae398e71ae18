#include "tests/support/hands/hand_figure.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/base/units.h"
#include "common/synthetic/draw.h"

namespace chorus::testing {
namespace {

using hand::hand_joint;
using hand::Pixel;
using synthetic::Draw;

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

}  // namespace

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

}  // namespace chorus::testing
