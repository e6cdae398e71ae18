#include "services/sensor/device/glove/glove_eye.h"

#include <algorithm>
#include <utility>

#include <opencv2/imgproc.hpp>

#include "common/base/file.h"
#include "common/hand/glove_joints.h"
#include "common/hand/hand_json.h"
#include "common/sensor/pixel_ray.h"
#include "services/sensor/device/camera/shipped_runner.h"
#include "services/sensor/device/positioner/places_file.h"

namespace chorus::glove {
namespace {

constexpr std::uintmax_t kMostHandBytes = 1 << 20;
constexpr std::uintmax_t kMostTakeBytes = 1 << 28;
constexpr std::uintmax_t kMostPlacesBytes = 1 << 22;
// Of the lengths that a scan with a scale gives, and of a hand that only has usual ones.
constexpr double kScannedSigma = 0.01;
constexpr double kUsualSigma = 0.05;
constexpr double kLeastScore = 0.5;

Result<hand::Skeleton> hand_in(const std::string& file) {
  if (file.empty())
    return fail(ErrorCode::InvalidArgument, "hand",
                "is missing: the .json that `chorus scan hand.png --out hand.bvh` writes");
  const auto text = read_file(file, kMostHandBytes);
  if (!text) return pass(text);
  auto skeleton = hand::read_skeleton(*text);
  if (!skeleton) return fail(skeleton.error().code, file, to_string(skeleton.error()));
  return skeleton;
}

Result<hand::GloveTake> take_in(const std::string& file, hand::Side side) {
  if (file.empty())
    return fail(ErrorCode::InvalidArgument, "take",
                "is missing: a .bvh that says how the hand is held");
  const auto text = read_file(file, kMostTakeBytes);
  if (!text) return pass(text);
  return hand::read_glove_take(*text, file, side);
}

std::string no_place(const std::string& camera,
                     const std::map<std::string, Eigen::Isometry3d>& places) {
  std::string names;
  for (const auto& [name, place] : places) names += (names.empty() ? "" : ", ") + name;
  return (camera.empty() ? std::string("say which camera (--camera, or `camera_name`): ")
                         : "has no place for the camera " + camera + ", only for ") +
         names;
}

Result<Eigen::Isometry3d> camera_in(const GloveSettings& settings) {
  Eigen::Isometry3d axes = Eigen::Isometry3d::Identity();
  axes.linear() = camera_from_sensor_axes().transpose();
  if (settings.places.empty()) return axes;
  const auto text = read_file(settings.places, kMostPlacesBytes);
  if (!text) return pass(text);
  const auto places = positioner::read_places(*text);
  if (!places) return pass(places);
  const auto found = places->find(settings.camera_name);
  if (found == places->end())
    return fail(ErrorCode::NotFound, settings.places, no_place(settings.camera_name, *places));
  return Eigen::Isometry3d(found->second * axes);
}

Result<camera::HandFinder> network_of(const GloveSettings& settings) {
  const auto command = camera::runner_command(settings.camera);
  if (!command) return pass(command);
  return camera::HandFinder::start(*command);
}

}  // namespace

/// Where the pixels of a picture without distortion are in the camera's.
struct GloveEye::Undistortion {
  Intrinsics camera;
  cv::Mat map;

  explicit Undistortion(const Intrinsics& of) : camera(of), map(of.height, of.width, CV_32FC2) {
    for (int v = 0; v < of.height; ++v) {
      for (int u = 0; u < of.width; ++u) {
        const auto at = pixel_of({(u - of.cx) / of.fx, (v - of.cy) / of.fy, 1.0}, of);
        const Eigen::Vector2d from = at.value_or(Eigen::Vector2d(-1.0, -1.0));
        map.at<cv::Vec2f>(v, u) = {static_cast<float>(from.x()), static_cast<float>(from.y())};
      }
    }
  }
};

Result<GloveEye> GloveEye::open(const GloveSettings& settings) {
  GloveEye out;
  out.settings_ = settings;
  auto skeleton = hand_in(settings.hand);
  if (!skeleton) return pass(skeleton);
  out.skeleton_ = *skeleton;
  auto take = take_in(settings.take, out.skeleton_.side);
  if (!take) return pass(take);
  out.take_ = std::move(*take);
  const auto world_from_camera = camera_in(settings);
  if (!world_from_camera) return pass(world_from_camera);
  out.world_from_camera_ = *world_from_camera;
  out.options_.darkest = settings.darkest;
  out.options_.size_sigma = out.skeleton_.relative ? kUsualSigma : kScannedSigma;
  if (settings.find == GloveFinding::Network) {
    auto network = network_of(settings);
    if (!network) return pass(network);
    out.network_ = std::move(*network);
  }
  return out;
}

Result<hand::GlovePlace> GloveEye::place(const camera::Picture& picture,
                                         const hand::PosedGlove& glove, const Intrinsics& camera) {
  if (!network_) {
    cv::Mat grey;
    cv::cvtColor(*picture.pixels, grey, cv::COLOR_BGR2GRAY);
    if (camera.model != LensModel::Brown || camera.distortion != std::array<double, 5>{}) {
      if (!undistortion_ || !(undistortion_->camera == camera))
        undistortion_ = std::make_shared<Undistortion>(camera);
      cv::remap(grey, grey, undistortion_->map, cv::noArray(), cv::INTER_LINEAR,
                cv::BORDER_CONSTANT, cv::Scalar(255));
    }
    return hand::place_glove(hand::glove_mask(grey, options_), glove, camera, options_);
  }
  auto seen = network_->look(picture);
  if (!seen) return pass(seen);
  std::erase_if(*seen, [&](const hand::SeenHand& each) {
    return each.score < kLeastScore || each.side != skeleton_.side;
  });
  if (seen->empty())
    return fail(
        ErrorCode::NotFound, "glove",
        std::string("the network sees no ") + std::string(name_of(skeleton_.side)) + " hand");
  for (hand::Pixel& joint : seen->front().joints) {
    const auto ray = ray_of(joint, camera);
    if (!ray || !(ray->z() > 0.0))
      return fail(ErrorCode::NotFound, "glove", "is outside the lens's model");
    joint = {camera.cx + camera.fx * ray->x() / ray->z(),
             camera.cy + camera.fy * ray->y() / ray->z()};
  }
  return hand::place_by_joints(seen->front().joints, glove, camera, options_);
}

Result<PlacedHand> GloveEye::look(const camera::Picture& picture, double seconds) {
  const auto lens = camera::lens_for(settings_.camera, picture.size);
  if (!lens) return pass(lens);
  PlacedHand out;
  out.pose = hand::pose_at(take_, seconds);
  out.pose.turn = Eigen::Quaterniond(world_from_camera_.linear().transpose()) * out.pose.turn;
  auto found = place(picture, {skeleton_, out.pose}, lens->camera);
  if (!found) return pass(found);
  out.place = *found;
  out.pose.wrist = out.place.wrist;
  out.apart = out.place.residual * out.place.wrist.z() / lens->camera.fx;
  const Eigen::Vector3d sight = out.place.wrist.normalized();
  const double by_lens = lens->focal_sigma * out.place.wrist.norm();
  out.place.covariance += by_lens * by_lens * sight * sight.transpose();
  return out;
}

}  // namespace chorus::glove
