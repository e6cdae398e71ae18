#include "tests/bench/positioner/scene_pictures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <opencv2/imgproc.hpp>

#include "common/sensor/pixel_ray.h"

namespace chorus::bench {
namespace {

using enum JointId;

// Of skin against the clothes, of 255.  In grey pictures skin of 130 before a wall of 128 is not
// there; such a scene would measure the camouflage.
constexpr int kSkin = 165;

/// A limb: radii at its ends, the bulge of its muscle, how much broader than deep, and its shade
/// against the clothes'.
struct Limb {
  JointId from;
  JointId to;
  double from_radius;  ///< [m]
  double to_radius;
  double bulge;
  double breadth;
  int shade;
};
constexpr std::array kLimbs{Limb{SpineBase, SpineShoulder, 0.115, 0.105, 0.006, 1.55, 0},
                            Limb{SpineShoulder, Head, 0.065, 0.060, 0.0, 1.0, kSkin},
                            Limb{HipLeft, KneeLeft, 0.095, 0.066, 0.010, 1.0, 18},
                            Limb{HipRight, KneeRight, 0.095, 0.066, 0.010, 1.0, 18},
                            Limb{KneeLeft, AnkleLeft, 0.062, 0.050, 0.012, 1.0, 22},
                            Limb{KneeRight, AnkleRight, 0.062, 0.050, 0.012, 1.0, 22},
                            Limb{ShoulderLeft, ElbowLeft, 0.060, 0.052, 0.006, 1.0, -8},
                            Limb{ShoulderRight, ElbowRight, 0.060, 0.052, 0.006, 1.0, -8},
                            Limb{ElbowLeft, WristLeft, 0.050, 0.036, 0.004, 1.0, -5},
                            Limb{ElbowRight, WristRight, 0.050, 0.036, 0.004, 1.0, -5},
                            Limb{WristLeft, HandTipLeft, 0.038, 0.022, 0.008, 1.4, kSkin},
                            Limb{WristRight, HandTipRight, 0.038, 0.022, 0.008, 1.4, kSkin},
                            Limb{AnkleLeft, FootLeft, 0.050, 0.042, 0.004, 1.2, -20},
                            Limb{AnkleRight, FootRight, 0.050, 0.042, 0.004, 1.2, -20}};
constexpr int kStations = 9;
constexpr int kAround = 14;
constexpr double kHeadRadius = 0.098;  // [m]
constexpr double kHeadHeight = 1.25;   // Of the head, against its breadth.

class Painter {
 public:
  Painter(const ScenePicture& scene, cv::Mat& out)
      : camera_from_world_(Eigen::Isometry3d(camera_from_sensor_axes()) *
                           scene.world_from_sensor.inverse()),
        lens_(scene.lens),
        out_(out) {}

  /// Fills the hull of points of the world; nothing if one of them is not ahead of the camera.
  void fill(const std::vector<Eigen::Vector3d>& points, int shade) {
    std::vector<cv::Point> pixels;
    for (const Eigen::Vector3d& point : points) {
      const auto pixel = pixel_of(camera_from_world_ * point, lens_);
      constexpr double kFar = 2e4;
      if (!pixel || !(pixel->cwiseAbs().maxCoeff() < kFar)) return;
      pixels.emplace_back(static_cast<int>(std::lround(16.0 * pixel->x())),
                          static_cast<int>(std::lround(16.0 * pixel->y())));
    }
    std::vector<cv::Point> hull;
    cv::convexHull(pixels, hull);
    cv::fillConvexPoly(out_, hull, cv::Scalar(std::clamp(shade, 0, 255)), cv::LINE_8, 4);
  }

