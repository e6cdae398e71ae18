#include "tests/support/hands/glove_scene.h"

#include <cmath>

#include <opencv2/imgproc.hpp>

#include "common/base/units.h"
#include "common/hand/hand_json.h"
#include "common/synthetic/draw.h"

namespace chorus::testing {
namespace {

using Eigen::Vector3d;
using hand::hand_joint;

constexpr int kFiner = 3;  // Rendered this much finer.

class Canvas {
 public:
  explicit Canvas(const Intrinsics& camera)
      : camera_(camera),
        mask_(camera.height * kFiner, camera.width * kFiner, CV_8U, cv::Scalar(0)) {}

  void ball(const Vector3d& at, double radius) {
    if (at.z() < 0.05) return;
    const double u = camera_.cx + camera_.fx * at.x() / at.z(),
                 v = camera_.cy + camera_.fy * at.y() / at.z();
    cv::circle(mask_, {cvRound(kFiner * (u + 0.5) - 0.5), cvRound(kFiner * (v + 0.5) - 0.5)},
               cvRound(kFiner * radius * camera_.fx / at.z()), 255, cv::FILLED);
  }

  [[nodiscard]] cv::Mat alpha() const {
    cv::Mat out;
    cv::resize(mask_, out, {camera_.width, camera_.height}, 0.0, 0.0, cv::INTER_AREA);
    return out;
  }

