#include "common/hand/glove.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <Eigen/Dense>
#include <opencv2/imgproc.hpp>

#include "common/base/median.h"
#include "common/hand/capsules.h"

namespace chorus::hand {
namespace {

using Contour = std::vector<cv::Point>;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kNearest = 0.05;        // Nothing is rendered nearer to the camera [m].
constexpr int kSubpixel = 4;             // fractional bits of OpenCV's coordinates
constexpr double kCircleSigma = 0.5;     // of a radius [px]
constexpr double kCircleEnough = 0.003;  // of a step of the circles [m]
constexpr double kOutlineSigma = 1.0;    // of an outline's place [px], ...
constexpr double kIndependent = 15.0;    // ... and one point in this many errs by itself

Vector2d projected(const Vector3d& x, const Intrinsics& camera) {
  return {camera.cx + camera.fx * x.x() / x.z(), camera.cy + camera.fy * x.y() / x.z()};
}

cv::Point fine(const Vector2d& p) {
  return {cvRound(p.x() * (1 << kSubpixel)), cvRound(p.y() * (1 << kSubpixel))};
}

/// Points around the picture of a ball.
void add_rim(const Ball& ball, const Intrinsics& camera, Contour& out) {
  constexpr int kSides = 16;
  if (ball.centre.z() < kNearest) return;
  const Vector2d middle = projected(ball.centre, camera);
  const double radius = ball.radius * camera.fx / ball.centre.z();
  for (int k = 0; k < kSides; ++k) {
    const double angle = 2.0 * 3.14159265358979 * k / kSides;
    out.push_back(fine(middle + radius * Vector2d(std::cos(angle), std::sin(angle))));
  }
}

void fill_hull(cv::Mat& mask, const Contour& points) {
  if (points.size() < 3) return;
  Contour hull;
  cv::convexHull(points, hull);
  cv::fillConvexPoly(mask, hull, 255, cv::LINE_8, kSubpixel);
}

/// The value where a parabola through three values has its maximum, from the middle: [-0.5, 0.5].
double peak(double before, double at, double after) {
  const double bend = before - 2.0 * at + after;
  return bend < 0.0 ? std::clamp(0.5 * (before - after) / bend, -0.5, 0.5) : 0.0;
}

/// Eqs. (3) and (4), once: `wrist` is P_t, the circles are I_t (template) and I_t' (image).
Vector3d aligned(const Vector3d& wrist, const Circle& model, const Circle& image,
                 const Intrinsics& camera) {
  const double depth = wrist.z();  // "with a constant depth"
  const auto unprojected = [&](const Vector2d& p) {
    return Vector3d(depth * (p.x() - camera.cx) / camera.fx,
                    depth * (p.y() - camera.cy) / camera.fy, depth);
  };
  const Vector3d i_model = unprojected(model.centre), i_image = unprojected(image.centre);
  const double delta =
      i_model.norm() / std::max(1e-6, wrist.norm());           // d(C, I_t) / d(C, P_t), C = 0
  const Vector3d moved = wrist + delta * (i_image - i_model);  // Eq. (3)
  const double rho = model.radius / image.radius;
  return rho * moved;  // Eq. (4)
}

/// Distance to the mask's outline, which lies half-way between its pixels and others; negative
/// inside.
cv::Mat signed_distance(const cv::Mat& mask) {
  cv::Mat outside, inside, inverse;
  cv::bitwise_not(mask, inverse);
  cv::distanceTransform(inverse, outside, cv::DIST_L2, cv::DIST_MASK_5);
  cv::distanceTransform(mask, inside, cv::DIST_L2, cv::DIST_MASK_5);
  cv::Mat half;
  mask.convertTo(half, CV_32F, 1.0 / 255.0, -0.5);  // 0.5 inside, -0.5 outside
  return outside - inside + half;
}

struct Normal {
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Zero();
  Vector3d vector = Vector3d::Zero();
  std::vector<double> distances;
};

std::vector<Contour> contours_of(const cv::Mat& mask) {
  std::vector<Contour> out;
  cv::findContours(mask, out, cv::RETR_EXTERNAL, cv::CHAIN_APPROX_NONE);
  return out;
}

/// Adds one outline's equations in the other's distances.  `sign`: 1 when the outline is the
/// template's, which moves; -1 when it is the image's, and the distances move.  All points are
/// taken to be as far away as the wrist: that scales their derivatives, not the place where the
/// distances are least.
void add_outline(const cv::Mat& distance, const std::vector<Contour>& contours, double sign,
                 const Vector3d& wrist, const Intrinsics& camera, Normal& out) {
  constexpr double kCauchy = 4.0;  // [px]
  const double z = wrist.z(), fx = camera.fx / z, fy = camera.fy / z;
  for (const Contour& contour : contours) {
    for (const cv::Point& p : contour) {
      if (p.x < 2 || p.y < 2 || p.x >= distance.cols - 2 || p.y >= distance.rows - 2) continue;
      const double r = distance.at<float>(p.y, p.x);
      const double gx = 0.5 * (distance.at<float>(p.y, p.x + 1) - distance.at<float>(p.y, p.x - 1));
      const double gy = 0.5 * (distance.at<float>(p.y + 1, p.x) - distance.at<float>(p.y - 1, p.x));
      const Vector3d row =
          sign * Vector3d(gx * fx, gy * fy, -(gx * (p.x - camera.cx) + gy * (p.y - camera.cy)) / z);
      const double weight = 1.0 / (1.0 + r * r / (kCauchy * kCauchy));
      out.matrix += weight * row * row.transpose();
      out.vector += weight * r * row;
      out.distances.push_back(std::abs(r));
    }
  }
}

/// The part of a picture around a mask, and the camera that takes it.
struct GlovePart {
  cv::Mat mask;
  Intrinsics camera;
};

GlovePart around(const cv::Mat& mask, const Intrinsics& camera) {
  constexpr int kMargin = 32;  // The template lies so near when its refinement begins [px].
  const cv::Rect box = cv::boundingRect(mask);
  const cv::Rect wide(box.x - kMargin, box.y - kMargin, box.width + 2 * kMargin,
                      box.height + 2 * kMargin);
  const cv::Rect part = wide & cv::Rect(0, 0, mask.cols, mask.rows);
  GlovePart out{mask(part), camera};
  out.camera.cx -= part.x;
  out.camera.cy -= part.y;
  out.camera.width = part.width;
  out.camera.height = part.height;
  return out;
}

/// Gauss-Newton on the distances of each outline from the other.  Distances of the template's
/// outline alone would pull it smaller: a finger that is too long is seen by all of its tip, one
/// that is too short only by the tip's very end, because its sides are nearer to the sides.
void refine_place(GlovePlace& place, const GlovePart& seen, PosedGlove glove) {
  constexpr int kSteps = 6;
  constexpr double kFarthestStep = 0.05, kEnough = 5e-4;  // [m]
  const cv::Mat distance = signed_distance(seen.mask);
  const auto outline = contours_of(seen.mask);
  for (int i = 0; i < kSteps; ++i) {
    glove.pose.wrist = place.wrist;
    const cv::Mat model = silhouette(glove.skeleton, glove.pose, seen.camera);
    Normal normal;
    add_outline(distance, contours_of(model), 1.0, place.wrist, seen.camera, normal);
    add_outline(signed_distance(model), outline, -1.0, place.wrist, seen.camera, normal);
    if (normal.distances.size() < 40) return;
    place.residual = median(normal.distances);
    const double damping = 1e-6 * normal.matrix.trace();
    const Eigen::Matrix3d matrix = normal.matrix + damping * Eigen::Matrix3d::Identity();
    Vector3d step = -matrix.ldlt().solve(normal.vector);
    if (step.norm() > kFarthestStep) step *= kFarthestStep / step.norm();
    if (place.wrist.z() + step.z() < 2.0 * kNearest) return;
    place.wrist += step;
    // Both outlines tell the same twice; outlines that do not fit tell less.
    const double sigma = std::max(kOutlineSigma, place.residual);
    place.covariance = 2.0 * sigma * sigma * kIndependent * matrix.inverse();
    if (step.norm() < kEnough) return;
  }
}

/// What the circle and the size leave open: the depth, all the more the more the palm is seen from
/// its edge.
void widen(GlovePlace& place, double radius, const Intrinsics& camera,
           const GloveOptions& options) {
  constexpr double kLeastFacing = 0.15;
  const Vector3d sight = place.wrist.normalized();
  const double depth = place.wrist.norm();
  const double facing = std::max(kLeastFacing, place.facing);
  const double by_size = options.size_sigma * depth;
  const double by_edge = kCircleSigma / radius * depth * (1.0 / facing - 1.0);
  // Finger angles that are some degrees off move the outline's middle, near or far alike.
  constexpr double kPoseSigma = 0.001;  // [m]
  place.covariance += (by_size * by_size + by_edge * by_edge) * sight * sight.transpose() +
                      kPoseSigma * kPoseSigma * Eigen::Matrix3d::Identity();
  if (options.refine) return;
  const double by_circle = kCircleSigma / radius * depth / facing, across = depth / camera.fx * 2.0;
  place.covariance += by_circle * by_circle * sight * sight.transpose() +
                      across * across * Eigen::Matrix3d::Identity();
}

}  // namespace

bool is_usable(const PosedGlove& glove) {
  if (!(glove.skeleton.palm_radius > 0.0) || !std::isfinite(glove.skeleton.palm_radius))
    return false;
  for (const auto& joint : glove.skeleton.joints) {
    if (!joint.allFinite()) return false;
  }
  for (const auto& turn : glove.pose.local) {
    if (!turn.coeffs().allFinite() || std::abs(turn.norm() - 1.0) > 0.01) return false;
  }
  return glove.pose.turn.coeffs().allFinite() && std::abs(glove.pose.turn.norm() - 1.0) < 0.01;
}

tl::unexpected<Error> no_pose() {
  return fail(ErrorCode::InvalidArgument, "glove",
              "has a pose or a skeleton that is none: not finite, or no rotations");
}

double facing_of(const PosedGlove& glove, const Eigen::Vector3d& wrist) {
  return std::abs((glove.pose.turn * Vector3d::UnitZ()).dot(wrist.normalized()));
}

std::optional<Circle> inscribed(const cv::Mat& mask) {
  if (mask.empty()) return std::nullopt;
  const cv::Rect box = cv::boundingRect(mask);
  if (box.area() == 0) return std::nullopt;
  // The picture's border does not bound the hand; a margin of zeros outside the box does.
  cv::Mat part, distance;
  cv::copyMakeBorder(mask(box), part, 1, 1, 1, 1, cv::BORDER_CONSTANT, 0);
  cv::distanceTransform(part, distance, cv::DIST_L2, cv::DIST_MASK_PRECISE);
  double radius = 0.0;
  cv::Point at;
  cv::minMaxLoc(distance, nullptr, &radius, nullptr, &at);
  if (radius < 1.0) return std::nullopt;
  const auto value = [&](int dx, int dy) {
    return static_cast<double>(distance.at<float>(at.y + dy, at.x + dx));
  };
  const double dx = peak(value(-1, 0), radius, value(1, 0)),
               dy = peak(value(0, -1), radius, value(0, 1));
  const double rise =
      0.25 * (dx * (value(1, 0) - value(-1, 0)) + dy * (value(0, 1) - value(0, -1)));
  return Circle{{at.x - 1 + box.x + dx, at.y - 1 + box.y + dy}, radius + rise};
}

cv::Mat glove_mask(const cv::Mat& grey, const GloveOptions& options) {
  cv::Mat mask = grey <= options.darkest, labels, stats, centres;
  cv::medianBlur(mask, mask, options.median | 1);
  const int count = cv::connectedComponentsWithStats(mask, labels, stats, centres, 8, CV_32S);
  cv::Mat best(mask.size(), CV_8U, cv::Scalar(0));
  double largest = 0.0;
  for (int i = 1; i < count; ++i) {
    if (stats.at<int>(i, cv::CC_STAT_AREA) < 200) continue;
    const cv::Mat piece = labels == i;
    const auto circle = inscribed(piece);
    if (!circle || circle->radius <= largest) continue;
    largest = circle->radius;
    best = piece;
  }
  return best;
}

cv::Mat silhouette(const Skeleton& skeleton, const Pose& pose, const Intrinsics& camera) {
  cv::Mat out(camera.height, camera.width, CV_8U, cv::Scalar(0));
  const Capsules hand = capsules_of(skeleton, pose);
  for (const auto& [one, other] : hand.fingers) {
    Contour points;
    add_rim(one, camera, points);
    add_rim(other, camera, points);
    fill_hull(out, points);
  }
  Contour points;
  for (const Ball& ball : hand.palm) add_rim(ball, camera, points);
  fill_hull(out, points);
  return out;
}

Result<GlovePlace> place_glove(const cv::Mat& mask, const PosedGlove& glove,
                               const Intrinsics& camera, const GloveOptions& options) {
  if (!is_usable(glove)) return no_pose();
  const auto image = inscribed(mask);
  if (!image)
    return fail(ErrorCode::NotFound, "glove", "nothing in the picture is as dark as a glove");
  GlovePlace out;
  out.residual = std::numeric_limits<double>::quiet_NaN();
  out.wrist = options.start;
  Pose pose = glove.pose;
  for (int i = 0; i < options.iterations; ++i) {
    pose.wrist = out.wrist;
    const auto model = inscribed(silhouette(glove.skeleton, pose, camera));
    if (!model) return fail(ErrorCode::NotFound, "glove", "is outside the picture");
    const Vector3d before = out.wrist;
    out.wrist = aligned(out.wrist, *model, *image, camera);
    // What is left is for the refinement.
    if (options.refine && (out.wrist - before).norm() < kCircleEnough) break;
  }
  out.facing = facing_of(glove, out.wrist);
  if (options.refine) refine_place(out, around(mask, camera), glove);
  widen(out, image->radius, camera, options);
  return out;
}

}  // namespace chorus::hand