 private:
  Eigen::Isometry3d camera_from_world_;
  const Intrinsics& lens_;
  cv::Mat& out_;
};

using Ring = std::vector<Eigen::Vector3d>;

struct RingShape {
  Eigen::Vector3d centre, along, broad;
  double radius;
  double breadth;
};

Ring ring_of(const RingShape& shape) {
  const Eigen::Vector3d axis = shape.along.normalized();
  Eigen::Vector3d broad = shape.broad - axis * axis.dot(shape.broad);
  if (broad.norm() < 1e-6) broad = axis.unitOrthogonal();
  broad.normalize();
  const Eigen::Vector3d deep = axis.cross(broad);
  Ring out;
  for (int i = 0; i < kAround; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / kAround;
    out.push_back(shape.centre + shape.radius * (shape.breadth * std::cos(angle) * broad +
                                                 std::sin(angle) * deep));
  }
  return out;
}

void paint_limb(const ScenePerson& person, const Limb& limb, Painter& painter) {
  const Joint& a = person.body[limb.from];
  const Joint& b = person.body[limb.to];
  if (!a.seen() || !b.seen()) return;
  const Eigen::Vector3d broad = person.body[HipLeft].position - person.body[HipRight].position;
  Ring before;
  for (int i = 0; i < kStations; ++i) {
    const double t = i / (kStations - 1.0);
    // Cloth hangs: wider by up to 8 mm, differently along the limb.
    const double cloth = 0.004 + 0.004 * std::sin(7.0 * t + limb.from_radius * 100.0);
    const double radius = (1.0 - t) * limb.from_radius + t * limb.to_radius +
                          limb.bulge * std::sin(std::numbers::pi * t) + cloth;
    const Ring ring = ring_of({(1.0 - t) * a.position + t * b.position, b.position - a.position,
                               broad, person.girth * radius, limb.breadth});
    if (!before.empty()) {
      Ring both = before;
      both.insert(both.end(), ring.begin(), ring.end());
      painter.fill(both, person.shade + limb.shade + 3 * (i % 2));
    }
    before = ring;
  }
}

void paint_head(const ScenePerson& person, Painter& painter) {
  const Joint& head = person.body[Head];
  if (!head.seen()) return;
  Ring points;
  for (int i = 0; i < kAround; ++i) {
    for (int j = -3; j <= 3; ++j) {
      const double up = j * std::numbers::pi / 6.0;
      const double around = 2.0 * std::numbers::pi * i / kAround;
      points.push_back(head.position + person.girth * kHeadRadius *
                                           Eigen::Vector3d(std::cos(up) * std::cos(around),
                                                           kHeadHeight * std::sin(up),
                                                           std::cos(up) * std::sin(around)));
    }
  }
  painter.fill(points, person.shade + kSkin);
}

void paint_shadow(const ScenePicture& scene, const ScenePerson& person, cv::Mat& out) {
  if (scene.light.shadow <= 0.0) return;
  const Eigen::Vector3d at = person.body[SpineBase].position;
  Ring floor;
  for (int i = 0; i < kAround; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / kAround;
    floor.emplace_back(at.x() + 0.35 + 0.45 * std::cos(angle), 0.0,
                       at.z() - 0.1 + 0.2 * std::sin(angle));
  }
  cv::Mat where = cv::Mat::zeros(out.size(), CV_8U);
  Painter(scene, where).fill(floor, 255);
  cv::Mat darker = out * (1.0 - scene.light.shadow);
  darker.copyTo(out, where);
}

void paint_clutter(cv::Mat& out) {
  out.setTo(cv::Scalar(128));
  cv::RNG random(7);
  for (int i = 0; i < 60; ++i) {
    const int x = random.uniform(-40, out.cols);
    const int y = random.uniform(-40, out.rows);
    cv::rectangle(out, {x, y, random.uniform(15, 130), random.uniform(15, 110)},
                  cv::Scalar(random.uniform(60, 225)), cv::FILLED);
  }
  for (int i = 0; i < 40; ++i)
    cv::line(out, {random.uniform(0, out.cols), random.uniform(0, out.rows)},
             {random.uniform(0, out.cols), random.uniform(0, out.rows)},
             cv::Scalar(random.uniform(40, 240)), 2);
  cv::GaussianBlur(out, out, {3, 3}, 0.8);
}

void light_up(const SceneLight& light, cv::Mat& out) {
  if (light.chair_moved)
    cv::rectangle(out, {out.cols * 2 / 3, out.rows / 2, 60, 110}, cv::Scalar(35), cv::FILLED);
  if (light.lamp > 0.0) {
    cv::Mat part = out(cv::Rect(0, 0, out.cols / 3, out.rows));
    part += cv::Scalar(light.lamp);
  }
}

void cover_up(const SceneCover& cover, cv::Mat& out) {
  const auto at = [](double share, int size) {
    return static_cast<int>(std::lround(share * size));
  };
  cv::rectangle(out, {at(cover.left, out.cols), at(cover.top, out.rows)},
                {at(cover.right, out.cols), at(cover.bottom, out.rows)}, cv::Scalar(150),
                cv::FILLED);
}

}  // namespace

cv::Mat picture_of(const ScenePicture& scene) {
  cv::Mat out(scene.lens.height, scene.lens.width, CV_8U);
  paint_clutter(out);
  light_up(scene.light, out);
  Painter painter(scene, out);
  std::vector<const ScenePerson*> far_first;
  for (const ScenePerson& person : scene.people) far_first.push_back(&person);
  const Eigen::Vector3d eye = scene.world_from_sensor.translation();
  std::sort(far_first.begin(), far_first.end(), [&](const ScenePerson* a, const ScenePerson* b) {
    return (a->body[SpineBase].position - eye).norm() > (b->body[SpineBase].position - eye).norm();
  });
  for (const ScenePerson* person : far_first) {
    paint_shadow(scene, *person, out);
    for (const Limb& limb : kLimbs) paint_limb(*person, limb, painter);
    paint_head(*person, painter);
  }
  if (scene.cover) cover_up(*scene.cover, out);
  cv::RNG random(scene.seed);
  cv::Mat noise(out.size(), CV_16S);
  random.fill(noise, cv::RNG::NORMAL, 0, 4);
  cv::add(out, noise, out, cv::noArray(), CV_8U);
  return out;
}

}  // namespace chorus::bench