 private:
  Intrinsics camera_;
  cv::Mat mask_;
};

void draw_finger(Canvas& canvas, const std::array<Vector3d, 4>& chain, double width) {
  for (std::size_t i = 1; i < 4; ++i) {
    for (int k = 0; k <= 30; ++k) {
      const double s = k / 30.0, along = static_cast<double>(i - 1) + s;
      const double bulge = 1.0 + 0.07 * std::cos(2.0 * 3.14159265 * s);  // thicker at the joints
      double radius = 0.5 * width * (1.08 - 0.075 * along) * bulge;
      Vector3d at = chain[i - 1] + s * (chain[i] - chain[i - 1]);
      if (i == 3) {
        // The last ball's rim is the tip.
        const Vector3d last = chain[3] - chain[2];
        at = chain[2] + s * (1.0 - radius / std::max(1e-3, last.norm())) * last;
      }
      canvas.ball(at, radius);
    }
  }
}

void draw_palm(Canvas& canvas, const hand::Skeleton& skeleton, const hand::Pose& pose,
               double size) {
  const auto placed = [&](double x, double y, double z) {
    return Vector3d(pose.wrist + size * (pose.turn * Vector3d(x, y, z)));
  };
  const double wide = skeleton.palm_radius, high = skeleton.joints[hand_joint(2, 0)].y(),
               middle = skeleton.palm.x();
  for (int i = -20; i <= 20; ++i) {
    for (int k = 0; k <= 30; ++k) {
      const double s = k / 30.0, half = wide * (0.66 + 0.34 * std::sin(1.9 * s)) - 0.0125;
      canvas.ball(placed(middle * s + half * i / 20.0, s * high * 1.02, 0.0), size * 0.0135);
    }
  }
  const double thumb = skeleton.side == hand::Side::Right ? 1.0 : -1.0;
  for (int k = 0; k <= 10; ++k)  // the ball of the thumb
    canvas.ball(placed(thumb * 0.55 * wide, 0.12 * high + 0.03 * high * k, 0.006), size * 0.0155);
}

hand::Pose drawn_pose(const hand::Skeleton& skeleton, const GloveScene& scene,
                      synthetic::Draw& draw) {
  hand::Pose out;
  // The palm to the camera, fingers up: x right, +y of the hand is -y of the camera, +z of the palm
  // is -z.
  const Eigen::Quaterniond facing(Eigen::AngleAxisd(3.14159265358979, Vector3d::UnitX()));
  const Vector3d axis = Vector3d(draw.gauss(), draw.gauss(), 0.0).normalized();
  const Eigen::Quaterniond away(Eigen::AngleAxisd(draw.uniform(0.0, scene.tilt), axis));
  const Eigen::Quaterniond about(Eigen::AngleAxisd(draw.uniform(-0.8, 0.8), Vector3d::UnitZ()));
  out.turn = (away * about * facing).normalized();
  const double bend = draw.uniform(0.0, deg(35.0));
  for (std::size_t f = 0; f < hand::kFingers; ++f) {
    for (std::size_t i = f == 0 ? 1 : 0; i < 3; ++i) {
      const double angle = f == 0 ? 0.3 * bend : bend * draw.uniform(0.4, 1.2);
      out.local[hand_joint(f, i)] = Eigen::AngleAxisd(angle, Vector3d::UnitX());
    }
  }
  const double side = 0.25 * scene.distance;
  const Vector3d palm(draw.uniform(-side, side), draw.uniform(-0.6 * side, 0.6 * side),
                      scene.distance);
  out.wrist = palm - scene.size * (out.turn * skeleton.palm);
  return out;
}

void paint(cv::Mat& grey, const cv::Mat& alpha, const GloveScene& scene, synthetic::Draw& draw) {
  grey = cv::Mat(alpha.size(), CV_32F, cv::Scalar(150.0));
  for (int i = 0; i < 12; ++i) {
    const cv::Point from(cvRound(draw.uniform(0, grey.cols)), cvRound(draw.uniform(0, grey.rows)));
    const cv::Size size(cvRound(draw.uniform(30, 200)), cvRound(draw.uniform(30, 200)));
    cv::rectangle(grey, {from, size}, cv::Scalar(draw.uniform(95.0, 230.0)), cv::FILLED);
  }
  if (scene.clutter) {
    for (int i = 0; i < 3; ++i) {
      const cv::Point from(i % 2 == 0 ? 5 : grey.cols - 40,
                           cvRound(draw.uniform(0, 0.8 * grey.rows)));
      cv::rectangle(grey, {from, cv::Size(30, 60)}, cv::Scalar(25.0), cv::FILLED);
    }
  }
  for (int y = 0; y < grey.rows; ++y) {
    for (int x = 0; x < grey.cols; ++x) {
      const float a = static_cast<float>(alpha.at<unsigned char>(y, x)) / 255.0F;
      grey.at<float>(y, x) = grey.at<float>(y, x) * (1.0F - a) + 28.0F * a;
    }
  }
  cv::GaussianBlur(grey, grey, {}, 0.8);
  cv::RNG rng(scene.seed * 977 + 5);
  cv::Mat grain(grey.size(), CV_32F);
  rng.fill(grain, cv::RNG::NORMAL, 0.0, 3.0);
  grey += grain;
  grey.convertTo(grey, CV_8U);
}

}  // namespace

SeenGlove seen_glove(const hand::Skeleton& skeleton, const GloveScene& scene,
                     const std::optional<hand::Pose>& posed) {
  synthetic::Draw draw({scene.seed, 79});
  SeenGlove out;
  out.camera = {640, 480, 600.0, 600.0, 319.5, 239.5, {}};
  const hand::Pose drawn = drawn_pose(skeleton, scene, draw);
  const hand::Pose truth = posed.value_or(drawn);
  hand::Skeleton real = skeleton;
  for (auto& joint : real.joints) joint *= scene.size;
  const auto joints = joints_of(real, truth);
  Canvas canvas(out.camera);
  for (std::size_t f = 0; f < hand::kFingers; ++f) {
    std::array<Vector3d, 4> chain;
    for (std::size_t i = 0; i < 4; ++i) chain[i] = joints[hand_joint(f, i)];
    draw_finger(canvas, chain, scene.size * skeleton.widths[f] * draw.uniform(0.97, 1.08));
  }
  draw_palm(canvas, skeleton, truth, scene.size);
  paint(out.grey, canvas.alpha(), scene, draw);
  out.wrist = truth.wrist;
  out.pose = truth;
  out.pose.wrist = Vector3d::Zero();
  for (auto& each : out.pose.local)
    each = each * Eigen::Quaterniond(
                      Eigen::AngleAxisd(scene.finger_error * draw.gauss(), Vector3d::UnitX()));
  return out;
}

std::vector<hand::Pose> moving_hand() {
  constexpr int kFrames = 40;
  std::vector<hand::Pose> out;
  for (int i = 0; i < kFrames; ++i) {
    const double s = 2.0 * 3.14159265 * i / kFrames;
    hand::Pose pose;
    pose.wrist = {0.08 * std::sin(s), 0.06 + 0.02 * std::cos(2.0 * s), 0.65 + 0.08 * std::sin(s)};
    pose.turn = Eigen::AngleAxisd(0.35 * std::sin(s), Vector3d::UnitZ()) *
                Eigen::AngleAxisd(0.5 * std::sin(2.0 * s), Vector3d::UnitY()) *
                Eigen::AngleAxisd(3.14159265358979, Vector3d::UnitX());
    for (std::size_t f = 1; f < hand::kFingers; ++f) {
      for (std::size_t k = 0; k < 3; ++k)
        pose.local[hand_joint(f, k)] =
            Eigen::AngleAxisd(0.2 - 0.2 * std::cos(s), Vector3d::UnitX());
    }
    out.push_back(pose);
  }
  return out;
}

std::string hand_file(const hand::Skeleton& skeleton) {
  hand::HandShape shape;
  shape.side = skeleton.side;
  shape.outline.palm_radius = 1.0;  // A picture's; nothing is measured by it here.
  return hand::scan_json(shape, skeleton, {"drawn", "drawn", 0.1, ""});
}

hand::Skeleton usual_skeleton() {
  hand::Skeleton out;
  constexpr std::array kX{0.022, 0.024, 0.0, -0.018, -0.034}, kY{0.022, 0.087, 0.092, 0.086, 0.076};
  constexpr std::array<std::array<double, 3>, 5> kParts{{{0.044, 0.033, 0.026},
                                                         {0.041, 0.024, 0.021},
                                                         {0.045, 0.028, 0.022},
                                                         {0.042, 0.026, 0.022},
                                                         {0.033, 0.019, 0.020}}};
  constexpr std::array kTurn{0.85, 0.14, 0.0, -0.12, -0.28};
  for (std::size_t f = 0; f < hand::kFingers; ++f) {
    out.joints[hand_joint(f, 0)] = {kX[f], kY[f], 0.0};
    const Vector3d along(std::sin(kTurn[f]), std::cos(kTurn[f]), 0.0);
    for (std::size_t i = 0; i < 3; ++i)
      out.joints[hand_joint(f, i + 1)] = out.joints[hand_joint(f, i)] + kParts[f][i] * along;
    out.widths[f] = f == 0 ? 0.020 : 0.017 - 0.0006 * static_cast<double>(f);
  }
  out.palm_radius = 0.041;
  out.palm = {-0.002, 0.048, 0.0};
  return out;
}

}  // namespace chorus::testing
