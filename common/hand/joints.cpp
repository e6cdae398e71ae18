#include "common/hand/joints.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <opencv2/core.hpp>

#include "common/hand/anthropometry.h"
#include "common/hand/outline.h"
#include "common/hand/ring.h"

namespace chorus::hand {
namespace {

// From web to tip, as a share of the way from knuckle to tip: upper quartile of 24 photos of palms,
// because shadows between fingers fill webs (docs/benchmarks/hand.md).
constexpr std::array<double, kFingers> kFreePart{0.86, 0.85, 0.81, 0.80, 0.83};
// From the middle of the palm's circle to the wrist, in its radii.
constexpr double kWristBelow = 1.25;

Pixel upwards(const Outline& outline, const Fingers& fingers) {
  const Pixel up = 0.5 * (fingers[2].root() + fingers[3].root()) - outline.palm;
  return up.norm() > 0.0 ? Pixel(up.normalized()) : Pixel(0.0, -1.0);
}

}  // namespace

Joints joints_seen(const Fingers& fingers, const cv::Mat& fill, const SeenHand& seen) {
  Joints out = seen.joints;
  for (std::size_t f = 0; f < kFingers; ++f) {
    const FingerShape& finger = fingers[f];
    out[hand_joint(f, 3)] = finger.tip;
    if (finger.touching) continue;
    for (std::size_t i = f == 0 ? 2 : 1; i < 3; ++i) {
      const Pixel along =
          (seen.joints[hand_joint(f, i + 1)] - seen.joints[hand_joint(f, i - 1)]).normalized();
      out[hand_joint(f, i)] =
          centred(fill, seen.joints[hand_joint(f, i)], along, 1.6 * finger.width);
    }
  }
  return out;
}

Joints joints_usual(const Outline& outline, const Fingers& fingers) {
  Joints out;
  const Pixel up = upwards(outline, fingers);
  out[0] = outline.palm - kWristBelow * outline.palm_radius * up;
  for (std::size_t f = 0; f < kFingers; ++f) {
    const FingerShape& finger = fingers[f];
    const auto parts = parts_of(f);
    const double sum = f == 0 ? parts[1] + parts[2] : parts[0] + parts[1] + parts[2];
    const Pixel along = (finger.tip - finger.root()).normalized();
    const double length = finger.length() / kFreePart[f];
    double gone = 0.0;
    for (std::size_t i = 3; i-- > 0;) {
      out[hand_joint(f, i + 1)] = finger.tip - gone * along;
      gone += length * parts[i] / sum;
    }
    out[hand_joint(f, 0)] = finger.tip - gone * along;
  }
  // The thumb's metacarpal points to the wrist, not along its finger.
  const Pixel& knuckle = out[hand_joint(0, 1)];
  const double free = (out[hand_joint(0, 3)] - knuckle).norm();
  const double metacarpal = free * kBones[0].metacarpal / (kBones[0].proximal + kBones[0].tip());
  const Pixel aim = out[0] - knuckle;
  if (aim.norm() > 0.0)
    out[hand_joint(0, 0)] = knuckle + std::min(0.85, metacarpal / aim.norm()) * aim;
  return out;
}

Wrist wrist_of(const Outline& outline, const cv::Mat& fill, const Fingers& fingers) {
  const Pixel up = upwards(outline, fingers), across(-up.y(), up.x());
  const double radius = outline.palm_radius;
  Wrist out{outline.palm - kWristBelow * radius * up, false};
  std::vector<std::pair<double, Pixel>> widths;  // at steps below the palm's middle
  for (double down = 0.8; down < 2.6; down += 0.04) {
    const Pixel at = outline.palm - down * radius * up;
    const double one = distance_inside(fill, at, across),
                 other = distance_inside(fill, at, -across);
    if (one == 0.0 || on_border(outline, at)) break;
    const Pixel left = at + one * across, right = at - other * across;
    if (on_border(outline, left) || on_border(outline, right)) break;
    widths.emplace_back(one + other, at + 0.5 * (one - other) * across);
  }
  if (widths.size() < 5) return out;
  const auto least = std::ranges::min_element(widths, {}, &std::pair<double, Pixel>::first);
  // A minimum at the end is where the picture ends, not a wrist.
  if (std::distance(least, widths.end()) < 3) return out;
  return {least->second, true};
}

}  // namespace chorus::hand
