#include "tests/support/boards/board_scene.h"

#include <cmath>
#include <limits>
#include <numbers>

#include <opencv2/calib3d.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "common/calibration/board_sheet.h"
#include "common/sensor/pixel_ray.h"
#include "common/synthetic/draw.h"

namespace chorus::testing {
namespace {

constexpr int kFiner = 2;               // subpixels per pixel, in each direction
constexpr double kDotsPerSquare = 120;  // resolution of the sheet
constexpr double kMm = 1e-3;

Eigen::Vector3d middle_of(const calibration::Board& board) {
  return {0.5 * kMm * board.columns * board.square_mm, 0.5 * kMm * board.rows * board.square_mm,
          0.0};
}

Eigen::Vector2d projected_by_fisheye(const Eigen::Vector3d& x, const Intrinsics& camera) {
  const cv::Matx33d matrix(camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1);
  const auto& k = camera.distortion;
  std::vector<cv::Point2d> pixel;
  cv::fisheye::projectPoints(std::vector<cv::Point3d>{{x.x(), x.y(), x.z()}}, pixel, cv::Vec3d(),
                             cv::Vec3d(), matrix, cv::Vec4d(k[0], k[1], k[2], k[3]));
  return {pixel[0].x, pixel[0].y};
}

}  // namespace

Eigen::Vector2d projected(const Eigen::Vector3d& x_in_camera, const Intrinsics& camera) {
  if (camera.model == LensModel::Fisheye) return projected_by_fisheye(x_in_camera, camera);
  const auto& [k1, k2, p1, p2, k3] = camera.distortion;
  const double x = x_in_camera.x() / x_in_camera.z();
  const double y = x_in_camera.y() / x_in_camera.z();
  const double r2 = x * x + y * y;
  const double radial = 1.0 + r2 * (k1 + r2 * (k2 + r2 * k3));
  return {camera.cx + camera.fx * (x * radial + 2.0 * p1 * x * y + p2 * (r2 + 2.0 * x * x)),
          camera.cy + camera.fy * (y * radial + p1 * (r2 + 2.0 * y * y) + 2.0 * p2 * x * y)};
}

std::vector<Eigen::Isometry3d> board_poses(const calibration::Board& board,
                                           const Intrinsics& camera, const PoseWishes& wishes) {
  synthetic::Draw draw({wishes.seed, 77});
  std::vector<Eigen::Isometry3d> poses;
  const double width = kMm * board.columns * board.square_mm;
  for (std::size_t i = 0; i < wishes.count; ++i) {
    const double across = 0.5 + wishes.reach * (static_cast<double>(i % 3) - 1.0);
    const double down = 0.5 + wishes.reach * (static_cast<double>(i / 3 % 3) - 1.0);
    const Eigen::Vector3d ray = *ray_of({across * camera.width, down * camera.height}, camera);
    const double share = wishes.share * draw.uniform(0.8, 1.2);
    const double distance = camera.fx * width / (share * camera.width);
    const double way = draw.uniform(0.0, 2.0 * std::numbers::pi);
    const double tilt = wishes.tilt * (i % 2 == 0 ? 1.0 : draw.uniform());
    const Eigen::AngleAxisd lean(tilt, Eigen::Vector3d(std::cos(way), std::sin(way), 0.0));
    const Eigen::AngleAxisd roll(draw.uniform(-0.3, 0.3), Eigen::Vector3d::UnitZ());
    const Eigen::Matrix3d upright = Eigen::Vector3d(1.0, -1.0, -1.0).asDiagonal();
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.linear() = lean.toRotationMatrix() * roll.toRotationMatrix() * upright;
    pose.translation() = ray / ray.z() * distance - pose.linear() * middle_of(board);
    poses.push_back(pose);
  }
  return poses;
}

calibration::View seen_corners(const calibration::Board& board, const Intrinsics& camera,
                               const Eigen::Isometry3d& camera_from_board, double noise,
                               std::uint64_t seed) {
  synthetic::Draw draw({seed, 78});
  calibration::View view{"view " + std::to_string(seed), {}};
  for (int row = 1; row < board.rows; ++row) {
    for (int column = 1; column < board.columns; ++column) {
      const Eigen::Vector2d place(kMm * column * board.square_mm, kMm * row * board.square_mm);
      Eigen::Vector2d pixel =
          projected(camera_from_board * Eigen::Vector3d(place.x(), place.y(), 0.0), camera);
      pixel += noise * Eigen::Vector2d(draw.gauss(), draw.gauss());
      if (pixel.minCoeff() < 0.0 || pixel.x() > camera.width - 1 || pixel.y() > camera.height - 1)
        continue;
      view.corners.push_back({place, pixel});
    }
  }
  return view;
}

BoardCamera::BoardCamera(const calibration::Board& board, const Intrinsics& camera)
    : board_(board), camera_(camera) {
  const std::string png = calibration::board_png(board).value();
  const cv::Mat whole =
      cv::imdecode(std::vector<uchar>(png.begin(), png.end()), cv::IMREAD_GRAYSCALE);
  cv::resize(whole, sheet_,
             {static_cast<int>(kDotsPerSquare * (board.columns + 1)),
              static_cast<int>(kDotsPerSquare * (board.rows + 1))},
             0, 0, cv::INTER_AREA);
  rays_.create(camera.height * kFiner, camera.width * kFiner, CV_32FC2);
  for (int v = 0; v < rays_.rows; ++v) {
    for (int u = 0; u < rays_.cols; ++u) {
      const auto ray = ray_of({(u + 0.5) / kFiner - 0.5, (v + 0.5) / kFiner - 0.5}, camera);
      const float none = std::numeric_limits<float>::quiet_NaN();
      rays_.at<cv::Vec2f>(v, u) = ray ? cv::Vec2f(static_cast<float>(ray->x() / ray->z()),
                                                  static_cast<float>(ray->y() / ray->z()))
                                      : cv::Vec2f(none, none);
    }
  }
}

cv::Mat BoardCamera::picture(const Eigen::Isometry3d& camera_from_board, const Flaws& flaws,
                             std::uint64_t seed) const {
  // x_in_camera = (r1 X + r2 Y + t), so a ray determines (X, Y, 1) up to a factor.
  Eigen::Matrix3d camera_from_plane;
  camera_from_plane << camera_from_board.linear().leftCols<2>(), camera_from_board.translation();
  const Eigen::Matrix3d plane_from_camera = camera_from_plane.inverse();
  const double dots = kDotsPerSquare / (kMm * board_.square_mm);
  const double margin = 0.5 * kMm * board_.square_mm;
  const double top = kMm * board_.rows * board_.square_mm;
  cv::Mat places(rays_.size(), CV_32FC2);
  for (int v = 0; v < rays_.rows; ++v) {
    for (int u = 0; u < rays_.cols; ++u) {
      const cv::Vec2f& ray = rays_.at<cv::Vec2f>(v, u);
      const Eigen::Vector3d hit = plane_from_camera * Eigen::Vector3d(ray[0], ray[1], 1.0);
      places.at<cv::Vec2f>(v, u) =
          cv::Vec2f(static_cast<float>((hit.x() / hit.z() + margin) * dots - 0.5),
                    static_cast<float>((top - hit.y() / hit.z() + margin) * dots - 0.5));
    }
  }
  cv::Mat fine;
  cv::remap(sheet_, fine, places, cv::Mat(), cv::INTER_LINEAR, cv::BORDER_CONSTANT, 140);
  cv::Mat picture;
  cv::resize(fine, picture, {camera_.width, camera_.height}, 0, 0, cv::INTER_AREA);
  if (flaws.blur_px > 0.0) cv::GaussianBlur(picture, picture, {0, 0}, flaws.blur_px);
  cv::Mat noise(picture.size(), CV_16SC1);
  cv::RNG random(seed);
  random.fill(noise, cv::RNG::NORMAL, 0.0, flaws.noise);
  cv::add(picture, noise, picture, cv::noArray(), CV_8U);
  return picture;
}

}  // namespace chorus::testing
